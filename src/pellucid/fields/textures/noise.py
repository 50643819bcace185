"""Noise and cells that repeat: gradient noise on a lattice, sums of octaves, Voronoi cells about scattered points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .maps import Values


def gradient_noise(u: Values, v: Values, cells: tuple[int, int], rng: np.random.Generator) -> Values:
    """Noise of [perlin2002], of period 1 in u and v, about -1 to 1 with mean near 0.

    Parameters
    ----------
    u, v : places, of any equal shape. cells : lattice cells along u and v in one period.
    rng : gives one direction for each lattice point; so the noise does not depend on how finely it is sampled.
    """
    across, along = cells
    angle = rng.uniform(0.0, 2.0 * np.pi, (along, across))
    gx, gy = np.cos(angle), np.sin(angle)
    x, y = u * across, v * along
    i, j = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    fx, fy = x - i, y - j
    sx, sy = (t * t * t * (t * (6.0 * t - 15.0) + 10.0) for t in (fx, fy))

    def corner(di: int, dj: int) -> Values:
        at = (j + dj) % along, (i + di) % across
        return gx[at] * (fx - di) + gy[at] * (fy - dj)

    low = corner(0, 0) + sx * (corner(1, 0) - corner(0, 0))
    high = corner(0, 1) + sx * (corner(1, 1) - corner(0, 1))
    return np.sqrt(2.0) * (low + sy * (high - low))


def octaves(
    u: Values, v: Values, cells: int | tuple[int, int], rng: np.random.Generator, count: int = 4, gain: float = 0.5
) -> Values:
    """Sum of `count` noises, each twice as fine and `gain` times as strong; about -1 to 1 [musgrave1989]."""
    across, along = (cells, cells) if isinstance(cells, int) else cells
    total, strength, sum_of_strengths = np.zeros(np.shape(u)), 1.0, 0.0
    for k in range(count):
        total += strength * gradient_noise(u, v, (across << k, along << k), rng)
        sum_of_strengths += strength
        strength *= gain
    return total / sum_of_strengths


@dataclass(frozen=True)
class Cells:
    """Voronoi cells at some places.

    Parameters
    ----------
    owner : (...) number of the nearest point.
    edge : (...) distance to the boundary of the cell; corners are rounded.
    offset_u, offset_v : (...) place minus the nearest point.
    """

    owner: np.ndarray
    edge: Values
    offset_u: Values
    offset_v: Values


def voronoi(u: Values, v: Values, points: Values, rounding: float = 0.0, neighbours: int = 9) -> Cells:
    """Cells about points that repeat with period 1; distances to edges are exact where `rounding` is 0.

    The boundary between two cells is the bisector of their points, and the distance to it
    (|p - b|^2 - |p - a|^2) / (2 |b - a|) [quilez2012].

    Parameters
    ----------
    points : (N, 2), each 0 to 1.
    rounding : distances to several boundaries are merged over this length by a smooth minimum.
    neighbours : points that are asked for their bisector.
    """
    from scipy.spatial import cKDTree

    shifts = [(a, b) for b in (-1, 0, 1) for a in (-1, 0, 1)]
    around = np.concatenate([points + shift for shift in shifts])
    where = np.stack([np.mod(u, 1.0), np.mod(v, 1.0)], axis=-1)
    distance, index = cKDTree(around).query(where, k=min(neighbours, len(around)))
    nearest = around[index[..., 0]]
    apart = np.linalg.norm(around[index[..., 1:]] - nearest[..., None, :], axis=-1)
    to_edges = (distance[..., 1:] ** 2 - distance[..., :1] ** 2) / (2.0 * np.maximum(apart, 1e-12))
    edge = to_edges.min(axis=-1)
    if rounding > 0.0:
        edge = edge - rounding * np.log(np.exp((edge[..., None] - to_edges) / rounding).sum(axis=-1))
    offset = where - nearest
    return Cells(index[..., 0] % len(points), edge, offset[..., 0], offset[..., 1])


def scattered(count: int, rng: np.random.Generator, tries: int = 12) -> Values:
    """(count, 2) points in the unit square, evenly but irregularly spread: best of some candidates [mitchell1991]."""
    points = rng.random((1, 2))
    while len(points) < count:
        candidates = rng.random((tries, 2))
        apart = np.abs(candidates[:, None] - points[None])
        apart = np.minimum(apart, 1.0 - apart)
        clear = (apart**2).sum(axis=-1).min(axis=1)
        points = np.concatenate([points, candidates[[int(clear.argmax())]]])
    return points
