"""A glass ball over a checkered plane, drawn by POV-Ray and by Pellucid in both boundary modes.

Both programs get the same numbers: the plane is written to POV-Ray from the vertex arrays that Pellucid draws, and
nothing in the scene needs a convention to agree on. There is no lamp and no shadow: the checks emit the radiance that
a Lambertian checker of those albedos reflects under a uniform sky of radiance 1 (radiance = albedo), the sky is linear
in the height of the direction, the ball is clear glass of index 1.5 with exact Fresnel reflection at every crossing.
One red and one blue check near the ball would betray a mirrored or turned camera.

Run ``python tools/compare_povray.py --output out/povray``. It writes the pictures (linear EXR, and PNG to look at),
the differences, ``comparison.json``, and prints a table. FLIP is LDR-FLIP of the sRGB-encoded pictures (no value in
the scene exceeds 1, so nothing is clipped), at its standard 67 pixels per degree.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

Image = NDArray[np.float32]

FOV_DEG = 40.0
CAMERA = (1.1, 1.25, 2.6)
TARGET = (0.0, 0.5, 0.0)
BALL_CENTRE = (0.0, 0.62, 0.0)
BALL_RADIUS_M = 0.5
BALL_INDEX = 1.5
CHECK_M = 0.5
CHECKS = 24
SKY_DOWN = (0.30, 0.32, 0.36)
SKY_UP = (0.25, 0.50, 0.95)
CHECK_COLOURS = {
    "light": (0.80, 0.78, 0.72),
    "dark": (0.10, 0.11, 0.12),
    "red": (0.75, 0.10, 0.06),
    "blue": (0.05, 0.15, 0.70),
}
MARKED = {(CHECKS // 2 + 1, CHECKS // 2 + 1): "red", (CHECKS // 2 - 3, CHECKS // 2): "blue"}  # (along x, along z)
BOX_M = 1.25


@dataclass(frozen=True)
class Quads:
    """Squares of one colour: vertices (4 Q, 3) and triangles (2 Q, 3)."""

    colour: tuple[float, float, float]
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]


def checkered_plane() -> dict[str, Quads]:
    """The plane y = 0 as separate squares by colour, so that no texture filter comes between the two programs."""
    cells: dict[str, list[tuple[int, int]]] = {name: [] for name in CHECK_COLOURS}
    for column in range(CHECKS):
        for row in range(CHECKS):
            default = "light" if (column + row) % 2 == 0 else "dark"
            cells[MARKED.get((column, row), default)].append((column, row))
    return {name: _quads(CHECK_COLOURS[name], np.array(found)) for name, found in cells.items()}


def _quads(colour: tuple[float, float, float], cells: NDArray[np.int64]) -> Quads:
    corners = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])  # counter-clockwise from above
    xz = (cells[:, None, :] + corners[None] - CHECKS / 2) * CHECK_M
    vertices = np.stack([xz[..., 0], np.zeros(xz.shape[:2]), xz[..., 1]], axis=-1).reshape(-1, 3)
    faces = 4 * np.arange(len(cells))[:, None, None] + np.array([(0, 1, 2), (0, 2, 3)])
    return Quads(colour, vertices.astype(np.float32), faces.reshape(-1, 3).astype(np.int32))


def sky_radiance(height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radiance (..., 3) of the sky where `height` is the y of the unit direction."""
    t = (0.5 + 0.5 * height)[..., None]
    return (1 - t) * np.array(SKY_DOWN) + t * np.array(SKY_UP)


def sky_pixels(height_px: int = 512) -> Image:
    """The sky as an equirectangular picture, row 0 straight up."""
    rows = np.cos((np.arange(height_px) + 0.5) / height_px * np.pi)
    pixels = np.repeat(sky_radiance(rows)[:, None, :], 2 * height_px, axis=1)
    return np.ascontiguousarray(pixels, dtype=np.float32)


# --- POV-Ray ---------------------------------------------------------------------------------------------------


