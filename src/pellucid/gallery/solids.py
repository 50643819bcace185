"""Bodies of glass: a ball, three glasses in one another, lettering in a block, an animal."""

from __future__ import annotations

import dataclasses

import numpy as np

from pellucid.fields import shapes
from pellucid.fields.volume import Volume
from pellucid.media import Medium
from pellucid.scene import Camera, Environment, Mesh, Quality, RefractiveVolume, Scene

from . import stage
from .picture import Picture


def glass_sphere() -> Scene:
    """A ball of N-BK7, 8 cm wide, on a chessboard with two painted balls behind it."""
    radius = 0.04
    ball = RefractiveVolume.from_sdf(
        shapes.sphere(radius),
        "N-BK7",
        96,
        2.15 * radius,
        position=(0.0, radius + stage.GAP_M, 0.0),
        dispersion=False,
        light=stage.QUICK_LIGHT,
    )
    board = stage.table(0.08, stage.checks((0.72, 0.68, 0.60), (0.02, 0.05, 0.075)), 60.0, roughness=0.4)
    sky, sun = stage.daylight()
    red = Mesh.sphere(0.026, 96, position=(-0.078, 0.026, -0.062), base_color=(0.62, 0.06, 0.03), roughness=0.3)
    gold = Mesh.sphere(0.017, 96, position=(0.075, 0.017, -0.03), base_color=(0.80, 0.44, 0.05), roughness=0.3)
    return Scene(
        Camera((0.05, 0.085, 0.22), (0.0, 0.037, 0.0), fov_deg=34.0),
        sky,
        [sun],
        [board, red, gold, ball],
        exposure=0.62,
        tone_mapping="khronos",
    )


def three_glass_cube() -> Scene:
    """Rounded cubes of three glasses in one another, each its own colour and index."""
    size, shell = 0.05, 0.008
    inner, middle, outer = shapes.nested_rounded_cubes(size, shell, 0.008)
    glasses = [
        (inner, stage.tinted("N-SF66", (3.0, 95.0, 120.0))),
        (middle, stage.tinted("F2", (4.0, 16.0, 110.0))),
        (outer, stage.tinted("N-BK7", (14.0, 3.0, 1.5))),
    ]
    volume = Volume.from_regions(glasses, 112, 1.08 * size)
    milky = [(9.0, 0.75), (5.0, 0.8), (2.5, 0.8)]
    layers = [
        dataclasses.replace(region, scattering=(strength,) * 3, anisotropy=g)
        for region, (strength, g) in zip(volume.regions, milky, strict=True)
    ]
    cube = RefractiveVolume.from_volume(
        volume.replace(regions=tuple(layers)), position=(0.0, 0.5 * size + stage.GAP_M, 0.0), rotation=(0.0, 31.0, 0.0),
        dispersion=False, quality=Quality(bounces=6, min_weight=0.03), light=stage.QUICK_LIGHT,
    )  # fmt: skip
    return Scene(
        Camera((0.02, 0.088, 0.16), (0.0, 0.022, 0.0), fov_deg=28.0),
        Environment.studio(),
        [stage.key_light(5.0)],
        [stage.table(0.36, stage.wood(), 4.0, roughness=0.4), cube],
        exposure=0.75,
        tone_mapping="khronos",
    )


def lettered_block() -> Scene:
    """The name of the house in blue glass, cast into a clear block."""
    x, y, z = 0.12, 0.036, 0.026
    letters = shapes.lettering("PELLUCID", 0.0155, 0.009, 0.0028, rounding_m=0.0007)
    block = shapes.rounded_box((x, y, z), 0.0035)
    glasses: list[tuple[shapes.Shape, Medium | str]] = [
        (letters, stage.tinted("SF11", (300.0, 130.0, 4.0))),
        (block, "N-BK7"),
    ]
    body = RefractiveVolume.from_regions(
        glasses, 224, (1.05 * x, 1.12 * y, 1.15 * z), position=(0.0, 0.5 * y + stage.GAP_M, 0.0),
        rotation=(0.0, -16.0, 0.0), dispersion=False, quality=Quality(bounces=6, min_weight=0.02),
        light=stage.QUICK_LIGHT,
    )  # fmt: skip
    cloth = stage.grid(512, 4, (0.62, 0.60, 0.55), (0.33, 0.15, 0.09), 0.09)
    return Scene(
        Camera((0.02, 0.082, 0.19), (0.0, 0.016, 0.0), fov_deg=31.0),
        Environment.studio(),
        [stage.key_light(2.0)],
        [stage.table(0.08, cloth, 4.0, roughness=0.8), body],
        exposure=0.65,
        tone_mapping="khronos",
    )


def glass_hare() -> Scene:
    """An animal of our own, made as a mesh and put on voxels, in tinted glass."""
    height = 0.09
    mesh = shapes.creature_mesh(height)
    lowest = float(np.asarray(mesh[0])[:, 1].min())
    hare = RefractiveVolume.from_mesh(
        mesh, stage.tinted("N-BAK4", (13.0, 3.0, 6.0)), 144, position=(0.0, stage.GAP_M - lowest, 0.0),
        rotation=(0.0, 28.0, 0.0), dispersion=False, light=stage.QUICK_LIGHT,
    )  # fmt: skip
    sky, sun = stage.daylight()
    return Scene(
        Camera((0.03, 0.068, 0.235), (0.0, 0.046, 0.0), fov_deg=27.0),
        sky,
        [sun],
        [stage.table(0.4, stage.wood(), 60.0, roughness=0.4), hare],
        exposure=0.6,
        tone_mapping="khronos",
    )


PICTURES = (
    Picture(
        "glass-sphere",
        "Glass ball on a chessboard",
        "The ball shows the board and the painted balls upside down, and the sky below them; its rim mirrors the sky.",
        glass_sphere,
        4,
    ),
    Picture(
        "three-glass-cube",
        "Three glasses in one another",
        "A clear rounded cube holds an amber one, and that a red one; light sparkles in their slightly milky insides, "
        "and throws coloured patterns on the table.",
        three_glass_cube,
        3,
    ),
    Picture(
        "lettered-block",
        "Lettering in a block",
        "The word PELLUCID in blue glass floats in a clear block, and is seen again in its walls.",
        lettered_block,
        4,
    ),
    Picture(
        "glass-hare",
        "Animal from a mesh",
        "A sitting animal of glass, greener where it is thick; sky and boards stand upside down in its head and belly.",
        glass_hare,
        5,
    ),
)
