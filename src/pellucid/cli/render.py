"""`pellucid render`: a scene file, or a mesh as a thing of glass, to a picture."""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pellucid.cli.arguments import (
    PICTURES,
    Size,
    Vector,
    blaming,
    check_output,
    check_pixels,
    check_size,
    parse_positive,
    parse_size,
    parse_vector,
    substance,
)
from pellucid.cli.console import Bar, notice, open_device, outcome, progress_bar, seconds
from pellucid.errors import AssetError

if TYPE_CHECKING:
    import numpy as np

    from pellucid.media import Medium
    from pellucid.scene import Scene

LENGTHS_M = (1e-6, 1e6)
ONLY_FOR_MESHES = ("medium", "dispersion", "boundary", "resolution", "rounding", "floor", "up", "scale")


class Boundary(StrEnum):
    sharp = "sharp"
    smooth = "smooth"


class ToneMapping(StrEnum):
    agx = "agx"
    reinhard = "reinhard"
    aces = "aces"
    khronos = "khronos"
    linear = "linear"


class Floor(StrEnum):
    checker = "checker"
    plain = "plain"
    none = "none"


class Up(StrEnum):
    y = "y"
    z = "z"


@dataclass(frozen=True)
class Wish:
    """What was asked for, apart from source and output."""

    size: Size
    samples: int
    medium: str
    dispersion: bool
    boundary: str
    resolution: int
    rounding: float
    floor: str
    up: str
    scale: float
    environment: str | None
    camera: Vector | None
    target: Vector | None
    fov: float | None
    exposure: float | None
    tone_mapping: str | None
    time_s: float


def render(
    ctx: typer.Context,
    source: Annotated[
        Path,
        typer.Argument(metavar="SCENE_OR_MESH", help="Scene: .json, .toml. Mesh: .obj, .ply, .stl, .glb, .gltf."),
    ],
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FILE", help=".png as on a screen; .exr, .hdr as linear radiance."),
    ],
    size: Annotated[Size, typer.Option(parser=parse_size, metavar="WxH", help="Pixels.")] = "800x600",  # type: ignore[assignment]
    samples: Annotated[int, typer.Option(min=1, max=65536, help="Jittered pictures averaged, against jaggies.")] = 4,
    medium: Annotated[
        str, typer.Option(help="What a mesh is made of: a name out of `pellucid media`, or an index.")
    ] = "N-BK7",
    dispersion: Annotated[
        bool, typer.Option("--dispersion", help="Bend red, green and blue apart, as the medium does; thrice the work.")
    ] = False,
    boundary: Annotated[
        Boundary, typer.Option(help="Sharp: Snell and Fresnel at the surface. Smooth: the index changes over a voxel.")
    ] = Boundary.sharp,
    resolution: Annotated[int, typer.Option(min=8, max=1024, help="Voxels along the longest edge of a mesh.")] = 128,
    rounding: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=8.0,
            metavar="VOXELS",
            help="Round off facets and edges; 0 keeps them. [dim]\\[default: 1.2 % of its longest edge][/dim]",
        ),
    ] = None,
    floor: Annotated[Floor, typer.Option(help="What a mesh stands on.")] = Floor.checker,
    up: Annotated[Up, typer.Option(help="The axis that points up in the mesh file; CAD programs like z.")] = Up.y,
    scale: Annotated[
        float,
        typer.Option(parser=parse_positive, metavar="FACTOR", help="Metres per unit of the mesh file; 0.001 for mm."),
    ] = 1.0,
    environment: Annotated[
        str | None,
        typer.Option(
            metavar="studio|sky|FILE",
            help="What is all around; a FILE is an equirectangular picture. [dim]\\[default: studio][/dim]",
        ),
    ] = None,
    camera: Annotated[
        Vector | None,
        typer.Option(
            parser=parse_vector, metavar="X,Y,Z", help="Place of the camera, metres. Three-quarter view if not given."
        ),
    ] = None,
    target: Annotated[
        Vector | None,
        typer.Option(
            parser=parse_vector, metavar="X,Y,Z", help="What the camera looks at; the middle of the mesh if not given."
        ),
    ] = None,
    fov: Annotated[
        float | None, typer.Option(parser=parse_positive, metavar="DEGREES", help="Vertical field of view.")
    ] = None,
    exposure: Annotated[
        float | None,
        typer.Option(parser=parse_positive, metavar="FACTOR", help="Factor on all light before tone mapping."),
    ] = None,
    tone_mapping: Annotated[ToneMapping | None, typer.Option(help="Curve from light to screen.")] = None,
    at: Annotated[
        float, typer.Option("--time", min=0.0, metavar="SECONDS", help="When, for water and all that moves by itself.")
    ] = 0.0,
) -> None:
    """Draw a scene file, or a mesh as a thing of glass, to a picture.

    A mesh is placed on a floor in a studio, with the camera set so that all of it is seen; an open mesh is closed by
    the generalised winding number. --medium, --dispersion, --boundary, --resolution,
    --rounding, --floor, --up and --scale are for meshes; the other
    options also change what a scene file says.
    """
    wish = Wish(
        size, samples, medium, dispersion, boundary.value, resolution, _rounding(rounding, resolution),
        floor.value, up.value, scale, environment, camera, target, fov, exposure,
        tone_mapping and tone_mapping.value, at,
    )  # fmt: skip
    check_output(output, PICTURES)
    is_scene = _is_scene(source)
    if is_scene:
        _refuse_mesh_options(ctx, source)
    _check_names(wish)
    check_pixels(size)
    device = open_device()
    check_size(size, device.limits["max-texture-dimension-2d"])
    _draw(source, is_scene, output, wish)


