"""A pool with a ball in it, path traced by Mitsuba 3 and drawn by Pellucid.

Both have the same meshes, and the same heights of the water with the same normals. Mitsuba's paths find the lamp by
chance, since no place under water can be connected to it: the lamp is therefore a disc of some degrees, and Pellucid
has it as `DirectionalLight(angular_radius_deg=...)`. The sky is even, and what stands in it is dark, since Pellucid
does not follow light from one matt surface to another.

A picture with the lamp in 32 parts stands beside that of one wide lamp, whose photons come from parts of its disc.

Run ``python tools/compare_mitsuba_pool.py --output out/mitsuba_pool`` (needs the extra `compare`). It writes both
pictures, the differences, `comparison.json`, and prints a table. FLIP as in ``compare_povray.py``.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from compare_mitsuba_relief import Image
from compare_povray import compare, srgb, write_image
from timed import timed

RIM_M = 1.2  # ground around the pool
SIZE_M, DEPTH_M, CELLS = (2.4, 1.8), 0.7, (192, 256)  # x and z; (rows, columns)
N = 1.333
SKY = 0.12  # radiance
TO_LAMP, IRRADIANCE, LAMP_DISTANCE_M = (0.45, 1.0, 0.3), 3.0, 100.0
CAMERA, TARGET, FOV_DEG = (0.15, 1.9, 1.9), (0.0, -0.3, 0.05), 38.0
BALL_M, BALL_AT = 0.22, (0.3, -0.05, 0.15)
SUNK_AT = (-0.55, -0.48, -0.3)
WALL, FLOOR, BALL, SUNK = (
    (0.08, 0.14, 0.17),
    ((0.30, 0.34, 0.35), (0.09, 0.14, 0.17)),
    (0.35, 0.06, 0.04),
    (0.25, 0.2, 0.03),
)
SQUARES = 8
# Wavelength, amplitude (metres), direction and phase (degrees) of the waves
TRAINS = (
    (0.55, 0.008, 20.0, 0.0),
    (0.42, 0.006, 110.0, 40.0),
    (0.34, 0.004, -50.0, 200.0),
    (0.25, 0.0025, 160.0, 90.0),
)


def waves() -> Any:
    """Four sines over the pool, at rest."""
    from pellucid.fields.waves import Sine

    length, amplitude, direction, phase = (list(values) for values in zip(*TRAINS, strict=True))
    return Sine(length, amplitude, direction, phase, tile_m=SIZE_M, shape=CELLS, periodic=False)


def pool_meshes() -> list[Any]:
    """Floor, walls, a ball that floats and one that lies on the floor, as Pellucid draws them."""
    import pellucid as pl
    from pellucid.gallery.waters import paved

    x, z, low, high = 0.5 * SIZE_M[0], 0.5 * SIZE_M[1], -DEPTH_M, 0.06
    far_x, far_z = x + RIM_M, z + RIM_M
    walls = [
        [(-x, low, -z), (x, low, -z), (-x, high, -z)],
        [(x, low, z), (-x, low, z), (x, high, z)],
        [(-x, low, z), (-x, low, -z), (-x, high, z)],
        [(x, low, -z), (x, low, z), (x, high, -z)],
        [(-far_x, high, -z), (far_x, high, -z), (-far_x, high, -far_z)],
        [(-far_x, high, far_z), (far_x, high, far_z), (-far_x, high, z)],
        [(-far_x, high, z), (-x, high, z), (-far_x, high, -z)],
        [(x, high, z), (far_x, high, z), (x, high, -z)],
    ]
    plain = np.ones((1, 1, 3), np.float32)
    matt: dict[str, Any] = {"specular": 0.0, "roughness": 1.0}
    return [
        pl.Mesh.checkerboard(SIZE_M, SQUARES, FLOOR, position=(0.0, low, 0.0), **matt),
        paved(walls, 1.0, plain, **(matt | {"base_color": WALL})),
        pl.Mesh.sphere(BALL_M, 96, position=BALL_AT, base_color=BALL, **matt),
        pl.Mesh.sphere(BALL_M, 96, position=SUNK_AT, base_color=SUNK, **matt),
    ]


def water_mesh() -> tuple[Image, Image, Image]:
    """Vertices, normals and faces of the surface: a vertex at each centre of a cell, and the borders."""
    surface = waves().surface(0.0)
    rows, columns = CELLS

    def along(count: int, size: float) -> Image:
        inner = (np.arange(count) + 0.5) * size / count - 0.5 * size
        return np.concatenate([[-0.5 * size], inner, [0.5 * size]])

    z, x = np.meshgrid(along(rows, SIZE_M[1]), along(columns, SIZE_M[0]), indexing="ij")
    heights = np.pad(np.asarray(surface.heights, float), 1, mode="edge")
    slopes = np.pad(np.asarray(surface.slopes, float), ((1, 1), (1, 1), (0, 0)), mode="edge")
    normals = np.stack([-slopes[..., 0], np.ones_like(heights), -slopes[..., 1]], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    k = np.arange(heights.size).reshape(heights.shape)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, :-1], k[1:, 1:]
    faces = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, c, b), (b, c, d))])
    return np.stack([x, heights, z], axis=-1).reshape(-1, 3), normals.reshape(-1, 3), faces


def mitsuba_mesh(mi: Any, name: str, vertices: Any, normals: Any, faces: Any, uvs: Any, bsdf: dict[str, Any]) -> Any:
    """A mesh of Mitsuba from arrays."""
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf)
    mesh = mi.Mesh(name, len(vertices), len(faces), properties, normals is not None, uvs is not None)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ravel(vertices).astype(np.float32)
    parameters["faces"] = np.ravel(faces).astype(np.uint32)
    if normals is not None:
        parameters["vertex_normals"] = np.ravel(normals).astype(np.float32)
    if uvs is not None:
        parameters["vertex_texcoords"] = np.ravel(uvs).astype(np.float32)
    parameters.update()
    return mesh


def mitsuba_picture(size: tuple[int, int], samples: int, lamp_radius_deg: float) -> Image:
    """(H, W, 3) radiance, path traced."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    towards = np.asarray(TO_LAMP) / np.linalg.norm(TO_LAMP)
    lamp_m = LAMP_DISTANCE_M * float(np.tan(np.radians(lamp_radius_deg)))
    radiance = IRRADIANCE / (np.pi * np.sin(np.radians(lamp_radius_deg)) ** 2)
    placed = mi.ScalarTransform4f().look_at(origin=LAMP_DISTANCE_M * towards, target=(0, 0, 0), up=(0, 0, 1))

    def rgb(value: Any) -> dict[str, Any]:
        return {"type": "rgb", "value": list(value)}

    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 24, "rr_depth": 12},
        "sensor": {
            "type": "perspective", "fov": FOV_DEG, "fov_axis": "y", "near_clip": 0.01,
            "to_world": mi.ScalarTransform4f().look_at(origin=CAMERA, target=TARGET, up=(0, 1, 0)),
            "film": {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"},
                     "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": samples},
        },
        "sky": {"type": "constant", "radiance": rgb((SKY,) * 3)},
        "lamp": {"type": "disk", "to_world": placed @ mi.ScalarTransform4f().scale(lamp_m),
                 "emitter": {"type": "area", "radiance": rgb((float(radiance),) * 3)}},
    }  # fmt: skip
    board = {"type": "checkerboard", "color0": rgb(FLOOR[1]), "color1": rgb(FLOOR[0]),
             "to_uv": mi.ScalarTransform4f().scale((SQUARES / 2, SQUARES / 2, 1))}  # fmt: skip
    looks = [board, rgb(WALL), rgb(BALL), rgb(SUNK)]
    for i, (mesh, look) in enumerate(zip(pool_meshes(), looks, strict=True)):
        matt = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": look}}
        vertices = np.asarray(mesh.vertices) + np.asarray(mesh.position)
        scene[f"mesh_{i}"] = mitsuba_mesh(mi, f"mesh_{i}", vertices, mesh.normals, mesh.faces, mesh.uvs, matt)
    surface = {"type": "dielectric", "int_ior": N, "ext_ior": 1.0}
    vertices, normals, faces = water_mesh()
    scene["water"] = mitsuba_mesh(mi, "water", vertices, normals, faces, None, surface)
    return np.array(mi.render(mi.load_dict(scene)), dtype=np.float32)


