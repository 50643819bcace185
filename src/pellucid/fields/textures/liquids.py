"""Water that lies: sessile drops and puddles. Where there is none, heights are below the surface that carries it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.numbers import number
from pellucid.fields.sessile import PLUNGE, check_angle, meniscus, merge, rims_of

from .maps import Maps, color, grid, places
from .noise import octaves

#: Texels outside of a rim over which the surface goes on at the contact angle.
APRON = 2.5


def drops(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.05,
    coverage: float = 0.3,
    volumes_ul: tuple[float, float] = (0.2, 40.0),
    contact_angle_deg: float = 60.0,
    below_m: float = 0.005,
    tint: Sequence[float] = (1.0, 1.0, 1.0),
) -> Maps:
    """Drops of water on a plane at height 0, some of which have run together.

    Between the drops the surface dips under the plane, at first at the contact angle, then steeply, to `-below_m`: as
    the translucent layer of a relief it holds matter in the drops only, also over a solid layer that has joints.

    Parameters
    ----------
    size, seed, tile_m : texels along an edge, of random numbers, edge of the tile in metres.
    coverage : share of the plane that is wet, 0 to 0.8.
    volumes_ul : smallest and largest drop, microlitres (cubic millimetres), before any merge.
    contact_angle_deg : between plane and water at the rim, 5 to 85 degrees.
    below_m : depth of the map where there is no water, metres.
    tint : colour of the map.

    Raises
    ------
    SceneError
        A parameter is out of its range, or no drop is large enough to show on so few texels.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    coverage = number("coverage", coverage, low=0.0, high=0.8)
    angle = check_angle("contact_angle_deg", contact_angle_deg)
    below_m = number("below_m", below_m, low=1e-6, unit="metres")
    small, large = (number("volumes_ul", v, low=1e-6, unit="microlitres") * 1e-9 for v in _pair(volumes_ul))
    tinted = color("tint", tint)
    if small > large:
        raise SceneError("volumes_ul", f"is {volumes_ul}", "give the smaller volume first")
    rims = rims_of([small, large], angle)
    if rims[1] < 2.0 * tile_m / size:
        raise SceneError(
            "volumes_ul", "are less than two texels wide", "use larger drops, more texels or a smaller tile"
        )
    if rims[1] > 0.25 * tile_m:
        raise SceneError("volumes_ul", "are wider than half of the tile", "use smaller drops or a larger tile")
    within = np.full((size, size), -tile_m)
    rim = np.full((size, size), float(rims[0]))
    u, v = places(size)
    attempts, progress = 0, 0.0 if coverage > 0.0 else 1.0
    while progress < 1.0 and attempts < 6000:
        # Volumes spread evenly over their logarithm, large ones first: many small ones lie between.
        share = rng.random() * (1.0 - progress) ** 0.35
        radius = float(np.exp(np.log(rims[0]) + share * np.log(rims[1] / rims[0])))
        x, y = rng.random(2)
        attempts += 1
        here = within[min(int((1.0 - y) * size), size - 1), min(int(x * size), size - 1)]
        # What touches merges: a drop is put where it is dry; some touch their neighbours, more as it gets full.
        touches = rng.random() < 0.12 + attempts / 4000
        if here > -radius * (0.75 if touches else 1.08) - 0.5 * tile_m / size:
            continue
        for n, (dx, dy, part) in enumerate(_lobes(radius, rng)):
            du = u - x - dx / tile_m
            dv = v - y - dy / tile_m
            merge(within, rim, np.hypot(du - np.round(du), dv - np.round(dv)) * tile_m, part, 1.8 if n else 0.6)
        progress = np.count_nonzero(within > 0.0) / (coverage * size * size)
    heights = np.maximum(meniscus(within, rim, angle, APRON * tile_m / size), -below_m)
    return Maps.of(heights, tinted, tile_m)


def puddles(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.8,
    over: Maps | None = None,
    coverage: float = 0.4,
    depth_m: float = 0.003,
    contact_angle_deg: float = 30.0,
    below_m: float = 0.005,
    tint: Sequence[float] = (1.0, 1.0, 1.0),
) -> Maps:
    """Puddles: water that stands level.

    Over a ground with relief the level is where `coverage` of the ground is under water. Without one they lie on a
    plane at height 0, `depth_m` high, with rounded rims, and the map dips under the plane elsewhere, as in `drops`.

    Parameters
    ----------
    size, seed, tile_m : as in `drops`; with `over` size and tile are those of the ground.
    over : maps of the ground, such as `cobbles`.
    coverage : share of the ground under water, 0 to 1.
    depth_m : height of water on a plane, metres.
    contact_angle_deg : at rims on a plane, 5 to 85 degrees.
    below_m : depth of the map on a plane where there is no water, metres.
    tint : colour of the map.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    coverage = number("coverage", coverage, low=0.0, high=1.0)
    depth_m = number("depth_m", depth_m, low=1e-6, unit="metres")
    angle = check_angle("contact_angle_deg", contact_angle_deg)
    below_m = number("below_m", below_m, low=1e-6, unit="metres")
    tinted = color("tint", tint)
    if over is not None:
        if not isinstance(over, Maps):
            raise SceneError("over", f"is a {type(over).__name__}", "give the maps of the ground")
        level = float(np.quantile(over.heights_m, coverage))
        return Maps.of(np.full(over.heights_m.shape, level), tinted, over.tile_m)
    u, v = places(size)
    hollow = octaves(u, v, 4, rng, 3, 0.3)
    hollow = hollow - np.quantile(hollow, 1.0 - coverage)
    # Distance to the shore, to first order: the value over the length of its gradient.
    texel = tile_m / size
    slope = np.hypot(*(np.roll(hollow, -1, axis=a) - np.roll(hollow, 1, axis=a) for a in (0, 1))) / (2.0 * texel)
    shore = hollow / np.sqrt(slope**2 + float(np.mean(slope)) ** 2 * 0.05)
    steep = np.tan(angle)
    outside = shore * steep + PLUNGE * np.minimum(shore + APRON * texel, 0.0)
    heights = np.where(shore > 0.0, depth_m * (1.0 - np.exp(-np.maximum(shore, 0.0) * steep / depth_m)), outside)
    return Maps.of(np.maximum(heights, -below_m), tinted, tile_m)


def _pair(values: Any) -> tuple[Any, Any]:
    try:
        low, high = values
    except (TypeError, ValueError):
        raise SceneError("volumes_ul", f"is {values!r}", "give the smallest and the largest volume") from None
    return low, high


def _lobes(radius: float, rng: np.random.Generator) -> list[tuple[float, float, float]]:
    """(x, y, radius) of the parts of a drop: pinned rims make large ones uneven."""
    lobes = [(0.0, 0.0, radius)]
    if radius > 0.0015:
        for _ in range(int(rng.integers(0, 4))):
            turn, part = rng.uniform(0.0, 2.0 * np.pi), radius * rng.uniform(0.6, 0.85)
            reach = radius * rng.uniform(0.25, 0.6)
            lobes.append((reach * np.cos(turn), reach * np.sin(turn), part))
    return lobes
