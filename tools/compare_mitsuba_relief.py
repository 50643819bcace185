"""Coloured hammered glass over tiles, by Mitsuba 3 as two meshes and by Pellucid as a relief.

Mitsuba's meshes have a vertex at every texel centre of the same heights, with the same normals and colours. Its paths
find the lamp by chance, since no place under the glass can be connected to it: the lamp is therefore a wide disc, and
Pellucid has it as `DirectionalLight(angular_radius_deg=...)`. The sky is even. Nine tiles lie side by side, and the
picture is of the one in the middle, so that no border plays a part.

Run ``python tools/compare_mitsuba_relief.py --output out/mitsuba_relief`` (needs the extra `compare`). It writes both
pictures, the differences, `comparison.json`, and prints a table. FLIP as in ``compare_povray.py``.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from compare_povray import compare, srgb, write_image
from numpy.typing import NDArray
from timed import timed

Image = NDArray[np.float32]

TEXELS, TILE_M, TILES = 192, 0.2, 3
LEVEL_M, WAVES = 0.008, 3.0  # of the glass over the tiles; its heights are enlarged
N, ABSORPTION = 1.5, (60.0, 12.0, 4.0)  # 1/m
SKY = 0.7  # radiance
TO_LAMP, LAMP_RADIUS_DEG, IRRADIANCE = (0.45, 0.8, -0.25), 12.0, 4.0
LAMP_DISTANCE_M = 100.0
CAMERA, TARGET, FOV_DEG = (0.02, 0.2, 0.2), (0.0, 0.0, 0.0), 32.0


def surfaces() -> tuple[Any, Any]:
    """Heights, normals and colours of the tiles, and heights of the glass over them."""
    from pellucid.fields import textures

    tiles = textures.tiles(size=TEXELS, seed=2, tile_m=TILE_M)
    glass = textures.hammered_glass(size=TEXELS, seed=4, tile_m=TILE_M)
    return tiles, LEVEL_M + WAVES * (glass.heights_m - glass.heights_m.mean())


def write_mesh(path: Path, heights: Any, colors: Any) -> None:
    """Nine tiles of a height field as a binary PLY with normals and colours at the vertices."""
    from pellucid.fields.heightfield import slopes_of

    slopes = slopes_of(np.asarray(heights), (TILE_M / TEXELS,) * 2, True)
    side = TILES * TEXELS
    at = (np.arange(side) + 0.5) * TILE_M / TEXELS - 0.5 * TILES * TILE_M
    z, x = np.meshgrid(at, at, indexing="ij")  # rows go towards +z, as v falls
    normal = np.stack([-slopes[..., 0], np.ones((TEXELS, TEXELS)), slopes[..., 1]], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    whole = [np.tile(a, (TILES, TILES, 1)) for a in (np.asarray(heights)[..., None], normal, np.asarray(colors))]
    rows = np.concatenate([x[..., None], whole[0], z[..., None], whole[1], whole[2]], axis=-1)
    k = np.arange(side * side).reshape(side, side)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, :-1], k[1:, 1:]
    faces = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, c, b), (b, c, d))])
    record = np.zeros(len(faces), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    record["count"], record["corners"] = 3, faces
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "r", "g", "b"))
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\n{names}"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + rows.reshape(-1, 9).astype("<f4").tobytes() + record.tobytes())


def mitsuba_picture(size: tuple[int, int], samples: int, folder: Path) -> Image:
    """(H, W, 3) radiance, path traced."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    tiles, glass = surfaces()
    write_mesh(folder / "tiles.ply", tiles.heights_m, tiles.colors)
    write_mesh(folder / "glass.ply", glass, np.ones((TEXELS, TEXELS, 3)))
    towards = np.asarray(TO_LAMP) / np.linalg.norm(TO_LAMP)
    lamp_radius_m = LAMP_DISTANCE_M * float(np.tan(np.radians(LAMP_RADIUS_DEG)))
    radiance = IRRADIANCE / (np.pi * np.sin(np.radians(LAMP_RADIUS_DEG)) ** 2)
    placed = mi.ScalarTransform4f().look_at(origin=LAMP_DISTANCE_M * towards, target=(0, 0, 0), up=(0, 1, 0))
    total = max(ABSORPTION)
    scene = {
        "type": "scene",
        "integrator": {"type": "volpathmis", "max_depth": 32, "rr_depth": 16},
        "sensor": {
            "type": "perspective",
            "fov": FOV_DEG,
            "fov_axis": "y",
            "near_clip": 0.01,
            "to_world": mi.ScalarTransform4f().look_at(origin=CAMERA, target=TARGET, up=(0, 1, 0)),
            "film": {
                "type": "hdrfilm",
                "width": size[0],
                "height": size[1],
                "rfilter": {"type": "box"},
                "pixel_format": "rgb",
            },
            "sampler": {"type": "independent", "sample_count": samples},
        },
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": SKY}},
        "lamp": {
            "type": "disk",
            "to_world": placed @ mi.ScalarTransform4f().scale(lamp_radius_m),
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": float(radiance)}},
        },
        "tiles": {
            "type": "ply",
            "filename": str(folder / "tiles.ply"),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "mesh_attribute", "name": "vertex_color"}},
        },
        "glass": {
            "type": "ply",
            "filename": str(folder / "glass.ply"),
            "bsdf": {"type": "dielectric", "int_ior": N, "ext_ior": 1.0},
            "interior": {
                "type": "homogeneous",
                "sigma_t": {"type": "rgb", "value": [a / total for a in ABSORPTION]},
                "scale": total,
                "albedo": {"type": "rgb", "value": 0.0},
            },
        },
    }
    return np.array(mi.render(mi.load_dict(scene)), dtype=np.float32)


