"""Reliefs under glass and water: what the translucent layer does to light, a pool, a watch."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.fields import Ripples, shapes, textures
from pellucid.fields.textures.maps import places, ramp
from pellucid.scene import Camera, DirectionalLight, Environment, Mesh, ReliefLayer, ReliefQuality, ReliefSurface, Scene

from . import stage
from .picture import Picture
from .relief import from_afar, strips

BLUE = (42.0, 15.0, 1.5)
DARKER_BLUE = (140.0, 50.0, 5.0)


def rosette(size: int = 256) -> ReliefLayer:
    """A carved flower with eight petals in each tile of 0.1 m, gilt on dark ground."""
    x, y = (v - 0.5 for v in places(size))
    r, turn = np.hypot(x, y), np.arctan2(y, x)
    edge = 0.33 * (0.80 + 0.20 * np.cos(8.0 * turn))
    petals = (1.0 - ramp(r / edge, 0.86, 1.0)) * (0.55 + 0.45 * np.cos(4.0 * turn) ** 2) * ramp(r, 0.05, 0.2)
    bud = np.sqrt(np.maximum(1.0 - (r / 0.08) ** 2, 0.0))
    frame = 1.0 - ramp(np.abs(np.maximum(np.abs(x), np.abs(y)) - 0.46), 0.02, 0.035)
    heights = 0.006 * np.maximum(np.maximum(petals, bud), frame)
    gilt = np.clip(heights / 0.003, 0.0, 1.0)[..., None]
    colors = gilt * np.array((0.75, 0.50, 0.16)) + (1.0 - gilt) * np.array((0.16, 0.17, 0.20))
    return ReliefLayer(heights, colors=colors, roughness=0.4)


def cabochon(radius: float, top_m: float, size: int = 256) -> np.ndarray:
    """A dome in the middle of a tile, metres; far below the polygon outside of its rim.

    Parameters
    ----------
    radius : in tiles. top_m : its highest point.
    """
    x, y = (v - 0.5 for v in places(size))
    q = 1.0 - (x**2 + y**2) / radius**2
    return np.asarray(np.where(q > 0.0, top_m * np.sqrt(np.maximum(q, 0.0)), np.maximum(top_m * 8.0 * q, -0.02)))


def layers() -> Scene:
    """Glass domes over carved flowers: what lies where, clear glass, blue glass, more blue."""
    solid, dome = rosette(), cabochon(0.38, 0.026)
    covered = (dome > solid.heights)[..., None]
    painted = ReliefLayer(
        np.maximum(solid.heights, dome), colors=np.where(covered, (0.42, 0.02, 0.015), (0.02, 0.045, 0.32))
    )
    glass = ReliefLayer(dome)
    looks: list[dict[str, Any]] = [{"solid": painted, "translucent": None}, {}, {"absorption": BLUE},
                                   {"absorption": DARKER_BLUE}]  # fmt: skip
    path = strips(looks, 0.1, 1.0, 0.1, solid=solid, translucent=glass, medium=1.62, tile_m=0.1,
                  quality=ReliefQuality(reflection="search", environment="map"))  # fmt: skip
    return Scene(from_afar(1.0, 36.0, 0.29), Environment.studio(), [stage.key_light(2.0)], path, exposure=0.9,
                 tone_mapping="khronos")  # fmt: skip


def mirrors() -> Scene:
    """Stones in still water that mirrors the sky alone, then the stones too: as if they were flat, and as they are."""
    ground = textures.cobbles(256, 11, tile_m=1.2, stone_m=0.3, relief_m=0.2, gap_m=0.14, unevenness_m=0.03,
                              stone_color=(0.42, 0.33, 0.26))  # fmt: skip
    level = float(np.quantile(ground.heights_m, 0.72))
    qualities = [ReliefQuality(reflection=r, environment="map") for r in ("environment", "search")]
    sky, sun = stage.daylight(24.0, 50.0)
    path = strips([{"quality": q} for q in qualities], 1.2, 12.0, 2.4, solid=ReliefLayer.of(ground, roughness=0.6),
                  translucent=ReliefLayer(level), tile_m=1.2)  # fmt: skip
    return Scene(from_afar(6.0, 17.0, 1.3), sky, [sun], path, exposure=1.5, tone_mapping="khronos")


def fresnel() -> Scene:
    """Waves of water and of diamond: what they mirror alone, over black, and with what is seen through them."""
    waves = 0.0013 * stage.noise((256, 256), (16.0, 16.0), 2)
    floor = textures.tiles(256, 1, tile_m=0.3, edge_m=0.072, relief_m=0.003, glaze_color=(0.55, 0.18, 0.05))
    black = ReliefLayer(floor.heights_m, base_m=-0.02, colors=(0.0, 0.0, 0.0), specular=0.0)
    solid = ReliefLayer.of(floor, base_m=-0.02, roughness=0.3)
    looks: list[dict[str, Any]] = [{"solid": s, "medium": m} for m in ("water", "diamond") for s in (black, solid)]
    path = strips(looks, 0.3, 3.6, 0.6, translucent=ReliefLayer(waves), tile_m=0.3,
                  quality=ReliefQuality(environment="map"))  # fmt: skip
    sky, sun = stage.daylight(34.0, 10.0)
    return Scene(from_afar(3.0, 27.0, 0.9), sky, [sun], path, exposure=0.8, tone_mapping="khronos")


def occlusion() -> Scene:
    """Domes of glass on plaster: they take light from the ground, or do not; clear and blue."""
    plaster = np.array((0.66, 0.62, 0.55)) * (1.0 + 0.03 * stage.noise((256, 256), (4.0, 4.0), 3))[..., None]
    ground = ReliefLayer(
        0.0001 * stage.noise((256, 256), (3.0, 3.0), 8), colors=np.clip(plaster, 0.0, 1.0), roughness=0.8
    )
    dome = ReliefLayer(cabochon(0.3, 0.03))
    looks: list[dict[str, Any]] = [
        {"absorption": a, "quality": ReliefQuality(occlusion=o, environment="map")}
        for a in ((0.0, 0.0, 0.0), BLUE) for o in ("none", "texture")
    ]  # fmt: skip
    lamp = DirectionalLight((0.75, -0.55, -0.2), (1.0, 0.94, 0.85), 4.0, angular_radius_deg=0.5)
    path = strips(looks, 0.1, 1.0, 0.1, solid=ground, translucent=dome, medium=1.5, tile_m=0.1)
    return Scene(from_afar(1.0, 40.0, 0.335), Environment.studio(intensity=0.5), [lamp], path, exposure=0.8,
                 tone_mapping="khronos")  # fmt: skip


def pool() -> Scene:
    """A pool of tiles with ripples, whose water gathers the sun on the floor."""
    size, side = 512, 2.4
    u, v = places(size)
    inward = side * (0.5 - np.maximum(np.abs(u - 0.5), np.abs(v - 0.5)))
    tile = textures.tiles(128, 3, tile_m=0.3, edge_m=0.072, relief_m=0.0015, glaze_color=(0.30, 0.55, 0.60))
    rim = textures.cobbles(128, 1, tile_m=0.6, stone_m=0.1, relief_m=0.006, gap_m=0.008, stone_color=(0.5, 0.47, 0.43))
    depth = 0.34 * ramp(inward, 0.24, 0.27) * 0.5 + 0.34 * 0.5 * ramp(inward, 0.55, 0.57)
    basin = ramp(inward, 0.235, 0.245)
    heights = -depth + np.tile(tile.heights_m, (8, 8))[::2, ::2] * basin
    colors = basin[..., None] * np.tile(tile.colors, (8, 8, 1))[::2, ::2]
    stone = 0.92 * np.tile(rim.colors, (4, 4, 1))
    colors = colors + (1.0 - basin[..., None]) * stone
    heights = heights + (1.0 - basin) * np.tile(rim.heights_m, (4, 4))
    water = Ripples((256, 256), side / 256, speed_m_s=0.5, damping=0.2)
    for x, z, at in ((-0.35, 0.3, 0.0), (0.5, -0.2, 0.5), (0.1, 0.6, 0.9), (-0.6, -0.6, 0.2), (0.2, -0.7, 0.7)):
        water.drop(x, z, 0.06, 0.045, at)
    level = ReliefLayer(np.clip(-0.06 + 0.8 * water.advance(1.6), -0.2, -0.02))
    sky, sun = stage.daylight(48.0, -35.0)
    basin_of_tiles = ReliefSurface.plane(
        side, ReliefLayer(heights, colors=np.clip(colors, 0.0, 1.0), roughness=0.5), level, tiling=False,
        absorption=(1.6, 0.35, 0.2), quality=ReliefQuality(reflection="search", caustics=True, environment="map"),
    )  # fmt: skip
    return Scene(
        Camera((0.2, 1.75, 1.6), (0.0, -0.2, 0.07), fov_deg=34.0), sky, [sun], [basin_of_tiles], exposure=0.75,
        tone_mapping="khronos",
    )  # fmt: skip


def disc(radius_m: float, segments: int = 96, **look: Any) -> Mesh:
    """A round plate in y = 0 whose map is that of the square around it."""
    turn = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    ring = np.stack([np.cos(turn), np.zeros(segments), -np.sin(turn)], axis=1)
    places_m = radius_m * np.concatenate([np.zeros((1, 3)), ring])
    k = np.arange(segments)
    faces = np.stack([np.zeros(segments, int), 1 + k, 1 + (k + 1) % segments], axis=1)
    uvs = 0.5 + 0.5 * np.stack([places_m[:, 0], -places_m[:, 2]], axis=1) / radius_m
    return Mesh(places_m, faces, np.tile((0.0, 1.0, 0.0), (segments + 1, 1)), uvs, **look)


def dial(size: int, radius_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights (N, N) in metres and colours (N, N, 3) of a watch: numerals, minutes, three hands."""
    u, v = places(size)
    x, y = (2.0 * u - 1.0) * radius_m, (2.0 * v - 1.0) * radius_m
    r, turn = np.hypot(x, y), np.arctan2(x, y)
    texel = 2.0 * radius_m / size
    guilloche = np.cos(16.0 * turn + 22.0 * r / radius_m) * np.cos(16.0 * turn - 22.0 * r / radius_m)
    heights = (
        5e-5 * guilloche * ramp(r, 0.1 * radius_m, 0.3 * radius_m) * (1.0 - ramp(r, 0.56 * radius_m, 0.58 * radius_m))
    )
    colors = np.broadcast_to(np.array((0.018, 0.045, 0.11)), (size, size, 3)).copy()

    def raise_(sdf: np.ndarray, height_m: float, color: tuple[float, float, float]) -> None:
        nonlocal heights, colors
        cover = ramp(-sdf, -texel, texel)
        heights = np.maximum(heights, height_m * ramp(-sdf, -texel, 2.0 * texel) - 1e-4)
        colors = colors + cover[..., None] * (np.array(color) - colors)

    gold, white, red = (0.80, 0.56, 0.22), (0.82, 0.82, 0.78), (0.6, 0.04, 0.02)
    for minute in range(60):
        a = np.radians(6.0 * minute)
        along, across = x * np.sin(a) + y * np.cos(a), x * np.cos(a) - y * np.sin(a)
        big = minute % 5 == 0
        half = (0.07, 0.022) if big else (0.03, 0.008)
        sdf = np.maximum(
            np.abs(along - (0.93 - half[0]) * radius_m) - half[0] * radius_m, np.abs(across) - half[1] * radius_m
        )
        raise_(sdf, 5e-4 if big else 2e-4, gold if big else white)
    for hour in (12, 3, 6, 9):
        a = np.radians(30.0 * hour)
        word = shapes.lettering(str(hour), 0.24 * radius_m, 1.0, 0.045 * radius_m)
        cx, cy = 0.64 * radius_m * np.sin(a), 0.64 * radius_m * np.cos(a)
        raise_(np.asarray(word(x - cx, y - cy, np.zeros_like(x))), 5e-4, gold)
    for angle, reach, wide, top, color in ((305.0, 0.5, 0.035, 9e-4, white), (54.0, 0.78, 0.026, 1.2e-3, white),
                                           (222.0, 0.86, 0.009, 1.5e-3, red)):  # fmt: skip
        a = np.radians(angle)
        along, across = x * np.sin(a) + y * np.cos(a), x * np.cos(a) - y * np.sin(a)
        taper = wide * radius_m * (1.15 - 0.75 * np.clip(along / (reach * radius_m), 0.0, 1.0))
        sdf = np.maximum(np.abs(along - 0.42 * reach * radius_m) - 0.58 * reach * radius_m, np.abs(across) - taper)
        raise_(sdf, top, color)
    raise_(r - 0.05 * radius_m, 1.7e-3, gold)
    return heights, np.clip(colors, 0.0, 1.0)


