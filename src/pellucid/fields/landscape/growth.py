"""Trees and reeds of few triangles."""

from __future__ import annotations

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.landscape.patch import Patch, joined


def conifer(height_m: float = 6.0, seed: int = 0, whorls: int = 5, points: int = 7) -> tuple[Patch, Patch]:
    """Trunk and foliage of a spruce that stands on the origin: cones with ragged rims, one over the other.

    Parameters
    ----------
    height_m : metres > 0. seed : of random numbers. whorls : cones. points : of each rim.

    Raises
    ------
    SceneError : no height, no whorls, or fewer than three points.
    """
    if not height_m > 0.0 or whorls < 1 or points < 3:
        raise SceneError("conifer", f"cannot have {height_m} m, {whorls} whorls, {points} points", "give more")
    rng = np.random.default_rng(seed)
    lean = rng.normal(0.0, 0.012, 2)
    thick = 0.022 * height_m * rng.uniform(0.8, 1.2)
    trunk = _frustum(6, thick, 0.25 * thick, -0.05 * height_m, 0.8 * height_m)
    first = rng.uniform(0.1, 0.2) * height_m
    step = (height_m - first) / whorls
    cones = []
    for k in range(whorls):
        share = k / whorls
        radius = 0.2 * height_m * (1.0 - 0.85 * share) * rng.uniform(0.85, 1.15)
        base = first + k * step
        top = min(base + 1.9 * step, height_m)
        cones.append(_ragged_cone(points, radius, base, top if k < whorls - 1 else height_m, rng))
    parts = [trunk, joined(cones)]
    bent = [part.vertices + part.vertices[:, 1:2] * np.array([lean[0], 0.0, lean[1]]) for part in parts]
    return Patch(bent[0], trunk.faces), Patch(bent[1], parts[1].faces)


def reeds(count: int = 60, height_m: float = 1.2, spread_m: float = 0.6, seed: int = 0) -> Patch:
    """A clump of blades about the origin, each two triangles that bend outwards; seen from both sides.

    Parameters
    ----------
    count : of blades >= 1. height_m : of the highest. spread_m : radius of the clump, metres.
    """
    if count < 1:
        raise SceneError("count", f"is {count}", "use 1 or more")
    rng = np.random.default_rng(seed)
    away = spread_m * np.sqrt(rng.random(count))
    turn, facing = rng.uniform(0.0, 2.0 * np.pi, (2, count))
    foot = np.stack([away * np.cos(turn), np.zeros(count), away * np.sin(turn)], axis=1)
    high = height_m * rng.uniform(0.5, 1.0, count)
    half = 0.012 * height_m * rng.uniform(0.6, 1.2, count)
    wide = half[:, None] * np.stack([np.cos(facing), np.zeros(count), np.sin(facing)], axis=1)
    bend = rng.normal(0.0, 0.16, (count, 2)) * high[:, None] + 0.15 * foot[:, [0, 2]]
    middle = foot + np.stack([0.3 * bend[:, 0], 0.6 * high, 0.3 * bend[:, 1]], axis=1)
    tip = foot + np.stack([bend[:, 0], high, bend[:, 1]], axis=1)
    vertices = np.stack([foot - wide, foot + wide, middle + 0.8 * wide, middle - 0.8 * wide, tip], axis=1)
    blade = np.array([(0, 1, 2), (0, 2, 3), (3, 2, 4)])
    faces = (5 * np.arange(count)[:, None, None] + blade).reshape(-1, 3)
    return Patch(vertices.reshape(-1, 3), faces.astype(np.int32))


def _ring(count: int, radius: np.ndarray | float, y: np.ndarray | float, turn: float = 0.0) -> np.ndarray:
    """(count, 3) points of a circle about y, counter-clockwise seen from above."""
    angle = -2.0 * np.pi * np.arange(count) / count + turn
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), y, radius * np.sin(angle)), axis=-1)


def _frustum(sides: int, low: float, high: float, base: float, top: float) -> Patch:
    """The wall of a cone without its tip."""
    k = np.arange(sides)
    after = (k + 1) % sides
    faces = np.concatenate([np.stack([k, after, after + sides], 1), np.stack([k, after + sides, k + sides], 1)])
    return Patch(np.concatenate([_ring(sides, low, base), _ring(sides, high, top)]), faces.astype(np.int32))


def _ragged_cone(points: int, radius: float, base: float, top: float, rng: np.random.Generator) -> Patch:
    """A cone whose rim has long points that hang and short hollows, and a lower side that goes up to the trunk."""
    count = 2 * points
    long = np.arange(count) % 2 == 0
    reach = radius * np.where(long, 1.0, 0.62) * rng.uniform(0.85, 1.1, count)
    droop = (top - base) * np.where(long, -0.06, 0.1) + 0.03 * (top - base) * rng.normal(size=count)
    rim = _ring(count, reach, base + droop, rng.uniform(0.0, 6.3))
    vertices = np.concatenate([rim, [[0.0, top, 0.0]], [[0.0, base + 0.3 * (top - base), 0.0]]])
    k = np.arange(count)
    after = (k + 1) % count
    outer = np.stack([k, after, np.full(count, count)], 1)
    inner = np.stack([after, k, np.full(count, count + 1)], 1)
    return Patch(vertices, np.concatenate([outer, inner]).astype(np.int32))