def povray_scene(size: tuple[int, int]) -> str:
    """The scene in POV-Ray's language; its camera is turned right-handed by the sign of `right`."""
    aspect = size[0] / size[1]
    horizontal_deg = np.degrees(2 * np.arctan(aspect * np.tan(np.radians(FOV_DEG) / 2)))
    return f"""#version 3.7;
global_settings {{ assumed_gamma 1.0 max_trace_level 20 adc_bailout 0.0001 ambient_light rgb 0 }}
#default {{ finish {{ ambient 0 diffuse 0 emission 0 specular 0 }} }}
camera {{ perspective location {_vector(CAMERA)} right <{-aspect:.9g},0,0> up <0,1,0> sky <0,1,0>
  angle {horizontal_deg:.9g} look_at {_vector(TARGET)} }}
// The pattern is kept inside (0, 1), where it does not wrap round; the colours are those at its ends.
sky_sphere {{ pigment {{ function {{ 0.5 + 0.499*y }} color_map {{
  [0.001 rgb {_vector(SKY_DOWN)}] [0.999 rgb {_vector(SKY_UP)}] }} }} }}
{"".join(_povray_mesh(quads) for quads in checkered_plane().values())}
sphere {{ {_vector(BALL_CENTRE)}, {BALL_RADIUS_M}
  pigment {{ color rgbt <1,1,1,1> }}
  finish {{ reflection {{ 0, 1 fresnel on }} conserve_energy }}
  interior {{ ior {BALL_INDEX} }} }}
"""


def _vector(values: Any) -> str:
    return "<" + ",".join(f"{float(v):.9g}" for v in values) + ">"


def _povray_mesh(quads: Quads) -> str:
    vertices = ",".join(_vector(v) for v in quads.vertices)
    faces = ",".join(f"<{a},{b},{c}>" for a, b, c in quads.faces)
    return (
        f"mesh2 {{ vertex_vectors {{ {len(quads.vertices)}, {vertices} }}\n"
        f"  face_indices {{ {len(quads.faces)}, {faces} }}\n"
        f"  texture {{ pigment {{ rgb {_vector(quads.colour)} }} finish {{ emission 1 }} }} }}\n"
    )


