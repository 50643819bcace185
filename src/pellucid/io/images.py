"""Pictures as arrays: row 0 is the top row, float32, linear light unless asked otherwise."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import existing_file, replacing, suffix_of

if TYPE_CHECKING:
    import OpenImageIO

READABLE = (".hdr", ".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".tga", ".webp")
WRITABLE = (".png", ".exr", ".hdr")
MAX_BYTES = 8 << 30
"""Largest decoded picture, 26 000 pixels square in three float channels; a larger one is a mistake."""


def read_image(path: str | PathLike[str], *, linear: bool | None = None) -> np.ndarray:
    """Read a picture of any depth as (H, W, C) float32, row 0 at the top.

    Parameters
    ----------
    path : .hdr, .exr, .png, .jpg, .tiff (8, 16 or 32 bits), .bmp, .tga or .webp.
    linear : the stored numbers are already linear (heights, normals, radiance). By default integer
        files are taken to be sRGB pictures and are linearised, float files are taken as they are.

    Returns
    -------
    (H, W, C) float32 with C from 1 to 4: grey, grey + alpha, RGB, RGB + alpha. Integers are scaled to
    0..1. Alpha is never linearised and colour is not multiplied by it.

    Raises
    ------
    AssetError : missing, empty, truncated, not a picture, more than four channels, absurdly large.
    """
    file = existing_file(path)
    suffix_of(file, READABLE, "read as a picture")
    pixels, encoded = _decode(file)
    return _linearised(pixels) if (encoded if linear is None else not linear) else pixels


def decoded(pixels: np.ndarray, *, linear: bool = False) -> np.ndarray:
    """The numbers that an array stands for, as if `read_image` had read it from a file of its kind.

    Parameters
    ----------
    pixels : (H, W) or (H, W, C). uint8 and uint16 are stored pictures: scaled to 0..1, and linearised from sRGB but for
        alpha. All other arrays are numbers already, and come back themselves.
    linear : stored numbers are already linear (heights, normals).
    """
    if pixels.dtype not in (np.uint8, np.uint16):
        return pixels
    scaled = pixels.astype(np.float32) / np.float32(np.iinfo(pixels.dtype).max)
    return scaled if linear else _linearised(scaled)


def write_image(path: str | PathLike[str], array: np.ndarray, *, half: bool = False) -> None:
    """Write a picture; the file appears whole or not at all.

    Parameters
    ----------
    path : .png for uint8 or uint16 (written as they are); .exr or .hdr for float (linear radiance).
    array : (H, W) or (H, W, C), C from 1 to 4; .hdr takes C = 3 only.
    half : store .exr as 16-bit floats.

    Raises
    ------
    AssetError : unknown suffix, a dtype or shape the format cannot hold, missing folder, full disk.
    """
    file = Path(path)
    suffix = suffix_of(file, WRITABLE, "written as a picture")
    pixels = np.ascontiguousarray(_fitting(file, suffix, np.asarray(array)))
    kind = {"u1": "uint8", "u2": "uint16"}.get(pixels.dtype.str[1:], "half" if half else "float")
    with replacing(file) as part:
        _encode(file, part, pixels, kind)


def _linearised(pixels: np.ndarray) -> np.ndarray:
    """The same array with its colours, not its alpha, taken from sRGB to linear light."""
    alpha = pixels.ndim == 3 and pixels.shape[2] in (2, 4)
    colours = pixels[..., :-1] if alpha else pixels
    colours[...] = srgb_to_linear(colours)
    return pixels


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """The sRGB decoding curve on values of 0..1 [iec61966, 5.2]."""
    toe = encoded / 12.92
    curve = ((np.maximum(encoded, 0.04045) + 0.055) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, toe, curve).astype(encoded.dtype)


def linear_to_srgb(linear: np.ndarray) -> np.ndarray:
    """The sRGB encoding curve on values of 0..1 [iec61966, 5.2]."""
    curve = 1.055 * np.maximum(linear, 0.0031308) ** (1.0 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve).astype(linear.dtype)


def _decode(file: Path) -> tuple[np.ndarray, bool]:
    """Pixels of `file` as stored, scaled to 0..1 if integers, and whether they are sRGB encoded."""
    import OpenImageIO

    keep_alpha_apart = OpenImageIO.ImageSpec()
    keep_alpha_apart.attribute("oiio:UnassociatedAlpha", 1)
    source = OpenImageIO.ImageInput.open(str(file), keep_alpha_apart)
    if source is None:
        raise AssetError(file, f"is not a picture of its kind: {_first_line(OpenImageIO.geterror())}", "save it again")
    try:
        spec = source.spec()
        _refuse_odd_size(file, spec)
        pixels = source.read_image("float")
        complaint = source.geterror()
    finally:
        source.close()
    if pixels is None or complaint:
        raise AssetError(file, f"is truncated or damaged: {_first_line(complaint)}", "save or download it again")
    integers = str(spec.format) not in ("float", "half", "double")
    return np.array(pixels, np.float32).reshape(spec.height, spec.width, -1), integers


def _refuse_odd_size(file: Path, spec: OpenImageIO.ImageSpec) -> None:
    if spec.width < 1 or spec.height < 1:
        raise AssetError(file, f"holds no pixels ({spec.width} x {spec.height})", "save it again")
    if not 1 <= spec.nchannels <= 4:
        raise AssetError(file, f"has {spec.nchannels} channels", "keep grey, RGB and alpha only")
    if spec.width * spec.height * spec.nchannels * 4 > MAX_BYTES:
        raise AssetError(file, f"is absurdly large ({spec.width} x {spec.height})", "scale it down first")


def _fitting(file: Path, suffix: str, array: np.ndarray) -> np.ndarray:
    """`array` as (H, W, C) in a dtype the format holds, or the error that says what it wants."""
    pixels = array[..., None] if array.ndim == 2 else array
    if pixels.ndim != 3 or not 1 <= pixels.shape[2] <= 4 or 0 in pixels.shape:
        raise AssetError(file, f"an array of shape {array.shape} is not a picture", "give (H, W) or (H, W, 1 to 4)")
    if suffix == ".png":
        if pixels.dtype not in (np.uint8, np.uint16):
            raise AssetError(file, f"PNG cannot hold {array.dtype}", "encode to uint8 or uint16, or write .exr")
        return pixels
    if pixels.dtype.kind != "f":
        raise AssetError(file, f"{suffix} holds linear floats, not {array.dtype}", "write .png instead")
    if suffix == ".hdr" and (pixels.shape[2] != 3 or not np.isfinite(pixels).all() or pixels.min() < 0):
        raise AssetError(file, "Radiance HDR holds three finite channels >= 0 only", "write .exr instead")
    return pixels.astype(np.float32, copy=False)


def _encode(file: Path, part: Path, pixels: np.ndarray, kind: str) -> None:
    import OpenImageIO

    height, width, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(width, height, channels, kind)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    sink = OpenImageIO.ImageOutput.create(str(part))
    done = sink is not None and sink.open(str(part), spec) and sink.write_image(pixels)
    done = bool(sink is not None and sink.close() and done)
    # the PNG writer returns success on a full disk and leaves only the message
    complaint = OpenImageIO.geterror() if sink is None else sink.geterror()
    if not done or complaint:
        raise AssetError(file, f"could not be written: {_first_line(complaint)}", "check free space and permissions")


def _first_line(text: str) -> str:
    return text.strip().splitlines()[0] if text.strip() else "no reason given"
