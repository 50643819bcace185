"""What the translucent layer of a relief does to light: where mirrored rays end, what they see, how much there is."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.fields import textures
from pellucid.scene import Environment, ReliefLayer, ReliefQuality, Scene

from . import stage
from .picture import Picture
from .relief import from_afar, strips
from .relief_layers import cabochon

TILE_M = 0.3


def cloudy(size: int = 128) -> Environment:
    """White clouds on a light blue sky, over ground."""
    clouds = 0.7 * stage.noise((size, 2 * size), (7.0, 20.0), 3) + 0.3 * stage.noise((size, 2 * size), (3.0, 7.0), 4)
    amount = np.clip(0.45 + 0.45 * clouds, 0.0, 1.0)[..., None]
    sky = (1.0 - amount) * np.array((0.33, 0.55, 0.95)) + amount * np.array((1.0, 1.0, 1.0))
    sky[size // 2 :] = (0.16, 0.14, 0.12)
    return Environment(np.asarray(sky, np.float32))


def half_glazed(medium: str | float = 1.62) -> dict[str, Any]:
    """Stones, some of which stand out of steep waves of clear glass."""
    stones = textures.cobbles(256, 5, tile_m=TILE_M, stone_m=0.1, relief_m=0.06, gap_m=0.04, unevenness_m=0.01,
                              stone_color=(0.55, 0.22, 0.12), sand_color=(0.30, 0.24, 0.14))  # fmt: skip
    waves = 0.004 * stage.noise((256, 256), (12.0, 12.0), 5)
    level = float(np.quantile(stones.heights_m, 0.7))
    return {"solid": ReliefLayer.of(stones, roughness=0.6), "translucent": ReliefLayer(level + waves), "medium": medium,
            "tile_m": TILE_M}  # fmt: skip


def viewed(qualities: list[ReliefQuality], **look: Any) -> Scene:
    """One strip for each way to draw half glazed stones."""
    path = strips([{"quality": q} for q in qualities], TILE_M, 10.0 * TILE_M, TILE_M, **(half_glazed() | look))
    height = 0.72 * TILE_M * len(qualities)
    return Scene(from_afar(10.0 * TILE_M, 27.0, height), cloudy(), [stage.key_light(2.0)], path, exposure=0.9,
                 tone_mapping="khronos")  # fmt: skip


def ways() -> Scene:
    """Where mirrored rays end: with the relief as a plane, and by search."""
    scene = viewed([ReliefQuality(reflection=r, environment="map", show="ways") for r in ("plane", "search")])
    return scene.replace(exposure=1.0, tone_mapping="linear")


def mirrored() -> Scene:
    """What mirrored rays see: the sky alone, the relief as a plane, the relief by search."""
    return viewed(
        [ReliefQuality(reflection=r, environment="map", show="mirrored") for r in ("environment", "plane", "search")]
    )


def planes() -> Scene:
    """All light, with planes in place of searches for mirrored and refracted rays, and by search."""
    return viewed([ReliefQuality(refraction=w, reflection=w, environment="map") for w in ("plane", "search")])


def shares() -> Scene:
    """How much waves of water and of diamond mirror, and how much they let through."""
    waves = ReliefLayer(0.003 * stage.noise((256, 256), (16.0, 16.0), 2), base_m=-0.01)
    floor = ReliefLayer(-0.05)
    quality = ReliefQuality(environment="map", show="shares")
    path = strips([{"medium": m} for m in ("water", "diamond")], TILE_M, 12.0 * TILE_M, 2.0 * TILE_M, solid=floor,
                  translucent=waves, tile_m=TILE_M, quality=quality)  # fmt: skip
    return Scene(from_afar(10.0 * TILE_M, 28.0, 1.5 * TILE_M), cloudy(), [], path, tone_mapping="linear")


def lamps() -> Scene:
    """Glass domes that mirror a lamp: its reflection alone, with all light, and ten times as bright."""
    ground = ReliefLayer(0.0002 * stage.noise((256, 256), (4.0, 4.0), 8), colors=(0.30, 0.18, 0.10), roughness=0.7)
    dome = ReliefLayer(cabochon(0.42, 0.02), roughness=0.25)
    quality = ReliefQuality(reflection="search", environment="map")
    looks: list[dict[str, Any]] = [{"quality": quality.replace(show="lamps")}, {}, {"specular_factor": 10.0}]
    path = strips(looks, 0.1, 1.2, 0.2, solid=ground, translucent=dome, medium=1.62, tile_m=0.1, quality=quality)
    return Scene(from_afar(1.0, 36.0, 0.235), cloudy(), [stage.key_light(2.0)], path, exposure=0.8,
                 tone_mapping="khronos")  # fmt: skip


PICTURES = (
    Picture(
        "relief-ways",
        "Where reflections come from",
        "Stones stand out of glass. Red glass mirrors other parts of the relief, blue glass the sky: on the left as a "
        "plane in place of the relief says, on the right as a search finds it, with all of what stands out.",
        ways,
        2,
    ),
    Picture(
        "relief-mirrored",
        "Reflections alone",
        "The same glass as a mirror. On the left it mirrors clouds and the ground around alone; in the middle also a "
        "plane with the colours of the stones; on the right every stone has its image.",
        mirrored,
        2,
    ),
    Picture(
        "relief-planes",
        "A plane in place of the relief",
        "All light. On the left refracted and mirrored rays meet planes: under the glass the colours of the stones are "
        "drawn out. On the right they meet the stones.",
        planes,
        2,
    ),
    Picture(
        "relief-shares",
        "How much is mirrored",
        "Waves of water on the left, of diamond on the right. Blue is what they let through, red what they mirror: "
        "more on the slopes that are seen at a grazing angle, and everywhere more on diamond.",
        shares,
        2,
    ),
    Picture(
        "relief-lamps",
        "A lamp in glass",
        "Domes of glass. On the left nothing but the soft bright spot of a lamp that each mirrors, in the middle the "
        "spot with all other light, on the right the same with a spot ten times as bright.",
        lamps,
        2,
    ),
)