def render_povray(size: tuple[int, int], folder: Path, threads: int) -> tuple[Image, float]:
    """Linear picture and seconds of wall clock, parsing included."""
    program = shutil.which("povray")
    if program is None:
        sys.exit("povray is not installed; on Debian and Ubuntu: sudo apt-get install povray")
    (folder / "scene.pov").write_text(povray_scene(size), encoding="utf-8")
    options = ["+Iscene.pov", "+Opovray.exr", "+FE", f"+W{size[0]}", f"+H{size[1]}", f"+WT{threads}", "-D", "-GA"]
    antialiasing = ["+A0.005", "+AM1", "+R4", "-J"]
    start = time.perf_counter()
    done = subprocess.run([program, *options, *antialiasing], cwd=folder, capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        sys.exit(f"povray failed on {folder / 'scene.pov'}:\n{done.stderr[-2000:]}")
    return read_image(folder / "povray.exr"), seconds


# --- Pellucid --------------------------------------------------------------------------------------------------


def pellucid_scene(boundary: str, resolution: int) -> Any:
    """The same scene through the public interface; specular = 0 leaves the checks their emission alone."""
    import pellucid as pl

    checks = [
        pl.Mesh(q.vertices, q.faces, base_color=(0, 0, 0), specular=0.0, emission=q.colour)
        for q in checkered_plane().values()
    ]
    ball = pl.RefractiveVolume.from_sdf(
        lambda x, y, z: np.sqrt(x * x + y * y + z * z) - BALL_RADIUS_M,
        medium=BALL_INDEX,
        resolution=resolution,
        extent_m=(BOX_M, BOX_M, BOX_M),
        boundary=boundary,
        position=BALL_CENTRE,
    )
    return pl.Scene(
        camera=pl.Camera(position=CAMERA, target=TARGET, fov_deg=FOV_DEG),
        environment=pl.Environment(pixels=sky_pixels()),
        objects=[*checks, ball],
    )


def render_pellucid(
    boundary: str, size: tuple[int, int], folder: Path, samples: int, resolution: int
) -> tuple[Image, float, float]:
    """Linear picture, seconds of the first call (shaders compiled, volume prepared) and of a second one."""
    import pellucid as pl

    scene = pellucid_scene(boundary, resolution)
    seconds = []
    for _ in range(2):
        start = time.perf_counter()
        frame = pl.render(scene, size=size, samples=samples)
        radiance = np.asarray(frame.radiance, dtype=np.float32)
        seconds.append(time.perf_counter() - start)
    write_image(folder / f"{boundary}.exr", radiance)
    return radiance, seconds[0], seconds[1]


# --- comparison ------------------------------------------------------------------------------------------------


def read_image(path: Path) -> Image:
    """The first three channels as linear float32 (H, W, 3)."""
    buffer = OpenImageIO.ImageBuf(str(path))
    pixels = buffer.get_pixels(OpenImageIO.FLOAT)
    if pixels is None or buffer.has_error:
        sys.exit(f"{path}: {buffer.geterror()}")
    return np.ascontiguousarray(pixels[..., :3])


def write_image(path: Path, pixels: NDArray[Any]) -> None:
    """float32 as it is (EXR), uint8 as it is (PNG)."""
    if not OpenImageIO.ImageBuf(np.ascontiguousarray(pixels)).write(str(path)):
        sys.exit(f"{path}: {OpenImageIO.geterror()}")


def srgb(linear: Image) -> Image:
    """sRGB-encoded values in [0, 1] (IEC 61966-2-1), as LDR-FLIP expects them."""
    clipped = np.clip(linear, 0.0, 1.0)
    encoded = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    return np.ascontiguousarray(encoded, dtype=np.float32)


def compare(reference: Image, test: Image, name: str, folder: Path) -> dict[str, float]:
    """Numbers of the difference; writes the picture, |difference| * 4 in sRGB space, and the FLIP map."""
    import flip_evaluator

    difference = np.abs(srgb(test) - srgb(reference))
    flip_map, mean, _ = flip_evaluator.evaluate(srgb(reference), srgb(test), "LDR")
    write_image(folder / f"{name}.png", _bytes(srgb(test)))
    write_image(folder / f"{name}_difference_x4.png", _bytes(4 * difference))
    write_image(folder / f"{name}_flip.png", _bytes(flip_map))
    return {
        "flip": float(mean),
        "mean_abs_radiance_difference": float(np.abs(test - reference).mean()),
        "median_abs_radiance_difference": float(np.median(np.abs(test - reference))),
        "share_of_pixels_off_by_more_than_0.05_srgb": float((difference.max(axis=-1) > 0.05).mean()),
    }


def _bytes(values: Image) -> NDArray[np.uint8]:
    return (np.clip(values, 0, 1) * 255 + 0.5).astype(np.uint8)


def table(rows: list[dict[str, Any]]) -> str:
    """Markdown table of the rows of ``comparison.json``."""
    lines = ["| picture | seconds | first call | FLIP | mean difference |", "|---|---|---|---|---|"]
    for row in rows:
        first, flip = row.get("seconds_first_call"), row.get("flip")
        cells = [row["name"], f"{row['seconds']:.2f}", f"{first:.2f}" if first else "", f"{flip:.4f}" if flip else ""]
        mean = row.get("mean_abs_radiance_difference")
        lines.append("| " + " | ".join([*cells, f"{mean:.5f}" if mean else ""]) + " |")
    return "\n".join(lines)


def main() -> None:
    """Render everything, compare, write, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("out/povray"))
    parser.add_argument("--size", type=int, nargs=2, default=(800, 600), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, default=16, help="jittered frames that Pellucid averages")
    parser.add_argument("--resolution", type=int, default=128, help="voxels along the edge of the ball's box")
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 1, help="threads of POV-Ray")
    parser.add_argument("--povray-only", action="store_true", help="stop after POV-Ray's picture")
    options = parser.parse_args()
    size = (options.size[0], options.size[1])
    options.output.mkdir(parents=True, exist_ok=True)

    reference, seconds = render_povray(size, options.output, options.threads)
    write_image(options.output / "povray.png", _bytes(srgb(reference)))
    rows: list[dict[str, Any]] = [{"name": "POV-Ray", "seconds": seconds, "threads": options.threads}]
    for boundary in () if options.povray_only else ("sharp", "smooth"):
        radiance, first, again = render_pellucid(boundary, size, options.output, options.samples, options.resolution)
        row: dict[str, Any] = {"name": f"Pellucid, {boundary}", "seconds": again, "seconds_first_call": first}
        rows.append(row | compare(reference, radiance, boundary, options.output))

    settings = {"size": size, "samples": options.samples, "resolution": options.resolution}
    report = json.dumps({"settings": settings, "rows": rows}, indent=2)
    (options.output / "comparison.json").write_text(report + "\n", encoding="utf-8")
    print(table(rows))


if __name__ == "__main__":
    main()
