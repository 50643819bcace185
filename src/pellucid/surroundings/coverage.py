"""How much surface each texel of an atlas stands for: the integral of its tent over the triangles, exactly.

A texel's tent is bilinear, 1 at its centre and 0 at its neighbours' centres; at the rim of a chart it goes on level, so
that the tents of a chart sum to 1 everywhere in it. By Green's theorem the integral of f(x, y) = X'(x) Y(y) over a
triangle is that of X Y dy around it. Between two lines of texel centres this is a cubic along an edge, which two points
of Gauss integrate exactly; to the left of an edge X is 1, so one running sum along each row completes it.
"""

from __future__ import annotations

import numpy as np

GAUSS = 0.5 - 0.5 / np.sqrt(3.0)


def covered_area(
    corners: np.ndarray, area_m2: np.ndarray, low: np.ndarray, high: np.ndarray, size: tuple[int, int]
) -> np.ndarray:
    """Area (H, W) in square metres under the tent of each texel.

    Parameters
    ----------
    corners : (F, 3, 2) corners of the triangles in texels of the atlas; parts outside the chart are cut off.
    area_m2 : (F,) area of each triangle on its surface, in full.
    low, high : (F, 2) whole texels, bounds of the chart that each triangle is on.
    size : (width, height) of the atlas.
    """
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    signed = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    scale = area_m2 / np.where(signed == 0, np.inf, signed)
    start, end = corners.reshape(-1, 2), np.roll(corners, -1, axis=1).reshape(-1, 2)
    low, high, scale = np.repeat(low, 3, axis=0), np.repeat(high, 3, axis=0), np.repeat(scale, 3)
    edge, t0, t1 = _pieces(start, end, low, high)
    step = end - start
    out = np.zeros(size[1] * (size[0] + 1))
    middle = start[edge] + (0.5 * (t0 + t1))[:, None] * step[edge]
    kept = (middle[:, 1] > low[edge, 1]) & (middle[:, 1] < high[edge, 1])
    edge, t0, t1, middle = edge[kept], t0[kept], t1[kept], middle[kept]
    for share in (GAUSS, 1.0 - GAUSS):
        at = start[edge] + (t0 + share * (t1 - t0))[:, None] * step[edge]
        weight = 0.5 * (t1 - t0) * step[edge, 1] * scale[edge]
        out += _deposit(at, middle, weight, low[edge], high[edge], size)
    area = np.cumsum(out.reshape(size[1], size[0] + 1)[:, ::-1], axis=1)[:, -2::-1]
    return np.where(area > 1e-9 * np.abs(area).max(initial=0.0), area, 0.0)


def _deposit(
    at: np.ndarray, middle: np.ndarray, weight: np.ndarray, low: np.ndarray, high: np.ndarray, size: tuple[int, int]
) -> np.ndarray:
    """What each piece of an edge adds to the differences, along rows, of the areas; column 0 lies left of the atlas."""
    x, y = np.clip(at, low, high).T
    column, row = np.floor(np.clip(middle, low, high) - 0.5).astype(np.int64).T
    u, v = x - 0.5 - column, y - 0.5 - row
    first, last = low[:, 0].astype(np.int64), high[:, 0].astype(np.int64) - 1
    near, far = 0.5 + u - 0.5 * u * u, 0.5 * u * u  # integrals of the tents of column and column + 1 up to x
    # At the rims the two are one texel; left of the first column nothing has been counted yet.
    before = column < first
    rim = before | (column >= last)
    total = near + far - before
    here = np.where(before, first, column)
    differences = [
        (here, np.where(rim, total, near - far)),
        (np.where(rim, here, column + 1), np.where(rim, 0.0, far)),
        (here - 1, 1.0 - np.where(rim, total, near)),
    ]
    bottom, top = low[:, 1].astype(np.int64), high[:, 1].astype(np.int64) - 1
    out = np.zeros(size[1] * (size[0] + 1))
    for j, height in ((row, 1.0 - v), (row + 1, v)):
        line = np.clip(j, bottom, top) * (size[0] + 1)
        for i, value in differences:
            out += np.bincount(line + i + 1, weight * height * value, minlength=len(out))
    return out


def _pieces(
    start: np.ndarray, end: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cut edges where they cross a line of texel centres or the rim of their chart: (edge, t0, t1) of each piece."""
    numbers, cuts = [np.arange(len(start))] * 2, [np.zeros(len(start)), np.ones(len(start))]
    for k in range(2):
        p, q = start[:, k], end[:, k]
        slope = np.where(q == p, np.inf, q - p)
        least, most = np.clip(np.minimum(p, q), low[:, k], high[:, k]), np.clip(np.maximum(p, q), low[:, k], high[:, k])
        begin = np.ceil(least - 0.5).astype(np.int64)
        count = np.maximum(np.floor(most - 0.5).astype(np.int64) - begin + 1, 0)
        edge = np.repeat(np.arange(len(start)), count)
        line = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count) + begin[edge] + 0.5
        numbers.append(edge)
        cuts.append((line - p[edge]) / slope[edge])
        for rim in (low[:, k], high[:, k]):
            crosses = np.flatnonzero((rim - p) * (rim - q) < 0)
            numbers.append(crosses)
            cuts.append((rim - p)[crosses] / slope[crosses])
    number, cut = np.concatenate(numbers), np.clip(np.concatenate(cuts), 0.0, 1.0)
    order = np.lexsort((cut, number))
    number, cut = number[order], cut[order]
    same = np.flatnonzero((number[1:] == number[:-1]) & (cut[1:] > cut[:-1]))
    return number[same], cut[same], cut[same + 1]
