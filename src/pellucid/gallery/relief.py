"""Reliefs of stone: from a painted plane to depth, steps of the search, shadows, wet ground, a planet under rain."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.fields import textures
from pellucid.fields.textures.maps import places, ramp
from pellucid.scene import Camera, DirectionalLight, Environment, Mesh, ReliefLayer, ReliefQuality, ReliefSurface, Scene

from . import stage
from .picture import Picture

BRASS: dict[str, Any] = {"base_color": (0.55, 0.36, 0.12), "roughness": 0.3, "specular": 0.3}


def strips(
    looks: list[dict[str, Any]], width_m: float, length_m: float, margin_m: float, **shared: Any
) -> list[Mesh | ReliefSurface]:
    """Reliefs side by side along x from the left, each with its own look, and rails of brass between them.

    Parameters
    ----------
    width_m : of each; the first and the last go on outwards by `margin_m`, which is a whole number of tiles.
    shared : what all have in common.
    """
    out: list[Mesh | ReliefSurface] = []
    left, last = -0.5 * width_m * len(looks), len(looks) - 1
    for k, look in enumerate(looks):
        low = left + k * width_m - margin_m * (k == 0)
        high = left + (k + 1) * width_m + margin_m * (k == last)
        at = (0.5 * (low + high), 0.0, 0.0)
        out.append(ReliefSurface.plane((high - low, length_m), position=at, **(shared | look)))
        if k:
            size = (0.02 * width_m, 0.02 * width_m, length_m)
            out.append(Mesh.box(size, position=(low, 0.0, 0.0), **BRASS))
    return out


def from_afar(distance_m: float, elevation_deg: float, height_m: float, aim: float = 0.0) -> Camera:
    """A camera with a long lens, so that strips are nearly parallel; the picture is `height_m` high at its target."""
    up, back = np.sin(np.radians(elevation_deg)), np.cos(np.radians(elevation_deg))
    fov = 2.0 * float(np.degrees(np.arctan(0.5 * height_m / distance_m)))
    place = (0.0, distance_m * float(up), aim + distance_m * float(back))
    return Camera(place, (0.0, 0.0, aim), fov_deg=fov)


def steps() -> Scene:
    """One pavement of setts in five strips, from its colours alone to depth with shadows."""
    ground = textures.cobbles(256, 4, tile_m=0.8, stone_m=0.13, relief_m=0.05, gap_m=0.016,
                              stone_color=(0.34, 0.31, 0.28))  # fmt: skip
    looks = [{"technique": t} for t in ("color", "normal", "offset", "relief", "best")]
    sky, sun = stage.daylight(24.0, -65.0)
    path = strips(looks, 0.4, 6.4, 0.8, solid=ReliefLayer.of(ground, roughness=0.55), tile_m=0.8)
    return Scene(from_afar(5.0, 27.0, 1.5), sky, [sun], path, exposure=1.05, tone_mapping="khronos")


def few_steps() -> Scene:
    """A pavement of bricks searched in ten equal steps: without and with the line between the last two, and ours."""
    wall = textures.bricks(256, 2, tile_m=0.45, relief_m=0.022, joint_m=0.016, wear=0.8)
    few: dict[str, Any] = {
        "search": "linear",
        "linear_steps": 10,
        "binary_steps": 0,
        "adapt_angle": False,
        "adapt_distance": False,
    }
    qualities = [ReliefQuality(**few, linear_approximation=False), ReliefQuality(**few), ReliefQuality()]
    sky, sun = stage.daylight(34.0, -55.0)
    path = strips([{"quality": q} for q in qualities], 0.45, 4.5, 0.45, solid=ReliefLayer.of(wall), tile_m=0.45)
    return Scene(from_afar(3.5, 26.0, 0.62), sky, [sun], path, exposure=0.95, tone_mapping="khronos")


def studs(size: int = 256) -> ReliefLayer:
    """Plaster with a dome and four pillars in each tile of 0.3 m."""
    x, y = (v - 0.5 for v in places(size))
    dome = np.sqrt(np.maximum(0.2**2 - x**2 - y**2, 0.0)) * 0.3 * 0.9
    pillar = np.hypot(np.abs(x) - 0.5, np.abs(y) - 0.5)
    post = 0.085 * (1.0 - ramp(pillar, 0.055, 0.07)) * (1.0 - 0.25 * ramp(pillar, 0.02, 0.055))
    ring = 0.012 * np.clip(1.0 - ((np.hypot(x, y) - 0.29) / 0.035) ** 2, 0.0, None)
    grain = 0.00025 * stage.noise((size, size), (1.5, 1.5), 4)
    colors = np.array((0.62, 0.52, 0.41)) * (1.0 + 0.04 * stage.noise((size, size), (3.0, 3.0), 5))[..., None]
    colors[np.hypot(x, y) < 0.2] *= (0.75, 0.38, 0.25)
    return ReliefLayer(dome + post + ring + grain, colors=np.clip(colors, 0.0, 1.0), roughness=0.7)


def shadows() -> Scene:
    """Domes and pillars in the light of a low lamp: without shadows, with hard ones, with soft ones."""
    qualities = [ReliefQuality(shadows=s, occlusion="none") for s in ("none", "hard", "soft")]
    lamp = DirectionalLight((0.8, -0.44, 0.25), (1.0, 0.82, 0.6), 4.0, angular_radius_deg=8.0)
    path = strips([{"quality": q} for q in qualities], 0.6, 5.4, 0.6, solid=studs(), tile_m=0.3)
    sky = Environment.sky(30.0, -90.0, 2.0, sun_disc=False)
    return Scene(from_afar(5.0, 38.0, 1.0), sky, [lamp], path, exposure=0.8, tone_mapping="khronos")


def puddles() -> Scene:
    """A street after the rain: clear water on the left, blue water on the right."""
    ground = textures.cobbles(256, 3, tile_m=1.2, stone_m=0.16, relief_m=0.06, unevenness_m=0.03,
                              stone_color=(0.40, 0.37, 0.33))  # fmt: skip
    water = textures.puddles(over=ground, coverage=0.55)
    looks: list[dict[str, Any]] = [{}, {"absorption": (45.0, 16.0, 4.0)}]
    sky, sun = stage.daylight(30.0, -40.0)
    street = strips(looks, 1.2, 36.0, 14.4, solid=ReliefLayer.of(ground, roughness=0.5),
                    translucent=ReliefLayer.of(water), tile_m=1.2,
                    quality=ReliefQuality(reflection="search", environment="map"))  # fmt: skip
    return Scene(
        Camera((0.05, 0.75, 2.2), (0.0, -0.02, 0.75), fov_deg=42.0), sky, [sun], street, exposure=0.95,
        tone_mapping="khronos",
    )  # fmt: skip


def wet_ball() -> Scene:
    """A ball laid with stones, with drops of water on it."""
    stones = textures.cobbles(256, 6, tile_m=0.1, stone_m=0.03, relief_m=0.006, gap_m=0.003, unevenness_m=0.001,
                              stone_color=(0.14, 0.34, 0.25), sand_color=(0.10, 0.08, 0.05))  # fmt: skip
    drops = textures.drops(256, 2, tile_m=0.1, coverage=0.25, volumes_ul=(60.0, 1000.0))
    over = ReliefLayer(np.asarray(stones.heights_m, np.float64) + drops.heights_m)
    middle = 0.086
    ball = ReliefSurface.sphere(
        0.08, ReliefLayer.of(stones, roughness=0.4), over, segments=96, tiles=(5.0, 2.5), position=(0.0, middle, 0.0)
    )
    # Towards the poles tiles shrink to nothing: there is metal.
    metal = [
        Mesh.torus(0.03, 0.008, 96, position=(0.0, 0.008, 0.0), **BRASS),
        Mesh.torus(0.024, 0.005, 96, position=(0.0, middle + 0.076, 0.0), **BRASS),
        Mesh.sphere(0.025, 96, position=(0.0, middle + 0.068, 0.0), **BRASS),
        Mesh.sphere(0.011, 96, position=(0.0, middle + 0.1, 0.0), **BRASS),
    ]
    return Scene(
        Camera((0.07, 0.22, 0.38), (0.0, 0.094, 0.0), fov_deg=34.0), Environment.studio(), [stage.key_light(2.5)],
        [stage.table(0.5, stage.wood(), 5.0, roughness=0.4), *metal, ball], exposure=0.8, tone_mapping="khronos",
    )  # fmt: skip


PICTURES = (
    Picture(
        "relief-steps",
        "From a painted plane to a relief",
        "Five strips of one pavement, all of them flat polygons. From left to right: colours, colours and normals, "
        "colours that are shifted, a relief whose stones cover one another, and its shadows.",
        steps,
        2,
    ),
    Picture(
        "relief-few-steps",
        "Few steps and fewer",
        "Bricks that were searched for in ten equal steps: on the left they are cut into slices, in the middle a line "
        "between the last two heights mends most of it, on the right nothing is missed.",
        few_steps,
        3,
    ),
    Picture(
        "relief-shadows",
        "Shadows on plaster",
        "The same plaster three times: without shadows, with hard ones, and with shadows that are sharp at the foot of "
        "a pillar and soft further away.",
        shadows,
        3,
    ),
    Picture(
        "relief-puddles",
        "Street after the rain",
        "Stones stand out of puddles; on the left the water is clear, on the right it is bluer the deeper it is. Both "
        "mirror the sky, most of all far away.",
        puddles,
        2,
    ),
    Picture(
        "relief-ball",
        "Drops on a ball of stones",
        "Green stones stick out of a ball, also at its outline; drops of water lie on them and mirror the lamps.",
        wet_ball,
        2,
    ),
)
