"""Exact intersections of rays with a surface of waves, in float64: what the search of the shaders is held to."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def meet_surface(
    origins: ArrayLike,
    directions: ArrayLike,
    heights: ArrayLike,
    tile_m: tuple[float, float],
    repeats: bool = True,
    t_max: float = 1e3,
) -> Array:
    """Way of rays to their first crossing of a surface, from either side; infinite where there is none.

    The surface is linear along x and z between the centres of texels, so that along a ray, within a cell, its distance
    is a polynomial of degree two, whose roots are the crossings.

    Parameters
    ----------
    origins, directions : (N, 3) metres over the level and about the centre of the tile; unit.
    heights : (H, W) metres, columns along x, rows along z.
    tile_m : size along x and z.
    repeats : the tile does; else the surface goes on as it ends.
    t_max : rays end here, metres.

    Returns
    -------
    (N,) metres.
    """
    h = np.asarray(heights, np.float64)
    pairs = zip(np.asarray(origins, np.float64), np.asarray(directions, np.float64), strict=True)
    return np.array([_first(origin, way, h, tile_m, repeats, t_max) for origin, way in pairs])


def surface_height(xz: ArrayLike, heights: ArrayLike, tile_m: tuple[float, float], repeats: bool = True) -> Array:
    """(...) heights in metres at (..., 2) places."""
    h = np.asarray(heights, np.float64)
    at = _texels(np.asarray(xz, np.float64), h, tile_m)
    first = np.floor(at)
    a, b, c, d = _corners(first, h, repeats)
    u, v = np.moveaxis(at - first, -1, 0)
    return np.asarray((a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v)


def _first(origin: Array, way: Array, h: Array, tile_m: tuple[float, float], repeats: bool, t_max: float) -> float:
    at, per_m = _texels(origin[[0, 2]], h, tile_m), way[[0, 2]] * (h.shape[1], h.shape[0]) / tile_m
    t = _lines(at, per_m, _slab(origin[1], way[1], h, t_max))
    if len(t) < 2:
        return np.inf
    cell = np.floor(at + 0.5 * (t[:-1] + t[1:])[:, None] * per_m)
    a, b, c, d = _corners(cell, h, repeats)
    u, v = np.moveaxis(at + t[:-1, None] * per_m - cell, -1, 0)
    du, dv = per_m
    twist = a - b - c + d
    # gap(s) = p + q s + r s^2 after the cell is entered
    p = origin[1] + t[:-1] * way[1] - (a + (b - a) * u + (c - a) * v + twist * u * v)
    q = way[1] - ((b - a) * du + (c - a) * dv + twist * (u * dv + v * du))
    r = np.full_like(p, -du * dv) * twist
    s = _least_root(p, q, r, np.diff(t))
    found = np.flatnonzero(np.isfinite(s))
    return float(t[found[0]] + s[found[0]]) if len(found) else np.inf


def _lines(at: Array, per_m: Array, span: tuple[float, float]) -> Array:
    """Ways at which a ray enters cells, from the first to the last of a span."""
    low, high = span
    if not low < high:
        return np.empty(0)
    cuts = [np.array(span)]
    for place, speed in zip(at, per_m, strict=True):
        if speed != 0.0:
            ends = np.sort(place + np.array(span) * speed)
            cuts.append((np.arange(np.ceil(ends[0]), np.floor(ends[1]) + 1.0) - place) / speed)
    return np.unique(np.clip(np.concatenate(cuts), low, high))


def _slab(y: float, dy: float, h: Array, t_max: float) -> tuple[float, float]:
    margin = 1e-6 + 1e-6 * float(np.abs(h).max())
    if dy == 0.0:
        return (0.0, t_max) if h.min() - margin <= y <= h.max() + margin else (0.0, 0.0)
    ends = sorted(((h.min() - margin - y) / dy, (h.max() + margin - y) / dy))
    return max(ends[0], 0.0), min(ends[1], t_max)


def _least_root(p: Array, q: Array, r: Array, length: Array) -> Array:
    """Least root of p + q s + r s^2 in [0, length], infinite where there is none."""
    root = np.sqrt(np.maximum(q * q - 4.0 * p * r, 0.0))
    k = -0.5 * (q + np.where(q < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([k / r, p / k])
    real = (q * q - 4.0 * p * r >= 0.0) & np.isfinite(both) & (both >= 0.0) & (both <= length)
    return np.asarray(np.where(real, both, np.inf).min(axis=0))


def _texels(xz: Array, h: Array, tile_m: tuple[float, float]) -> Array:
    """Places in texels, whole at their centres."""
    size = np.array([h.shape[1], h.shape[0]], np.float64)
    return np.asarray((xz / tile_m + 0.5) * size - 0.5)


def _corners(cell: Array, h: Array, repeats: bool) -> tuple[Array, Array, Array, Array]:
    rows, columns = h.shape
    i, j = (cell[..., axis].astype(int) for axis in (0, 1))
    near, far = (
        (k % n if repeats else np.clip(k, 0, n - 1) for k, n in ((i + step, columns), (j + step, rows)))
        for step in (0, 1)
    )
    (i0, j0), (i1, j1) = near, far
    return h[j0, i0], h[j0, i1], h[j1, i0], h[j1, i1]