def watch() -> Scene:
    """The dial of a watch under a domed glass, in a case of gold."""
    radius = 0.018
    heights, colors = dial(768, radius)
    x, y = ((2.0 * c - 1.0) for c in places(768))
    glass = ReliefLayer(0.0003 + 0.0048 * np.sqrt(np.maximum(1.0 - 0.9 * (x**2 + y**2), 0.01)))
    face = ReliefSurface(
        disc(radius), ReliefLayer(heights, colors=colors, roughness=0.28, specular=0.25), glass,
        medium="soda-lime glass",
        tiling=False, position=(0.0, 0.004, 0.0)
    )  # fmt: skip
    gold: dict[str, Any] = {"base_color": (0.62, 0.42, 0.16), "roughness": 0.22, "specular": 0.5}
    case = [Mesh.torus(radius + 0.0016, 0.0024, 128, position=(0.0, 0.0055, 0.0), **gold),
            Mesh.torus(radius + 0.002, 0.003, 128, position=(0.0, 0.003, 0.0), **gold),
            Mesh.box((0.004, 0.004, 0.005), position=(radius + 0.006, 0.004, 0.0), **gold)]  # fmt: skip
    strap = [Mesh.box((0.02, 0.003, 0.06), position=(0.0, 0.002, s * (radius + 0.03)), base_color=(0.06, 0.03, 0.02),
                      roughness=0.5) for s in (-1.0, 1.0)]  # fmt: skip
    return Scene(
        Camera((0.022, 0.066, 0.05), (0.0, 0.003, 0.001), fov_deg=35.0, near_m=0.002),
        Environment.studio(), [stage.key_light(2.0)],
        [stage.table(0.4, stage.wood(), 2.0, roughness=0.4), *strap, *case, face], exposure=0.9, tone_mapping="khronos",
    )  # fmt: skip


