"""Several bodies at once, seen through one another: nine balls, and a museum with five things in it."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid import media
from pellucid.fields import shapes
from pellucid.scene import Camera, Environment, Mesh, PointLight, Quality, RefractiveVolume, Scene

from . import stage
from .picture import Picture


def nine_spheres() -> Scene:
    """A large ball on 112 voxels and eight small ones on 32 about it, in eight colours."""
    large, small, ring = 0.04, 0.013, 0.072
    light = stage.QUICK_LIGHT.replace(caustic_texels=160)
    fine = stage.QUICK_LIGHT.replace(front_voxels=1.0, caustic_texels=96)
    big = RefractiveVolume.from_sdf(
        shapes.sphere(large), "N-BK7", 112, 2.1 * large, position=(0.0, large + stage.GAP_M, 0.0), dispersion=False,
        light=light,
    )  # fmt: skip
    colours = [
        (8.0, 160.0, 190.0), (4.0, 70.0, 210.0), (4.0, 16.0, 170.0), (70.0, 6.0, 120.0), (130.0, 8.0, 28.0),
        (170.0, 40.0, 4.0), (90.0, 120.0, 6.0), (14.0, 140.0, 60.0),
    ]  # fmt: skip
    balls = []
    for k, absorption in enumerate(colours):
        turn = np.radians(45.0 * k + 20.0)
        place = (ring * float(np.sin(turn)), small + stage.GAP_M, ring * float(np.cos(turn)))
        glass = stage.tinted("SF10", absorption)
        balls.append(
            RefractiveVolume.from_sdf(
                shapes.sphere(small), glass, 32, 2.4 * small, position=place, dispersion=False,
                quality=Quality(bounces=5, min_weight=0.02), light=fine,
            )
        )  # fmt: skip
    sky, sun = stage.daylight(42.0, -50.0)
    tiles = stage.checks((0.70, 0.67, 0.60), (0.16, 0.15, 0.14))
    return Scene(
        Camera((0.03, 0.115, 0.25), (0.0, 0.022, 0.0), fov_deg=34.0),
        sky,
        [sun],
        [stage.table(0.05, tiles, 40.0, roughness=0.4), big, *balls],
        exposure=0.6,
        tone_mapping="khronos",
    )


def museum() -> Scene:
    """Five things of glass on plinths: lettering, an animal, cubes in one another, a ball, a glass of wine."""
    light = stage.QUICK_LIGHT.replace(front_voxels=6.0, split_voxels=4.0, bounces=3, min_flux=0.05, caustic_texels=128)
    top = 0.9
    places = [(-0.31, 0.02), (-0.15, -0.13), (0.0, 0.06), (0.16, -0.13), (0.32, 0.03)]
    glass, wine = shapes.wine_glass(0.19, wall_m=0.0024, filled=0.4)
    claret = media.get("water").with_absorption((7.0, 95.0, 62.0), name="claret")
    size = 0.075
    inner, middle, outer = shapes.nested_rounded_cubes(size, 0.012, 0.011)
    letters = shapes.lettering("PELLUCID", 0.0125, 0.009, 0.0026, rounding_m=0.0006)
    block = shapes.rounded_box((0.1, 0.036, 0.026), 0.0035)
    bodies: list[tuple[list[tuple[Any, Any]], int, tuple[float, float, float], float, float]] = [
        ([(letters, stage.tinted("SF11", (300.0, 130.0, 4.0))), (block, "N-BK7")],
         160, (0.106, 0.042, 0.032), 0.036, 12.0),
        ([(shapes.creature(0.12), stage.tinted("N-BAK4", (13.0, 3.0, 6.0)))], 96, (0.09, 0.126, 0.116), 0.1135, 25.0),
        ([(inner, stage.tinted("N-SF66", (2.0, 65.0, 80.0))), (middle, stage.tinted("F2", (3.0, 11.0, 75.0))),
          (outer, stage.tinted("N-BK7", (10.0, 2.0, 1.0)))], 80, (1.08 * size,) * 3, size, 31.0),
        ([(shapes.sphere(0.052), stage.tinted("N-BK7", (14.0, 5.0, 1.2)))], 72, (0.108,) * 3, 0.104, 0.0),
        ([(glass, "soda-lime glass"), (wine, claret)], 176, (0.076, 0.196, 0.076), 0.19, 0.0),
    ]  # fmt: skip
    things: list[Mesh | RefractiveVolume] = []
    for (regions, voxels, extent, tall, turn), (x, z) in zip(bodies, places, strict=True):
        things.append(
            Mesh.box((0.13, top, 0.13), position=(x, 0.5 * top, z), base_color=(0.62, 0.61, 0.58), roughness=0.8)
        )
        things.append(
            RefractiveVolume.from_regions(
                regions, voxels, extent, position=(x, top + 0.5 * tall + stage.GAP_M, z), rotation=(0.0, turn, 0.0),
                dispersion=False,
                quality=Quality(bounces=6, min_weight=0.03), light=light,
            )
        )  # fmt: skip
    wall = Mesh.plane((4.0, 3.0), position=(0.0, 1.0, -0.55), rotation=(90.0, 0.0, 0.0), base_color=(0.34, 0.13, 0.10),
                      roughness=0.9)  # fmt: skip
    pictures = [
        Mesh.box((0.36, 0.26, 0.02), position=(x, 1.02, -0.54), base_color=colour, roughness=0.7)
        for x, colour in ((-0.46, (0.55, 0.42, 0.16)), (0.0, (0.10, 0.20, 0.30)), (0.46, (0.24, 0.30, 0.14)))
    ]
    lamp = PointLight((-0.45, 1.75, 0.55), (1.0, 0.96, 0.9), 5.5)
    return Scene(
        Camera((0.04, 1.13, 0.98), (0.01, 0.955, -0.02), fov_deg=33.0),
        Environment.studio(intensity=0.5),
        [lamp],
        [stage.table(0.6, stage.wood(), 6.0, roughness=0.4), wall, *pictures, *things],
        exposure=0.8,
        tone_mapping="khronos",
    )


PICTURES = (
    Picture(
        "nine-spheres",
        "Nine balls",
        "A large clear ball and eight small coloured ones about it; through the large one those behind it are seen, "
        "and each throws a spot of its own colour.",
        nine_spheres,
        3,
    ),
    Picture(
        "museum",
        "Five things in a museum",
        "Five plinths with lettering in a block, an animal, cubes in one another, a ball and a glass of wine; each "
        "shows what stands behind it.",
        museum,
        3,
    ),
)
