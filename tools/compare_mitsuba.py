"""Light scattered once, by Mitsuba 3, by Pellucid and by the photon tracer, in two scenes with black surroundings.

*Block*: an index-matched block in parallel light. Mitsuba's `volpathmis` connects every scattering place to the lamp
and is stopped after one scattering (`max_depth` 2).

*Ball*: a ball of index 1.5, filled with the same kind of matter, near a lamp. Light gets in through the refracting
surface only, so a scattering place cannot be connected to the lamp: paths have to run into it, which therefore is a
small sphere (a point for Pellucid), and a surface counts as an event, which leaves no way to stop after one scattering
inside. Instead the matter scatters little (a few thousandths of what it absorbs), so that light scattered twice is as
much less. Where a camera ray meets the lamp without scattering, Mitsuba's picture shows the lamp; the tree of rays of
each pixel says where, and these pixels are left out of the means.

Run ``python tools/compare_mitsuba.py --output out/mitsuba`` (needs the extra `compare`). It writes the pictures and
`comparison.json` and prints a table.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation
from timed import timed

from pellucid.techniques.eikonal.reference import (
    Convex,
    Limits,
    Matter,
    Photons,
    Sphere,
    World,
    scattered_radiance,
    trace_light,
)
from pellucid.techniques.eikonal.reference_rays import follow

Image = NDArray[np.floating[Any]]
Triple = tuple[float, float, float]

EXTENT_M = 0.1
CAMERA: Triple = (0.16, 0.11, 0.24)
FOV_DEG = 26.0

BLOCK_M: Triple = (0.06, 0.04, 0.07)
BLOCK_LIGHT: Triple = (0.5, -1.0, -0.3)
BLOCK_IRRADIANCE = 3.0

BALL_RADIUS_M = 0.04
LAMP: Triple = (-0.10, 0.16, 0.10)
LAMP_RADIUS_M = 0.03
LAMP_INTENSITY = 0.2


@dataclass(frozen=True)
class Substance:
    """n, and absorption and scattering in 1/m with mean cosine g."""

    n: float
    absorption: Triple
    scattering: Triple
    g: float

    def matter(self) -> Matter:
        """For the photon tracer."""
        return Matter(self.n, self.absorption, self.scattering, self.g)


BLOCK = Substance(1.0, (2.0, 1.0, 6.0), (8.0, 16.0, 24.0), 0.4)
BALL = Substance(1.5, (20.0, 12.0, 8.0), (0.06, 0.06, 0.06), 0.3)


# --- Mitsuba ---------------------------------------------------------------------------------------------------


def mitsuba() -> Any:
    """The module, in a variant that needs no compiler: with an unsuitable LLVM the others abort the process."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    return mi


def medium(matter: Substance) -> dict[str, Any]:
    """Homogeneous medium in Mitsuba's words."""
    total = np.add(matter.absorption, matter.scattering)
    albedo = np.divide(matter.scattering, total)
    return {
        "type": "homogeneous",
        "sigma_t": {"type": "rgb", "value": (total / total.max()).tolist()},
        "scale": float(total.max()),
        "albedo": {"type": "rgb", "value": albedo.tolist()},
        "phase": {"type": "hg", "g": matter.g},
    }


def mitsuba_camera(mi: Any, size: tuple[int, int], samples: int) -> dict[str, Any]:
    """Pinhole that looks at the origin; every sample counts for the pixel it lies in."""
    film = {"width": size[0], "height": size[1], "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    return {
        "type": "perspective",
        "fov": FOV_DEG,
        "fov_axis": "y",
        "near_clip": 0.01,
        "to_world": mi.ScalarTransform4f().look_at(origin=CAMERA, target=(0, 0, 0), up=(0, 1, 0)),
        "film": {"type": "hdrfilm", **film},
        "sampler": {"type": "independent", "sample_count": samples},
    }


def mitsuba_block(size: tuple[int, int], samples: int) -> Image:
    """Picture (H, W, 3) of the block; one scattering."""
    mi = mitsuba()
    scene = {
        "type": "scene",
        "integrator": {"type": "volpathmis", "max_depth": 2, "rr_depth": 100},
        "sensor": mitsuba_camera(mi, size, samples),
        "lamp": {
            "type": "directional",
            "direction": BLOCK_LIGHT,
            "irradiance": {"type": "rgb", "value": BLOCK_IRRADIANCE},
        },
        "block": {
            "type": "cube",
            "to_world": mi.ScalarTransform4f().scale([0.5 * edge for edge in BLOCK_M]),
            "bsdf": {"type": "null"},
            "interior": medium(BLOCK),
        },
    }
    return np.array(mi.render(mi.load_dict(scene)), dtype=np.float64)