def pellucid_scene(towards: Any, lamp_radius_deg: float, caustics: str) -> Any:
    """The same for Pellucid, with the middle of the lamp in that direction."""
    import pellucid as pl

    way = tuple(float(-c) for c in towards)
    lamp = pl.DirectionalLight(way, irradiance=IRRADIANCE, angular_radius_deg=lamp_radius_deg)  # type: ignore[arg-type]
    water = pl.Water(extent_m=SIZE_M, waves=waves(), medium=N, quality=pl.WaterQuality(caustics=caustics))
    camera = pl.Camera(position=CAMERA, target=TARGET, fov_deg=FOV_DEG)
    return pl.Scene(camera, pl.Environment.constant(SKY), [lamp], [*pool_meshes(), water], tone_mapping="linear")


def parts_of_lamp(count: int, radius_deg: float) -> Image:
    """(count, 3) unit directions, evenly over the disc: a spiral by the golden angle."""
    middle = np.asarray(TO_LAMP) / np.linalg.norm(TO_LAMP)
    aside = np.cross(middle, (0.0, 0.0, 1.0))
    aside /= np.linalg.norm(aside)
    k = np.arange(count) + 0.5
    reach, turn = np.tan(np.radians(radius_deg)) * np.sqrt(k / count), k * np.pi * (3.0 - np.sqrt(5.0))
    there = middle + (reach * np.cos(turn))[:, None] * aside + (reach * np.sin(turn))[:, None] * np.cross(middle, aside)
    return np.asarray(there / np.linalg.norm(there, axis=1, keepdims=True))