PICTURES = (
    Picture(
        "relief-layers",
        "Flowers under glass",
        "On the left the two layers in red and blue; then domes of clear glass, which enlarge the gilt flowers under "
        "them, of bluish glass, and of bluer glass.",
        layers,
        2,
    ),
    Picture(
        "relief-mirrors",
        "Stones in still water",
        "On the left the water mirrors the sky alone; on the right every stone stands over its own image.",
        mirrors,
        1,
    ),
    Picture(
        "relief-fresnel",
        "Waves of water and of diamond",
        "Two strips of water, then two of diamond: what they mirror over black, and with tiles under them. Water "
        "mirrors little except far away; diamond mirrors everywhere, and sparkles in the sun.",
        fresnel,
        1,
    ),
    Picture(
        "relief-occlusion",
        "Glass that takes light away",
        "Two columns of clear domes and two of blue ones. In the second of each they throw shadows: those of "
        "clear glass have a dark border, those of blue glass are blue.",
        occlusion,
        2,
    ),
    Picture(
        "relief-pool",
        "Pool in the sun",
        "Rings run over the water of a tiled pool, and bright lines over its floor, where they gather the sun; walls "
        "throw shadows.",
        pool,
        3,
    ),
    Picture(
        "relief-watch",
        "Watch under glass",
        "Gilt numerals and hands stand out of a blue dial under a domed glass; lamps are mirrored in the glass.",
        watch,
        2,
    ),
)
