"""Natural water: a pool with a ball, a pond in the rain, a sea at sunset, a lake from above and from below."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.fields import Ripples, landscape, textures
from pellucid.fields.landscape import Ground
from pellucid.fields.waves import Ocean
from pellucid.scene import Camera, Environment, Mesh, Scene, Water
from pellucid.scene.shapes import vertex_normals

from . import stage
from .lake import lake_scene, underwater_window
from .picture import Picture

Corners = Sequence[Sequence[float]]


def _water(usual: dict[str, Any], wished: dict[str, Any]) -> Water:
    return Water(**(usual | wished))


def paved(rectangles: Sequence[Corners], tile_m: float, image: stage.Image, **look: Any) -> Mesh:
    """Rectangles on which an image repeats every `tile_m`.

    Parameters
    ----------
    rectangles : three corners each, (3,) metres: where the map's lower left is, then along u, then along v.
    """
    vertices, normals, uvs, faces = [], [], [], []
    for i, corners in enumerate(rectangles):
        start, along, across = (np.asarray(corner, float) for corner in corners)
        edge_u, edge_v = along - start, across - start
        size = np.linalg.norm(edge_u), np.linalg.norm(edge_v)
        vertices.append([start, along, along + edge_v, across])
        normals.append(np.tile(np.cross(edge_u, edge_v) / (size[0] * size[1]), (4, 1)))
        uvs.append(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * np.array(size) / tile_m)
        faces.append(np.array([[0, 1, 2], [0, 2, 3]]) + 4 * i)
    settings: dict[str, Any] = {"base_color": (1.0, 1.0, 1.0), "base_color_map": image} | look
    places_m, corners_of, up, at = (np.concatenate(list(part)) for part in (vertices, faces, normals, uvs))
    return Mesh(places_m, corners_of, up, at, **settings)


def basin(size_m: tuple[float, float, float], rim_m: float = 0.12, deck_m: float = 1.6) -> list[Mesh]:
    """A tiled pool about the origin, sunk into a deck of stone; y = 0 lies `rim_m` below the deck.

    Parameters
    ----------
    size_m : along x, depth, along z.
    """
    x, depth, z = 0.5 * size_m[0], size_m[1], 0.5 * size_m[2]
    low, high, far_x, far_z = -depth, rim_m, 0.5 * size_m[0] + deck_m, 0.5 * size_m[2] + deck_m
    tiles = textures.tiles(384, 3, tile_m=0.8, edge_m=0.0965, handmade=0.35, glaze_color=(0.28, 0.52, 0.60),
                           grout_color=(0.62, 0.62, 0.58))  # fmt: skip
    stones = textures.tiles(384, 8, tile_m=1.2, edge_m=0.397, grout_m=0.006, handmade=0.25,
                            glaze_color=(0.50, 0.44, 0.36), grout_color=(0.22, 0.20, 0.17))  # fmt: skip
    inside: list[Corners] = [
        [(-x, low, z), (x, low, z), (-x, low, -z)],
        [(-x, low, -z), (x, low, -z), (-x, high, -z)],
        [(x, low, z), (-x, low, z), (x, high, z)],
        [(-x, low, z), (-x, low, -z), (-x, high, z)],
        [(x, low, -z), (x, low, z), (x, high, -z)],
    ]
    around: list[Corners] = [
        [(-far_x, high, -z), (far_x, high, -z), (-far_x, high, -far_z)],
        [(-far_x, high, far_z), (far_x, high, far_z), (-far_x, high, z)],
        [(-far_x, high, z), (-x, high, z), (-far_x, high, -z)],
        [(x, high, z), (far_x, high, z), (x, high, -z)],
    ]
    return [
        paved(inside, 0.8, np.asarray(tiles.colors), roughness=0.35),
        paved(around, 1.2, np.asarray(stones.colors), roughness=0.8, specular=0.02),
    ]


def beach_ball(radius_m: float, **look: Any) -> Mesh:
    """A ball of six segments in four colours."""
    colors = np.array([(0.75, 0.03, 0.03), (0.85, 0.85, 0.82), (0.02, 0.12, 0.55), (0.85, 0.85, 0.82),
                       (0.85, 0.55, 0.02), (0.85, 0.85, 0.82)], np.float32)  # fmt: skip
    picture = colors.repeat(64, axis=0)[None].repeat(192, axis=0).copy()
    picture[:14] = picture[-14:] = (0.85, 0.85, 0.82)
    return Mesh.sphere(radius_m, 72, base_color=(1.0, 1.0, 1.0), base_color_map=picture, roughness=0.3, **look)


def pool_ripples(side_m: tuple[float, float], cells: int = 288, seed: int = 4) -> Ripples:
    """Water of a pool about x and z in which some have been swimming."""
    cell = side_m[0] / cells
    water = Ripples((round(side_m[1] / cell), cells), cell, speed_m_s=0.9, damping=0.12, limit_m=0.05)
    rng = np.random.default_rng(seed)
    for _ in range(26):
        x, z = rng.uniform(-0.46, 0.46, 2) * side_m
        water.drop(float(x), float(z), float(rng.uniform(0.09, 0.22)), float(rng.normal(0.0, 0.022)),
                   float(rng.uniform(0.0, 2.2)))  # fmt: skip
    return water


def pool_scene(
    camera: Camera | None = None, sun: tuple[float, float] = (52.0, -40.0), waves: Any = None, **water: Any
) -> Scene:
    """A tiled pool of 6 m x 1.5 m x 4 m with a ball that floats and one that lies on its ground.

    Parameters
    ----------
    sun : elevation and azimuth, degrees. waves : ripples when None; give 0 for flat water. water : of the Water.
    """
    size = (6.0, 1.5, 4.0)
    sky, lamp = stage.daylight(*sun)
    ripples = pool_ripples((size[0], size[2])) if waves is None else (waves or None)
    pool = _water({"extent_m": (size[0], size[2]), "waves": ripples, "medium": "pure water"}, water)
    sunk = Mesh.sphere(0.22, 64, position=(-1.1, -1.28, -0.5), base_color=(0.62, 0.30, 0.04), roughness=0.4)
    balls = [beach_ball(0.3, position=(0.9, 0.06, 0.35), rotation=(64.0, 20.0, 10.0)), sunk]
    return Scene(
        camera or Camera((0.6, 3.1, 4.7), (0.05, -0.55, 0.1), fov_deg=42.0),
        sky, [lamp], [*basin(size), *balls, pool], exposure=0.7, tone_mapping="khronos",
    )  # fmt: skip


def pond_ground(corners: int = 129, seed: int = 9) -> tuple[Ground, list[Mesh]]:
    """A garden pond of 4 m in a meadow: its ground, stones around it, reeds."""
    ground = landscape.lake_basin(corners, seed, 8.0, (2.1, 1.7), 0.7, 0.8)
    rng = np.random.default_rng(seed)
    soil, uvs = ground.patch(), ground.uvs() * ground.size_m
    dry = soil.vertices[soil.faces, 1].mean(axis=1) > 0.09
    pebbles = textures.cobbles(512, 5, tile_m=1.0, stone_m=0.055, relief_m=0.01, gap_m=0.004,
                               stone_color=(0.24, 0.20, 0.15))  # fmt: skip
    up = vertex_normals(soil.vertices, soil.faces)
    look: dict[str, Any] = {"base_color": (1.0, 1.0, 1.0), "roughness": 0.95, "specular": 0.01}
    bed, meadow = (
        Mesh(soil.vertices, soil.faces[which], up, uvs, base_color_map=picture, **look)
        for which, picture in ((~dry, np.asarray(pebbles.colors)), (dry, _grass()))
    )
    stones: list[landscape.Patch] = []
    clumps: list[landscape.Patch] = []
    while len(stones) < 60:
        x, z = rng.uniform(-3.0, 3.0, 2)
        height = float(ground.height(x, z))
        if -0.25 < height < 0.12:
            radius = float(rng.uniform(0.05, 0.1) * (1.0 + 2.0 * rng.random() ** 3))
            squat = radius * np.array([1.0, rng.uniform(0.5, 0.8), rng.uniform(0.7, 1.0)])
            boulder = landscape.stone(int(rng.integers(99)), finer=3)
            stones.append(boulder.placed((x, height + 0.2 * radius, z), rng.uniform(0.0, 6.3), squat))
    while len(clumps) < 5:
        x, z = rng.uniform(-2.0, 2.0, 2)
        if -0.3 < (height := float(ground.height(x, z))) < -0.05 and z < 0.3:
            clumps.append(landscape.reeds(46, 0.95, 0.22, int(rng.integers(99))).placed((x, height, z)))
    rocks, blades = landscape.joined(stones), landscape.joined(clumps)
    return ground, [
        bed,
        meadow,
        Mesh(rocks.vertices, rocks.faces, base_color=(0.24, 0.235, 0.225), roughness=0.7),
        Mesh(blades.vertices, blades.faces, base_color=(0.10, 0.17, 0.035), roughness=0.7),
    ]


def _grass(texels: int = 512) -> npt.NDArray[np.float32]:
    """A meadow from above, one metre of it."""
    coarse, fine = stage.noise((texels, texels), (40.0, 40.0), 3), stage.noise((texels, texels), (5.0, 1.2), 4)
    green = np.array((0.055, 0.10, 0.02)) * (1.0 + 0.35 * fine + 0.25 * coarse)[..., None]
    return np.clip(green, 0.0, 1.0).astype(np.float32)


def rain(side_m: float, seconds: float, drops_a_second: float, cells: int = 320, seed: int = 2) -> Ripples:
    """Rings of raindrops that fall all over a square for some seconds."""
    water = Ripples((cells, cells), side_m / cells, speed_m_s=0.32, damping=0.5, limit_m=0.05)
    rng = np.random.default_rng(seed)
    for _ in range(round(seconds * drops_a_second)):
        x, z = rng.uniform(-0.48, 0.48, 2) * side_m
        radius = max(float(rng.uniform(0.03, 0.05)), 1.05 * side_m / cells)
        water.drop(float(x), float(z), radius, float(rng.uniform(0.03, 0.06)), float(rng.uniform(0.0, seconds)))
    return water


def overcast(zenith: float = 1.0) -> Environment:
    """A grey sky, three times as bright overhead as at the horizon [moon1942], over a meadow."""
    sine = np.sin(np.radians(90.0 - 180.0 * (np.arange(64) + 0.5) / 64))[:, None, None]
    grey = zenith * (1.0 + 2.0 * np.maximum(sine, 0.0)) / 3.0 * np.array((0.92, 0.98, 1.06))
    ground = zenith * np.array((0.05, 0.07, 0.03))
    return Environment(np.where(sine > 0.0, grey, ground).repeat(128, axis=1).astype(np.float32))


def rain_on_pond(camera: Camera | None = None, seconds: float = 6.0, **water: Any) -> Scene:
    """A garden pond under an overcast sky while it rains, for so many seconds."""
    _, meshes = pond_ground()
    pond = _water({"extent_m": 6.4, "waves": rain(6.4, seconds, 30.0), "medium": "lake"}, water)
    return Scene(
        camera or Camera((0.4, 0.75, 2.7), (0.0, -0.08, 0.2), fov_deg=40.0, near_m=0.05),
        overcast(), [], [*meshes, pond], exposure=1.9, tone_mapping="khronos",
    )  # fmt: skip


def skerry(seed: int = 3) -> list[Mesh]:
    """A few rocks that look out of the sea."""
    rng = np.random.default_rng(seed)
    parts = []
    for x, z, radius in (
        (-3.4, -17.0, 2.1),
        (-5.6, -18.5, 1.3),
        (-1.3, -19.0, 1.0),
        (7.5, -38.0, 2.6),
        (9.8, -40.0, 1.7),
    ):
        squat = radius * np.array([1.3, rng.uniform(0.7, 1.0), 1.0])
        parts.append(
            landscape.stone(int(rng.integers(99)), 0.32, 4).placed((x, -0.25 * radius, z), rng.uniform(0, 6), squat)
        )
    rocks = landscape.joined(parts)
    return [Mesh(rocks.vertices, rocks.faces, base_color=(0.085, 0.078, 0.07), roughness=0.55)]


def sunset_sea(
    camera: Camera | None = None, sun: tuple[float, float] = (5.0, 9.0), wind_m_s: float = 5.0, **water: Any
) -> Scene:
    """A sea with rocks under a low sun.

    Parameters
    ----------
    sun : elevation and azimuth, degrees. wind_m_s : that made the waves. water : of the Water.
    """

    sky, lamp = stage.daylight(*sun)
    waves = Ocean(wind_m_s, 75.0, tile_m=42.0, shape=(512, 512), fetch_m=30e3, choppiness=1.1, seed=7)
    sea = _water({"extent_m": 20_000.0, "waves": waves, "medium": "clear ocean", "foam": 0.3}, water)
    return Scene(
        camera or Camera((0.0, 2.4, 6.0), (-0.6, 1.0, -12.0), fov_deg=46.0, far_m=20_000.0),
        sky, [lamp], [*skerry(), sea], exposure=0.9, tone_mapping="agx", glow=0.05,
    )  # fmt: skip


def lake_waves(amplitude: float = 0.35) -> Ocean:
    """What a breeze makes of a lake in some minutes."""
    return Ocean(1.8, 30.0, tile_m=12.0, shape=(256, 256), fetch_m=250.0, amplitude=amplitude, seed=3)


PICTURES = (
    Picture(
        "water-pool",
        "Pool with a ball",
        "Waves run over a tiled pool and draw a net of bright lines on its floor; the ball that floats is cut and "
        "shifted by the surface, and both balls throw soft shadows below it.",
        pool_scene,
        3,
        2.4,
    ),
    Picture(
        "water-below",
        "Pool from below",
        "Bright lines over floor and walls, and over the ball that lies there; the surface mirrors them. Through its "
        "window there is the sky, and the upper half of the floating ball, torn off from the lower one.",
        lambda: pool_scene(Camera((0.0, -0.8, 1.6), (0.6, -0.4, -1.0), fov_deg=80.0)),
        3,
        2.4,
    ),
    Picture(
        "water-lake",
        "Lake",
        "Hills and spruces are mirrored in a lake, broken by small waves; near the shore a boulder and the sand are "
        "seen through the water, farther out its own colour.",
        lambda: lake_scene(lake_waves()),
        3,
    ),
    Picture(
        "water-sunset",
        "Sea at sunset",
        "Under a low sun its light lies on the sea as a glittering path, with rocks dark before it.",
        sunset_sea,
        4,
    ),
    Picture(
        "water-window",
        "Diver's window",
        "Looking up from the lake: all of the sky in a bright round window, whose edge the waves tear, with a boat in "
        "it and a glow around the sun; outside of it the surface mirrors the dark of the lake.",
        lambda: underwater_window(lake_waves()),
        3,
    ),
    Picture(
        "water-rain",
        "Rain on a pond",
        "Rings of many drops cross on a garden pond under a grey sky; stones and mud are seen through the water.",
        rain_on_pond,
        3,
        4.0,
    ),
)
