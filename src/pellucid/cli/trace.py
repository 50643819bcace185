"""`pellucid trace`: rays through a volume, by the shader that draws it."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pellucid.cli.arguments import (
    Edges,
    Vector,
    blaming,
    check_output,
    parse_edges,
    parse_positive,
    parse_vector,
    substance,
)
from pellucid.cli.console import open_device, outcome, progress_bar
from pellucid.cli.render import Boundary

if TYPE_CHECKING:
    import numpy as np

    from pellucid.scene import RefractiveVolume
    from pellucid.techniques.eikonal.trace import Rays

MOST_ROWS = 30


class Channel(StrEnum):
    red = "red"
    green = "green"
    blue = "blue"


def trace(
    ctx: typer.Context,
    volume: Annotated[
        Path,
        typer.Argument(
            metavar="VOLUME", help="Index array [z, y, x]: .npy, .npz. Mesh: .obj, .ply, .stl, .glb, .gltf."
        ),
    ],
    origin: Annotated[
        Vector | None, typer.Option(parser=parse_vector, metavar="X,Y,Z", help="Start of one ray, metres.")
    ] = None,
    direction: Annotated[
        Vector | None, typer.Option(parser=parse_vector, metavar="X,Y,Z", help="Its direction, of any length.")
    ] = None,
    rays: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Many rays: .csv or .npy with rows x, y, z, dx, dy, dz.")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Write .csv, .npy or .json instead of a table."),
    ] = None,
    extent: Annotated[
        Edges | None,
        typer.Option(
            parser=parse_edges, metavar="M[,M,M]", help="Of an array: edges x,y,z, or the longest, in metres."
        ),
    ] = None,
    ambient_n: Annotated[
        float, typer.Option(parser=parse_positive, metavar="N", help="Index around the volume.")
    ] = 1.0,
    medium: Annotated[str, typer.Option(help="Of a mesh: a name out of `pellucid media`, or an index.")] = "N-BK7",
    resolution: Annotated[int, typer.Option(min=8, max=1024, help="Of a mesh: voxels along the longest edge.")] = 128,
    boundary: Annotated[Boundary, typer.Option(help="Of a mesh.")] = Boundary.sharp,
    channel: Annotated[Channel | None, typer.Option(help="Whose index to use; that at 587.56 nm if not given.")] = None,
) -> None:
    """Follow rays through a volume and tell where they end.

    A row of the result holds the place where the ray left the volume's box, its direction, the optical path (the
    integral of n ds) from its start, its transmittance for red, green and blue, a status (left, missed, opaque,
    exhausted), the steps it took, and the index at its end. At an interface the refracted ray is followed.

    An array lies centred on the origin; a mesh lies where its file says.
    """
    from pellucid.cli.rays import WRITABLE, read_rays, write_rays

    is_array = _is_array(volume)
    _check_options(ctx, is_array)
    if output is not None:
        check_output(output, WRITABLE)
    if rays is not None:
        if origin is not None or direction is not None:
            raise typer.BadParameter("give --rays, or --origin with --direction, not both", ctx=ctx)
        starts, directions = read_rays(rays)
    elif origin is not None and direction is not None:
        starts, directions = _one(origin), _one(direction)
    else:
        raise typer.BadParameter("which rays? give --origin with --direction, or --rays FILE", ctx=ctx)
    body = (
        _array(volume, extent, ambient_n) if is_array else _mesh(volume, medium, resolution, boundary.value, ambient_n)
    )
    result = _trace(body, starts, directions, channel)
    if output is None:
        _print(result)
    else:
        write_rays(output, result)
        outcome().print(f"{output}: {len(result)} rays, {_tally(result)}", soft_wrap=True)


def _trace(body: RefractiveVolume, starts: np.ndarray, directions: np.ndarray, channel: Channel | None) -> Rays:
    from pellucid.session import trace as follow

    open_device()
    return follow(body, starts, directions, channel=None if channel is None else list(Channel).index(channel))


def _is_array(path: Path) -> bool:
    from pellucid.io.files import existing_file, suffix_of
    from pellucid.io.meshes import READABLE

    return suffix_of(existing_file(path), (".npy", ".npz", *READABLE), "traced") in (".npy", ".npz")


def _check_options(ctx: typer.Context, is_array: bool) -> None:
    wrong = ("medium", "resolution", "boundary") if is_array else ("extent",)
    for name in wrong:
        given = ctx.get_parameter_source(name)
        if given is not None and given.name == "COMMANDLINE":
            kinds = ("meshes", "an array") if is_array else ("arrays", "a mesh, which has its own size")
            raise typer.BadParameter(f"--{name} is for {kinds[0]}; this is {kinds[1]}", ctx=ctx)
    if is_array and ctx.params.get("extent") is None:
        raise typer.BadParameter("an array needs --extent, the edges of its box in metres", ctx=ctx)


def _one(vector: Vector) -> np.ndarray:
    import numpy as np

    return np.array([vector], np.float64)


def _array(path: Path, extent: Edges | None, ambient_n: float) -> RefractiveVolume:
    from pellucid.io.volumes import read_volume
    from pellucid.scene import RefractiveVolume

    assert extent is not None
    edges = extent[0] if len(extent) == 1 else tuple(extent)
    with blaming(path, "n"):
        return RefractiveVolume.from_array(read_volume(path), edges, ambient_n, boundary="smooth")


def _mesh(path: Path, medium: str, resolution: int, boundary: str, ambient_n: float) -> RefractiveVolume:
    from pellucid import media
    from pellucid.scene import RefractiveVolume

    known = media.resolve(substance(medium), "--medium")
    with progress_bar() as bar:
        step = bar.step("filling the mesh")
        return RefractiveVolume.from_mesh(path, known, resolution, ambient_n, progress=step, boundary=boundary)


def _print(result: Rays) -> None:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in ("leaves at x", "y", "z", "direction x", "y", "z", "optical path, m", "transmittance"):
        table.add_column(name, justify="right")
    table.add_column("status")
    table.add_column("steps", justify="right")
    for i in range(min(len(result), MOST_ROWS)):
        numbers = [f"{v:.6f}" for v in (*result.position[i], *result.direction[i], result.optical_path[i])]
        share = " ".join(f"{v:.4f}" for v in result.transmittance[i])
        table.add_row(*numbers, share, str(result.status[i]), str(result.steps[i]))
    console = outcome()
    console.print(table)
    if len(result) > MOST_ROWS:
        console.print(f"{MOST_ROWS} of {len(result)} rays, {_tally(result)}; -o FILE writes them all")


def _tally(result: Rays) -> str:
    """``97 left, 3 missed``."""
    statuses = result.status.tolist()
    return ", ".join(f"{statuses.count(name)} {name}" for name in dict.fromkeys(statuses))