def _is_scene(source: Path) -> bool:
    """Whether the file is a scene; else it is a mesh. Raises when it is neither, or is not there."""
    from pellucid.io.files import existing_file, suffix_of
    from pellucid.io.meshes import READABLE
    from pellucid.scene.files import SUFFIXES

    return suffix_of(existing_file(source), (*SUFFIXES, *READABLE), "drawn") in SUFFIXES


def _refuse_mesh_options(ctx: typer.Context, source: Path) -> None:
    for name in ONLY_FOR_MESHES:
        given = ctx.get_parameter_source(name)
        if given is not None and given.name == "COMMANDLINE":
            raise typer.BadParameter(
                f"--{name} is for meshes; {source.name} is a scene file, which says this itself", ctx=ctx
            )


def _check_names(wish: Wish) -> None:
    """Faults that need no long work to be seen: the medium, the environment's file."""
    from pellucid import media
    from pellucid.io.files import existing_file, suffix_of
    from pellucid.io.images import READABLE

    media.resolve(substance(wish.medium), "--medium")
    if wish.environment not in (None, "studio", "sky"):
        if not Path(wish.environment).exists():
            raise AssetError(wish.environment, "is no environment", "give studio, sky, or the path of a picture")
        suffix_of(existing_file(wish.environment), READABLE, "read as an environment")


def _draw(source: Path, is_scene: bool, output: Path, wish: Wish) -> None:
    from pellucid.session import default_renderer

    begun = time.perf_counter()
    with progress_bar() as bar:
        scene, story = _scene_of_file(source, wish, bar) if is_scene else _scene_of_mesh(source, wish, bar)
        loaded = time.perf_counter()
        frame = default_renderer().render(
            scene, wish.size, time=wish.time_s, samples=wish.samples, progress=bar.step("drawing")
        )
    frame.save(output)
    prepared = frame.timings["prepare"] / 1e3
    drawn = frame.timings["total"] / 1e3 - prepared
    console = outcome()
    console.print(
        f"{output}: {story}, {wish.size} pixels, {wish.samples} sample{'s' * (wish.samples > 1)}", soft_wrap=True
    )
    console.print(
        f"loaded in {seconds(loaded - begun)}, prepared in {seconds(prepared)}, drawn in {seconds(drawn)}",
        soft_wrap=True,
    )


def _scene_of_file(source: Path, wish: Wish, bar: Bar) -> tuple[Scene, str]:
    from pellucid.cli.default_scene import surroundings
    from pellucid.scene.files import load_scene

    bar.step(f"reading {source.name}")
    scene = load_scene(source)
    camera = {"position": wish.camera, "target": wish.target, "fov_deg": wish.fov}
    scene = scene.replace(camera=scene.camera.replace(**_given(camera)), **_look(wish))
    if wish.environment is not None:
        scene = scene.replace(environment=surroundings(wish.environment)[0])
    count = len(scene.objects)
    return scene, f"the scene {source.name} with {count} object{'s' * (count != 1)}"


def _scene_of_mesh(source: Path, wish: Wish, bar: Bar) -> tuple[Scene, str]:
    import numpy as np

    from pellucid import media
    from pellucid.cli.default_scene import View, framed_camera, scene_around, turned_up
    from pellucid.io.meshes import read_mesh
    from pellucid.scene import RefractiveVolume

    bar.step(f"reading {source.name}")
    mesh = read_mesh(source)
    turned, rotation = turned_up(mesh.vertices, wish.up)
    vertices = wish.scale * turned[np.unique(mesh.faces)]  # files hold stray ones
    _check_length(source, vertices)
    camera = framed_camera(vertices, wish.size, View(wish.camera, wish.target, wish.fov))
    medium = media.resolve(substance(wish.medium))
    _warn_of_size(vertices, medium)
    with blaming(source, "mesh", "vertices", "faces"):
        body = RefractiveVolume.from_mesh(
            (wish.scale * mesh.vertices, mesh.faces), medium, wish.resolution, progress=bar.step("filling the mesh"),
            boundary=wish.boundary, dispersion=wish.dispersion, rotation=rotation, rounding_voxels=wish.rounding,
        )  # fmt: skip
    scene = scene_around(body, vertices, camera, wish.environment or "studio", wish.floor)
    z, y, x = body.volume.shape
    story = f"{source.name} in {medium.name}, {len(mesh.faces):,} triangles in {x} x {y} x {z} voxels, {wish.boundary}"
    return scene.replace(**_look(wish)), story


def _rounding(voxels: float | None, resolution: int) -> float:
    """In voxels: as asked, or 1.5 of 128, so that a coarse try keeps the shape of the fine picture."""
    return min(8.0, 1.5 * resolution / 128) if voxels is None else voxels


def _check_length(source: Path, vertices: np.ndarray) -> None:
    """Single precision, in which light is followed, holds neither atoms nor planets next to a camera."""
    length = float((vertices.max(axis=0) - vertices.min(axis=0)).max())
    low, high = LENGTHS_M
    if not low <= length <= high:
        reason = f"is {length:.3g} m long; {low:g} to {high:g} m can be drawn"
        raise AssetError(source, reason, "set its size with --scale, such as --scale 0.001 for millimetres")


def _warn_of_size(vertices: np.ndarray, medium: Medium) -> None:
    """Metres matter where light is absorbed, and mesh files are often in millimetres."""
    length = float((vertices.max(axis=0) - vertices.min(axis=0)).max())
    if length > 5.0 and medium.absorption_rgb_per_m.any():
        notice(f"the mesh is {length:.3g} m long, so {medium.name} absorbs much; --scale 0.001 if its unit is mm")


def _look(wish: Wish) -> dict[str, Any]:
    return _given({"exposure": wish.exposure, "tone_mapping": wish.tone_mapping})


def _given(values: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value is not None}