def mitsuba_ball(size: tuple[int, int], samples: int) -> Image:
    """Picture (H, W, 3) of the ball, with the lamp in it where a ray meets it without scattering."""
    mi = mitsuba()
    radiance = LAMP_INTENSITY / (np.pi * LAMP_RADIUS_M**2)
    scene = {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": 24, "rr_depth": 100, "hide_emitters": True},
        "sensor": mitsuba_camera(mi, size, samples),
        "lamp": {
            "type": "sphere",
            "center": LAMP,
            "radius": LAMP_RADIUS_M,
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": radiance}},
        },
        "ball": {
            "type": "sphere",
            "radius": BALL_RADIUS_M,
            "bsdf": {"type": "dielectric", "int_ior": BALL.n, "ext_ior": 1.0},
            "interior": medium(BALL),
        },
    }
    return np.array(mi.render(mi.load_dict(scene)), dtype=np.float64)


# --- photon tracer ---------------------------------------------------------------------------------------------


def camera_rays(size: tuple[int, int]) -> tuple[Image, Image]:
    """(H W, 3) origins and directions through the pixel centres."""
    import pellucid as pl

    origins, directions = pl.Camera(position=CAMERA, fov_deg=FOV_DEG).pixel_rays(size)
    return origins.reshape(-1, 3), directions.reshape(-1, 3)


def _seen(world: World, size: tuple[int, int], fluence: Callable[[Image], tuple[Image, Image]], pieces: int) -> Image:
    """Picture of the light scattered in the world's box; rays begin where they enter the box."""
    origins, directions = camera_rays(size)
    enter, leave = Convex.box(world.extent_m, Matter()).interval(origins, directions)
    hit = enter < leave
    picture = np.zeros((len(origins), 3))
    starts = origins[hit] + enter[hit, None] * directions[hit]
    picture[hit] = scattered_radiance(world, starts, directions[hit], fluence, pieces, Limits(bounces=12))
    return picture.reshape(size[1], size[0], 3)


def traced_block(size: tuple[int, int]) -> Image:
    """The block by quadrature; its fluence is a closed form."""
    block = Convex.box(BLOCK_M, BLOCK.matter())
    way = np.asarray(BLOCK_LIGHT) / np.linalg.norm(BLOCK_LIGHT)
    total = np.add(BLOCK.absorption, BLOCK.scattering)

    def fluence(x: Image) -> tuple[Image, Image]:
        depth = block.interval(x, np.broadcast_to(-way, x.shape))[1]
        return BLOCK_IRRADIANCE * np.exp(-depth[:, None] * total), np.broadcast_to(way, x.shape)

    return _seen(World((EXTENT_M,) * 3, [block]), size, fluence, 48)


def traced_ball(size: tuple[int, int], resolution: int, per_voxel: float) -> Image:
    """The ball by photons, whose fluence on voxels is looked up."""
    import pellucid as pl

    world = World((EXTENT_M,) * 3, [Sphere(BALL_RADIUS_M, BALL.matter())])
    lamp = pl.PointLight(LAMP, intensity=LAMP_INTENSITY)
    light = trace_light(world, [lamp], (resolution,) * 3, per_voxel, limits=Limits(bounces=12))

    def fluence(x: Image) -> tuple[Image, Image]:
        i, j, k = np.clip((x / EXTENT_M + 0.5) * resolution, 0, resolution - 1).astype(int).T
        return light.fluence[k, j, i], light.direction[k, j, i]

    return _seen(world, size, fluence, resolution)


# --- Pellucid --------------------------------------------------------------------------------------------------


def pellucid_picture(block: bool, size: tuple[int, int], resolution: int, samples: int = 16) -> Image:
    """Picture (H, W, 3) of the same block or ball, through the public interface.

    Pellucid draws the glint of the lamp on glass as a lobe of some breadth. What the same glass shows that absorbs all
    that it does not let through is taken off.
    """
    import pellucid as pl
    from pellucid.fields import shapes

    substance = BLOCK if block else BALL
    shape = shapes.box(BLOCK_M) if block else shapes.sphere(BALL_RADIUS_M)
    glass = pl.media.resolve(substance.n).with_absorption(substance.absorption)
    volume = pl.Volume.from_sdf(shape, glass, resolution, EXTENT_M)
    scatters = replace(volume.regions[0], scattering=substance.scattering, anisotropy=substance.g)
    extinction = np.add(substance.absorption, substance.scattering)
    absorbs = replace(volume.regions[0], medium=pl.media.resolve(substance.n).with_absorption(extinction))
    lamp = (
        pl.DirectionalLight(BLOCK_LIGHT, irradiance=BLOCK_IRRADIANCE)
        if block
        else pl.PointLight(LAMP, intensity=LAMP_INTENSITY)
    )
    pictures = []
    for region in (scatters, absorbs):
        scene = pl.Scene(
            camera=pl.Camera(position=CAMERA, fov_deg=FOV_DEG),
            environment=pl.Environment.constant((0.0, 0.0, 0.0)),
            lights=[lamp],
            objects=[pl.RefractiveVolume(volume.replace(regions=(region,)))],
        )
        pictures.append(np.asarray(pl.render(scene, size=size, samples=samples).radiance, dtype=np.float64))
    return pictures[0] - pictures[1]