def pellucid_picture(size: tuple[int, int], samples: int, caustics: bool) -> Image:
    """(H, W, 3) radiance of the relief."""
    import pellucid as pl

    tiles, glass = surfaces()
    item = pl.ReliefSurface.plane(
        TILES * TILE_M,
        pl.ReliefLayer.of(tiles, specular=0.0),
        pl.ReliefLayer(glass, roughness=0.05),
        medium=N,
        absorption=ABSORPTION,
        tile_m=TILE_M,
        quality=pl.ReliefQuality(shadows="soft", occlusion="texture", caustics=caustics, reflection="search"),
    )
    way = tuple(float(-c) for c in TO_LAMP)
    lamp = pl.DirectionalLight(way, irradiance=IRRADIANCE, angular_radius_deg=LAMP_RADIUS_DEG)  # type: ignore[arg-type]
    camera = pl.Camera(position=CAMERA, target=TARGET, fov_deg=FOV_DEG)
    scene = pl.Scene(camera, pl.Environment.constant(SKY), [lamp], [item], tone_mapping="linear")
    return np.asarray(pl.render(scene, size=size, samples=samples).radiance, dtype=np.float32)


def main() -> None:
    """Render, compare, write, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("out/mitsuba_relief"))
    parser.add_argument("--size", type=int, nargs=2, default=(200, 150), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, nargs=2, default=(4096, 16), help="of Mitsuba, of Pellucid")
    options = parser.parse_args()
    size, folder = (options.size[0], options.size[1]), options.output
    folder.mkdir(parents=True, exist_ok=True)
    theirs, seconds = timed(lambda: mitsuba_picture(size, options.samples[0], folder))
    write_image(folder / "mitsuba.png", (255 * srgb(theirs) + 0.5).astype(np.uint8))
    rows: list[dict[str, Any]] = [{"name": "mitsuba", "seconds": seconds, "mean": theirs.mean((0, 1)).tolist()}]
    print("| picture | FLIP | of Mitsuba's mean | processor seconds |\n|---|---|---|---|")
    print(f"| mitsuba | | | {seconds:.1f} |")
    for name, caustics in (("pellucid", False), ("pellucid_caustics", True)):
        pellucid_picture(size, 1, caustics)  # the warm-up
        ours, seconds = timed(lambda caustics=caustics: pellucid_picture(size, options.samples[1], caustics))  # type: ignore[misc]
        row = {"name": name, "seconds": seconds, "mean": ours.mean((0, 1)).tolist()}
        rows.append(row | compare(theirs, ours, name, folder))
        print(f"| {name} | {rows[-1]['flip']:.4f} | {ours.mean((0, 1)) / theirs.mean((0, 1))} | {seconds:.1f} |")
    (folder / "comparison.json").write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