def pellucid_picture(size: tuple[int, int], samples: int, lamp_radius_deg: float, caustics: str, parts: int) -> Image:
    """(H, W, 3) radiance: the mean of pictures with the lamp in so many parts."""
    import pellucid as pl

    radius = lamp_radius_deg if parts == 1 else lamp_radius_deg / np.sqrt(parts)
    total = np.zeros((size[1], size[0], 3))
    for towards in parts_of_lamp(parts, lamp_radius_deg if parts > 1 else 0.0):
        scene = pellucid_scene(towards, radius, caustics)
        total += pl.render(scene, size=size, samples=max(samples // parts, 1)).radiance
    return np.asarray(total / parts, dtype=np.float32)


def main() -> None:
    """Render, compare, write, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("out/mitsuba_pool"))
    parser.add_argument("--size", type=int, nargs=2, default=(96, 72), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, nargs=2, default=(6000, 128), help="of Mitsuba, of Pellucid")
    parser.add_argument("--lamp", type=float, default=6.0, help="radius of the lamp, degrees")
    parser.add_argument("--keep", action="store_true", help="take Mitsuba's picture from the last run")
    options = parser.parse_args()
    size, folder = (options.size[0], options.size[1]), options.output
    folder.mkdir(parents=True, exist_ok=True)
    store = folder / "mitsuba.npz"
    if options.keep and store.exists():
        theirs, seconds = np.load(store)["radiance"], float(np.load(store)["seconds"])
    else:
        theirs, seconds = timed(lambda: mitsuba_picture(size, options.samples[0], options.lamp))
        np.savez(store, radiance=theirs, seconds=seconds)
    write_image(folder / "mitsuba.png", (255 * srgb(theirs) + 0.5).astype(np.uint8))
    rows: list[dict[str, Any]] = [{"name": "mitsuba", "seconds": seconds, "mean": theirs.mean((0, 1)).tolist()}]
    print("| picture | FLIP | of Mitsuba's mean | processor seconds |\n|---|---|---|---|")
    print(f"| mitsuba | | | {seconds:.1f} |")
    for name, caustics, parts in (("pellucid", "gpu", 32), ("one_lamp", "gpu", 1), ("no_caustics", "none", 1)):
        pellucid_picture(size, 1, options.lamp, caustics, 1)  # the warm-up
        ours, seconds = timed(
            lambda caustics=caustics, parts=parts: pellucid_picture(  # type: ignore[misc]
                size, options.samples[1], options.lamp, caustics, parts
            )
        )
        row = {"name": name, "seconds": seconds, "mean": ours.mean((0, 1)).tolist()}
        rows.append(row | compare(theirs, ours, name, folder))
        print(f"| {name} | {rows[-1]['flip']:.4f} | {ours.mean((0, 1)) / theirs.mean((0, 1))} | {seconds:.1f} |")
    (folder / "comparison.json").write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