# --- comparison ------------------------------------------------------------------------------------------------


def averaged(picture: Image, by: int) -> Image:
    """Means of `by` x `by` pixels."""
    height, width = picture.shape[0] // by, picture.shape[1] // by
    return picture.reshape(height, by, width, by, 3).mean((1, 3))


def lamp_pixels(size: tuple[int, int], finer: int = 6) -> NDArray[np.bool_]:
    """(H, W) where the lamp is seen without scattering, by whatever reflections, and a pixel around."""
    ball = Sphere(BALL_RADIUS_M, BALL.matter())
    origins, directions = camera_rays((finer * size[0], finer * size[1]))
    world = World((2.0 * BALL_RADIUS_M,) * 3, [ball])
    enter, leave = Convex.box(world.extent_m, Matter()).interval(origins, directions)
    hit = enter < leave
    starts = origins[hit] + enter[hit, None] * directions[hit]
    rays = Photons.begin(starts, directions[hit], np.ones((hit.sum(), 3)))
    limits, rng = Limits(min_flux=1e-9, bounces=24), np.random.default_rng(1)
    left = follow(world, rays, lambda *_: None, limits, rng).left
    seen = np.zeros(len(origins), bool)
    for group in left:
        near, far = Sphere(LAMP_RADIUS_M, Matter(), LAMP).interval(group.x, group.d)
        lit = (near < far) & (far > 0.0) & (group.bounces > 0)  # the lamp itself is hidden
        seen[np.nonzero(hit)[0][group.name[lit]]] = True
    picture = seen.reshape(size[1], finer, size[0], finer).any((1, 3))
    return np.asarray(binary_dilation(picture))


def compared(scene: str, size: tuple[int, int], samples: int, resolution: int) -> dict[str, Any]:
    """Pictures of one scene ("block" or "ball") by name, their means without lamp pixels, and processor seconds."""
    block = scene == "block"
    fine = (2 * size[0], 2 * size[1])
    makers: dict[str, Callable[[], Image]] = {
        "mitsuba": lambda: mitsuba_block(size, samples) if block else mitsuba_ball(size, samples),
        "pellucid": lambda: pellucid_picture(block, size, resolution),
        "photons": lambda: averaged(traced_block(fine) if block else traced_ball(fine, resolution, 4.0), 2),
    }
    counted = np.ones(size[::-1], bool) if block else ~lamp_pixels(size)
    done = {name: timed(make) for name, make in makers.items()}
    return {
        "pictures": {name: picture for name, (picture, _) in done.items()},
        "mean": {name: picture[counted].mean(0) for name, (picture, _) in done.items()},
        "seconds": {name: seconds for name, (_, seconds) in done.items()},
        "counted": counted,
    }


def main() -> None:
    """Render both scenes three times, compare, write, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("out/mitsuba"))
    parser.add_argument("--size", type=int, nargs=2, default=(96, 72), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, nargs=2, default=(1024, 16384), help="of Mitsuba: block, ball")
    parser.add_argument("--resolution", type=int, default=64, help="voxels along the edge of the volume")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    print("| scene | picture | mean radiance | of Mitsuba's | processor seconds |\n|---|---|---|---|---|")
    for scene, samples in zip(("block", "ball"), options.samples, strict=True):
        found = compared(scene, tuple(options.size), samples, options.resolution)
        brightest = np.quantile(found["pictures"]["photons"], 0.999)
        for name, picture in found["pictures"].items():
            mean, share = found["mean"][name], found["mean"][name] / found["mean"]["mitsuba"]
            encoded = np.clip(picture / brightest, 0.0, 1.0) ** (1.0 / 2.2)
            pixels = np.ascontiguousarray(np.repeat(np.repeat(encoded * 255 + 0.5, 4, 0), 4, 1).astype(np.uint8))
            OpenImageIO.ImageBuf(pixels).write(str(options.output / f"{scene}_{name}.png"))
            seconds = found["seconds"][name]
            rows.append({"scene": scene, "picture": name, "mean": mean.tolist(), "seconds": seconds})
            print(f"| {scene} | {name} | {mean} | {share} | {seconds:.1f} |")
    (options.output / "comparison.json").write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
