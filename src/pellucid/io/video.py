"""Pictures one after the other, as a film. Needs the package ``av``, which the extra ``video`` installs."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import replacing, suffix_of

WRITABLE = (".mp4",)
CODECS = ("libx264", "mpeg4")
"""The first that is there; H.264 at a quality that the eye does not tell from the pictures."""

_OPTIONS = {"libx264": {"crf": "16", "preset": "medium"}, "mpeg4": {"qmin": "2", "qmax": "4"}}
_REC709, _SRGB, _STUDIO_RANGE = 1, 13, 1  # numbers of ITU-T H.273 and of FFmpeg


def check_video(path: str | PathLike[str]) -> Path:
    """The path, once it is known that films can be written, and of that kind.

    Raises
    ------
    AssetError : another suffix than .mp4, or the package ``av`` is missing.
    """
    file = Path(path)
    suffix_of(file, WRITABLE, "written as video")
    _library(file)
    return file


def write_video(path: str | PathLike[str], pictures: Sequence[str | PathLike[str]], fps: float = 24.0) -> Path:
    """Write a film.

    Parameters
    ----------
    path : .mp4: H.264, or MPEG-4 where that is missing, in 8 bits, Rec.709, the chroma at half the resolution.
    pictures : files of one size, each for one frame; what has an odd number of pixels gets one more.
    fps : frames a second, > 0.

    Raises
    ------
    AssetError : ``av`` is missing, a picture is missing or of another size, or the file cannot be written; nothing
        half-written is left.
    """
    file = check_video(path)
    av = _library(file)
    if not pictures:
        raise AssetError(file, "would be a film without a picture", "give one or more")
    try:
        with replacing(file) as part, av.open(str(part), "w", options={"movflags": "+faststart"}) as film:
            first = _pixels(pictures[0])
            stream = _stream(av, film, file, first.shape, fps)
            for picture in pictures:
                pixels = _pixels(picture)
                if pixels.shape != first.shape:
                    here, there = (f"{s[1]} x {s[0]}" for s in (pixels.shape, first.shape))
                    raise AssetError(picture, f"has {here} pixels, the first picture {there}", "draw it anew")
                frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
                film.mux(stream.encode(frame.reformat(format="yuv420p", dst_colorspace=_REC709)))
            film.mux(stream.encode())
    except av.FFmpegError as error:
        raise AssetError(file, f"could not be written: {error.strerror}", "check free space and permissions") from error
    return file


def _library(file: Path) -> Any:
    try:
        import av
    except ImportError:
        raise AssetError(file, "needs the package av, which is not here", "pip install 'pellucid[video]'") from None
    return av


def _stream(av: Any, film: Any, file: Path, shape: tuple[int, ...], fps: float) -> Any:
    codec = next((name for name in CODECS if name in av.codecs_available), None)
    if codec is None:
        raise AssetError(file, "this build of av knows neither H.264 nor MPEG-4", "pip install --force-reinstall av")
    stream = film.add_stream(codec, rate=Fraction(fps).limit_denominator(1001), options=_OPTIONS[codec])
    stream.height, stream.width = shape[0], shape[1]
    stream.pix_fmt = "yuv420p"
    context = stream.codec_context
    context.color_primaries, context.color_trc = _REC709, _SRGB
    context.colorspace, context.color_range = _REC709, _STUDIO_RANGE
    return stream


def _pixels(picture: str | PathLike[str]) -> np.ndarray:
    """(H, W, 3) uint8, both even."""
    from PIL import Image, UnidentifiedImageError

    from pellucid.io.files import existing_file

    try:
        with Image.open(existing_file(picture)) as image:
            pixels = np.asarray(image.convert("RGB"))
    except (OSError, UnidentifiedImageError) as error:
        raise AssetError(picture, f"is no picture: {error}", "draw it anew") from error
    height, width = pixels.shape[:2]
    return np.ascontiguousarray(np.pad(pixels, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge"))
