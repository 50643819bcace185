"""`pellucid animate`: a scene that is walked around, or that the light walks around, as numbered pictures."""

from __future__ import annotations

import difflib
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from pellucid.cli.arguments import (
    Size,
    check_output,
    check_pixels,
    check_size,
    make_folder,
    parse_degrees,
    parse_positive,
    parse_size,
)
from pellucid.cli.console import complain, open_device, outcome, progress_bar, seconds
from pellucid.errors import AssetError, SceneError

if TYPE_CHECKING:
    from pellucid.scene import Scene


class Span(NamedTuple):
    """Frames from the first to before the end; None: as far as there are."""

    first: int | None
    end: int | None

    def __str__(self) -> str:
        return ":".join("" if at is None else str(at) for at in self)


def parse_span(text: str | Span) -> Span:
    """``10:20``, ``:20``, ``10:``."""
    if isinstance(text, Span):
        return text
    match = re.fullmatch(r"\s*(\d{0,7})\s*:\s*(\d{0,7})\s*", text)
    if not match:
        raise typer.BadParameter(f"{text!r} is no range of frames; write first:end, such as 10:20 for 10 to 19")
    first, end = (int(part) if part else None for part in match.groups())
    return Span(first, end)


def animate(
    source: Annotated[
        str,
        typer.Argument(metavar="SCENE", help="A scene file, .json or .toml, or a picture of the gallery by its name."),
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the frames go; made if it is missing.")
    ],
    frames: Annotated[int, typer.Option(min=1, max=1_000_000, help="How many the whole animation has.")] = 48,
    fps: Annotated[float, typer.Option(parser=parse_positive, metavar="RATE", help="Frames a second.")] = 24.0,
    size: Annotated[Size, typer.Option(parser=parse_size, metavar="WxH", help="Pixels.")] = "800x600",  # type: ignore[assignment]
    samples: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=65536,
            help="Jittered pictures averaged for each frame. [dim]\\[default: the gallery's, 4 for a file][/dim]",
        ),
    ] = None,
    orbit: Annotated[
        float,
        typer.Option(parser=parse_degrees, metavar="DEGREES", help="Carry the camera about what it looks at."),
    ] = 0.0,
    light_orbit: Annotated[
        float, typer.Option(parser=parse_degrees, metavar="DEGREES", help="Carry the lamps about it instead, or too.")
    ] = 0.0,
    start: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            metavar="SECONDS",
            help="When it begins, for what moves by itself, such as water. "
            "[dim]\\[default: the gallery's, 0 for a file][/dim]",
        ),
    ] = None,
    only: Annotated[
        Span | None,
        typer.Option(parser=parse_span, metavar="FIRST:END", help="Draw these frames only; 10:20 are 10 to 19."),
    ] = None,
    video: Annotated[
        Path | None,
        typer.Option(metavar="FILE.mp4", help="A film of all frames; needs pip install 'pellucid\\[video]'."),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Draw frames again that are there, and replace those of other settings.")
    ] = False,
) -> None:
    """Draw a scene again and again while the camera or the light goes round it.

    Frames are frame_0000.png, frame_0001.png and so on. Both ways round are about the vertical through what the
    camera looks at; frame I of N stands at I/N of the angle, so that 360 degrees close a loop. Without either, only
    what moves by itself does: water with waves.

    Frames that are there already are kept: after ctrl-C the same command goes on. animation.json beside them says what
    they were made with, and other settings are refused without --overwrite. Several machines can share the work by
    --only; the film is made when all frames are there.
    """
    from pellucid.animation import animate as draw
    from pellucid.animation import frame_paths

    begun = time.perf_counter()
    build, usual_samples, usual_start, identity = _source(source)
    wanted = _range(only, frames)
    if video is not None:
        _check_video(video)
    check_pixels(size)
    make_folder(output)
    device = open_device()
    check_size(size, device.limits["max-texture-dimension-2d"])
    there = 0 if overwrite else _finished(output, frames, wanted)
    begins = usual_start if start is None else start
    settings = {**identity, "orbit_deg": orbit, "light_orbit_deg": light_orbit}
    try:
        with progress_bar() as bar:
            bar.overall("preparing", there / (wanted[1] - wanted[0]))
            made = draw(
                _moving(build, orbit, light_orbit, begins, frames / fps), output, frames, fps, size,
                samples or usual_samples, start_s=begins, only=wanted, overwrite=overwrite, video=video,
                settings=settings,
                progress=lambda frame, share: bar.overall(f"frame {frame} of {frames}", share),
            )  # fmt: skip
    except KeyboardInterrupt:
        done, asked = _finished(output, frames, wanted), wanted[1] - wanted[0]
        again = " without --overwrite" if overwrite else ""
        complain(f"{done} of {asked} frames are in {output}; the same command{again} goes on", "stopped")
        raise typer.Exit(1) from None
    kept = f", {there} of them from before" if there else ""
    lasts = seconds(time.perf_counter() - begun)
    outcome().print(f"{_frames(len(made))} in {output}{kept}, in {lasts}", soft_wrap=True)
    if video is not None:
        length = seconds(frames / fps)
        outcome().print(f"{video}: {_frames(len(frame_paths(output, frames)))}, {length}", soft_wrap=True)


