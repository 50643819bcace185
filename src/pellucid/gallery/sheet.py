"""A picture under a sheet of water: a basin with painted fish, and what an approximate refraction gets wrong."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.fields import Ripples, textures
from pellucid.scene import Camera, Environment, Mesh, RefractiveSheet, Scene, sphere_map

from . import stage
from .picture import Picture

# Where fish swim: middle x and z, heading in degrees from +x towards +z, length, bend; a basin is 1 wide.
FISH = ((-0.17, -0.12, 20.0, 0.36, 0.5), (0.2, 0.1, 205.0, 0.33, -0.6), (-0.12, 0.24, -35.0, 0.28, 0.4),
        (0.22, -0.28, 130.0, 0.24, 0.5))  # fmt: skip
STONE = (0.42, 0.40, 0.37)


def basin(
    size_m: tuple[float, float], depth_m: float, rim_m: float = 0.08, center: tuple[float, float] = (0.0, 0.0)
) -> list[Mesh]:
    """Four walls of stone around a sheet, from `depth_m` below it to a little above it."""
    top = 0.03
    high, x, z = depth_m + top, 0.5 * (size_m[0] + rim_m), 0.5 * (size_m[1] + rim_m)
    long, side = (size_m[0] + 2.0 * rim_m, high, rim_m), (rim_m, high, size_m[1])
    return [
        Mesh.box(size, position=(center[0] + a, top - 0.5 * high, center[1] + b), base_color=STONE, roughness=0.8)
        for a, b, size in ((x, 0.0, side), (-x, 0.0, side), (0.0, z, long), (0.0, -z, long))
    ]


def rings(
    size_m: tuple[float, float], drops: tuple[tuple[float, float, float, float], ...], time_s: float
) -> np.ndarray:
    """(H, W) heights of ripples at a time, from drops at x, z, of a radius, and at a time."""
    cell = size_m[0] / 192
    water = Ripples((round(size_m[1] / cell), 192), cell, 0.35, damping=0.5, limit_m=0.05)
    for x, z, radius, when in drops:
        water.drop(x, z, radius, radius, time_s=when)
    return np.array(water.advance(time_s))


def pond_floor(size: int = 768) -> np.ndarray:
    """(H, W, 3) reflectance: pebbles, and painted fish over them with their shadows."""
    pebbles = textures.cobbles(256, 5, tile_m=0.5, stone_m=0.06, relief_m=0.02, gap_m=0.008,
                               stone_color=(0.30, 0.33, 0.30), sand_color=(0.16, 0.15, 0.11))  # fmt: skip
    picture = np.tile(np.asarray(pebbles.colors, float), (2, 2, 1))
    picture = picture.repeat(2, 0).repeat(2, 1)[:size, :size] * 0.8
    z, x = (np.mgrid[0:size, 0:size] + 0.5) / size - 0.5
    patches = stage.noise((size, size), (22.0, 22.0), 8)
    for number, fish in enumerate(FISH):
        shade, _ = _fish(x - 0.025, z - 0.03, fish, 0.012)
        picture *= 1.0 - 0.55 * shade[..., None]
        body, across = _fish(x, z, fish, 0.004)
        koi = patches if number % 2 == 0 else -patches
        color = np.where((koi > 0.1)[..., None], (0.85, 0.17, 0.02), (0.82, 0.76, 0.66))
        color = color * (1.0 - 0.45 * np.clip(np.abs(across), 0.0, 1.0) ** 2)[..., None]
        picture += body[..., None] * (color - picture)
    return np.asarray(np.clip(picture, 0.0, 1.0), np.float32)


def _fish(
    x: np.ndarray, z: np.ndarray, fish: tuple[float, float, float, float, float], soft: float
) -> tuple[np.ndarray, np.ndarray]:
    """Coverage of a fish seen from above, and how far from its spine, 1 at its outline."""
    middle_x, middle_z, heading, length, bend = fish
    c, s = np.cos(np.radians(heading)), np.sin(np.radians(heading))
    a = ((x - middle_x) * c + (z - middle_z) * s) / length + 0.5  # 0 at the tail's end, 1 at the nose
    b = (-(x - middle_x) * s + (z - middle_z) * c) / length - 0.12 * bend * (a - 0.5) * (1.3 - a) * 2.0
    body = 0.13 * np.sqrt(np.clip((a - 0.18) / 0.82, 0.0, 1.0)) * np.sqrt(np.clip(1.0 - a, 0.0, 1.0)) * 1.5
    tail = np.where((a > 0.0) & (a < 0.26), 0.02 + 0.32 * np.clip(0.22 - a, 0.0, 1.0), 0.0)
    fins = 0.16 * np.exp(-(((a - 0.68) / 0.06) ** 2)) + 0.09 * np.exp(-(((a - 0.42) / 0.05) ** 2))
    half = np.maximum(np.maximum(body, tail), np.where(body > 0.0, np.minimum(fins, 0.2), 0.0))
    edge = np.clip((half - np.abs(b)) * length / soft + 0.5, 0.0, 1.0) * (half > 0.0)
    return edge, b / np.maximum(half, 1e-6)


def pond() -> Scene:
    """A basin with painted fish under rings of water."""
    heights = rings((1.0, 1.0), ((-0.2, 0.1, 0.035, 0.0), (0.24, -0.2, 0.03, 0.2)), 0.6)
    sky, sun = stage.daylight(42.0, -60.0)
    water = RefractiveSheet(pond_floor(), 0.25, 1.0, heights, segments=384, lit=True)
    ground = stage.table(0.8, stage.stone(512, (0.36, 0.33, 0.28)), 8.0, roughness=0.9, position=(0.0, -0.27, 0.0))
    things = [ground, *basin((1.0, 1.0), 0.27), water]
    camera = Camera((0.22, 1.0, 1.0), (0.0, -0.08, 0.03), fov_deg=44.0)
    return Scene(camera, sky, [sun], things, exposure=1.1, tone_mapping="khronos")


def errors() -> Scene:
    """One basin three times: exact, approximate with a sphere map, and how far that is off."""
    size = (1.0, 2.4)
    heights = rings(size, ((0.05, 0.55, 0.035, 0.0), (-0.25, -0.5, 0.035, 0.25)), 0.95)
    sky = Environment.sky(35.0, 160.0, 2.5, sun_disc=False)
    tiles = stage.grid(512, 1, (0.10, 0.38, 0.48), (0.85, 0.85, 0.80), 0.12)
    tiles = np.tile(tiles[::4, ::4], (18, 8, 1))
    factor: dict[str, Any] = {"refraction": "approximate", "per": "vertex", "segments": 128}
    looks: list[dict[str, Any]] = [
        {"segments": 512},
        {**factor, "reflection": "sphere_map", "sphere_map": sphere_map(sky, 512), "blend": 0.15},
        {**factor, "show": "error", "error_scale": 0.05},
    ]
    shared: dict[str, Any] = {"borders": "shrink", "deviation_m": 0.3, "meshes": False}
    things: list[Any] = []
    for k, look in enumerate(looks):
        x = 1.06 * (k - 1)
        things.append(RefractiveSheet(tiles, 0.35, size, heights, position=(x, 0.0, 0.0), **shared, **look))
        things += basin(size, 0.36, 0.06, (x, 0.0))
    return Scene(
        Camera((0.0, 1.75, 2.7), (0.0, 0.0, 0.05), fov_deg=42.0), sky, [stage.daylight(45.0, 140.0)[1]], things,
        exposure=0.9, tone_mapping="khronos",
    )  # fmt: skip


PICTURES = (
    Picture(
        "sheet-pond",
        "Fish in a flat picture",
        "Fish over pebbles, all of it one flat picture, seen through water with two rings of ripples; the walls of the "
        "basin go on under water, bent at its surface.",
        pond,
        2,
    ),
    Picture(
        "sheet-errors",
        "Refraction by a factor",
        "One tiled basin three times, with the same ripples: on the left rays obey Snell's law, in the middle they are "
        "bent by a factor, which looks much alike; on the right colours say how far off that is, from black for none "
        "over blue and green to white for 5 cm.",
        errors,
        2,
    ),
)
