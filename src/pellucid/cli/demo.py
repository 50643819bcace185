"""`pellucid demo`: the gallery, drawn on this machine."""

from __future__ import annotations

import difflib
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pellucid.cli.arguments import Size, check_pixels, check_size, make_folder, parse_size
from pellucid.cli.console import Bar, complain, open_device, outcome, progress_bar, seconds
from pellucid.errors import SceneError

if TYPE_CHECKING:
    import numpy as np

SHEET = "contact_sheet.png"


@dataclass(frozen=True)
class Drawn:
    """One finished picture."""

    title: str
    pixels: np.ndarray
    prepare_s: float
    render_s: float


def demo(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the pictures go.")] = Path(
        "out/demo"
    ),
    size: Annotated[Size, typer.Option(parser=parse_size, metavar="WxH", help="Pixels of each picture.")] = "800x600",  # type: ignore[assignment]
    samples: Annotated[
        int | None,
        typer.Option(
            min=1, max=65536, help="Jittered pictures averaged; each picture knows its own number if not given."
        ),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Draw this picture only; may be given several times.")
    ] = None,
) -> None:
    """Draw the gallery: things that bend light, one picture each, and a sheet of them all.

    Pictures that are there already are drawn anew. After ctrl-C the finished ones stay.
    """
    from pellucid.gallery import PICTURES

    chosen = _chosen(PICTURES, only)
    check_pixels(size)
    make_folder(output)
    device = open_device()
    check_size(size, device.limits["max-texture-dimension-2d"])
    begun = time.perf_counter()
    done: list[Drawn] = []
    try:
        _draw_all(chosen, output, size, samples, done)
    except KeyboardInterrupt:
        missing = [picture.name for _, picture in chosen[len(done) :]]
        complain(f"{len(done)} of {len(chosen)} pictures are in {output}; missing: {', '.join(missing)}", "stopped")
        raise typer.Exit(1) from None
    if len(done) > 1:
        _write_sheet(output / SHEET, done)
    prepare, render = sum(d.prepare_s for d in done), sum(d.render_s for d in done)
    outcome().print(
        f"{len(done)} picture{'s' * (len(done) > 1)} in {output} in {seconds(time.perf_counter() - begun)} "
        f"(prepared in {seconds(prepare)}, drawn in {seconds(render)})",
        soft_wrap=True,
    )


def _chosen(pictures: Sequence[Any], only: list[str] | None) -> list[tuple[int, Any]]:
    """Pictures with their numbers in the gallery."""
    names = [picture.name for picture in pictures]
    for name in only or ():
        if name not in names:
            close = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
            nearest = f"did you mean {close[0]}? " if close else ""
            raise SceneError("--only", f"no picture is called {name!r}", f"{nearest}there are {', '.join(names)}")
    return [(i, picture) for i, picture in enumerate(pictures, start=1) if not only or picture.name in only]


def _draw_all(chosen: list[tuple[int, Any]], folder: Path, size: Size, samples: int | None, done: list[Drawn]) -> None:
    with progress_bar() as bar:
        for number, picture in chosen:
            path = folder / f"{number:02d}_{picture.name}.png"
            drawn = _draw(picture, path, size, samples or picture.samples, bar, len(done), len(chosen))
            done.append(drawn)
            times = f"prepared in {seconds(drawn.prepare_s):>7}, drawn in {seconds(drawn.render_s):>7}"
            bar.say(f"{path}  {times}  {picture.title}")


def _draw(picture: Any, path: Path, size: Size, samples: int, bar: Bar, before: int, count: int) -> Drawn:
    from pellucid.session import default_renderer

    begun = time.perf_counter()
    label = f"{before + 1}/{count} {picture.title}"
    bar.overall(f"{label}: preparing", before / count)
    scene = picture.build()
    built = time.perf_counter() - begun
    frame = default_renderer().render(
        scene, size, time=picture.time_s, samples=samples,
        progress=lambda share: bar.overall(f"{label}: drawing", (before + share) / count),
    )  # fmt: skip
    frame.save(path)
    prepare = frame.timings["prepare"] / 1e3
    return Drawn(picture.title, frame.srgb(), built + prepare, frame.timings["total"] / 1e3 - prepare)


def _write_sheet(path: Path, done: list[Drawn]) -> None:
    from pellucid.io.contact_sheet import contact_sheet
    from pellucid.io.images import write_image

    write_image(path, contact_sheet([(each.title, each.pixels) for each in done]))
    outcome().print(f"{path}  all of them on one page", soft_wrap=True)