def _frames(count: int) -> str:
    return f"{count} frame{'s' * (count != 1)}"


def _range(only: Span | None, frames: int) -> tuple[int, int]:
    first = (only.first or 0) if only else 0
    end = frames if only is None or only.end is None else only.end
    if not 0 <= first < end <= frames:
        last = f"frames are numbered 0 to {frames - 1}, so use 0:{frames} or a part of it"
        raise SceneError("--only", f"{only} holds no frame, or more than there are", last)
    return first, end


def _finished(folder: Path, frames: int, wanted: tuple[int, int]) -> int:
    from pellucid.animation import frame_paths

    return sum(path.exists() for path in frame_paths(folder, frames)[slice(*wanted)])


def _check_video(video: Path) -> None:
    from pellucid.io.video import WRITABLE, check_video

    check_output(video, WRITABLE, "written as video")
    check_video(video)


def _source(name: str) -> tuple[Callable[[], Scene], int, float, dict[str, Any]]:
    """How to make the scene, its usual number of samples and first moment, and what tells it from others."""
    from pellucid.gallery import PICTURES

    pictures = {picture.name: picture for picture in PICTURES}
    if name in pictures and not Path(name).is_file():
        picture = pictures[name]
        return picture.build, picture.samples, picture.time_s, {"scene": name}
    path = Path(name)
    if not path.suffix and not path.exists():
        close = difflib.get_close_matches(name, pictures, n=1, cutoff=0.4)
        nearest = f"did you mean {close[0]}? " if close else ""
        raise AssetError(
            name, "is neither a scene file nor a picture of the gallery", f"{nearest}there are {', '.join(pictures)}"
        )
    return _of_file(path)


def _of_file(path: Path) -> tuple[Callable[[], Scene], int, float, dict[str, Any]]:
    from pellucid.animation import digest
    from pellucid.io.files import existing_file, suffix_of
    from pellucid.scene.files import SUFFIXES, load_scene

    suffix_of(existing_file(path), SUFFIXES, "animated")
    scene = load_scene(path)
    return lambda: scene, 4, 0.0, {"scene": path.name, "scene_sha256": digest(path)}


def _moving(
    build: Callable[[], Scene], orbit: float, light_orbit: float, start_s: float, length_s: float
) -> Callable[[float], Scene]:
    """The scene at a time; it is built at the first frame that has to be drawn."""
    from pellucid.animation import lit_from, orbited

    built: list[Scene] = []

    def scene_at(time: float) -> Scene:
        if not built:
            built.append(build())
            if light_orbit and not built[0].lights:
                raise SceneError("--light-orbit", "finds no lamp in this scene", "use --orbit, or give it a light")
        still, part = built[0], (time - start_s) / length_s
        camera = orbited(still.camera, orbit * part)
        return still.replace(camera=camera, lights=lit_from(still.lights, light_orbit * part, still.camera.target))

    return scene_at
