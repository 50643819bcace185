"""How high the horizon of a height field stands, seen from each of its texels."""

from __future__ import annotations

import numpy as np

NEAR_TEXELS = 6


def horizon_map(
    heights_m: np.ndarray,
    cell_m: tuple[float, float],
    tiling: bool = True,
    directions: int = 16,
    reach_texels: int = 256,
) -> np.ndarray:
    """Tangent of the elevation of the horizon for equally spaced azimuths [max1988].

    Every line of sight is sampled where it crosses the columns (or rows) of the field, once a texel along its longer
    axis, and twice nearby; a field that repeats is looked at as far as it repeats, at most.

    Parameters
    ----------
    heights_m : (H, W), row 0 on top.
    cell_m : width and height of a texel, metres.
    tiling : whether the field repeats; else it goes on level beyond its border.
    directions : D; azimuth of direction k is 2 pi k / D, from +u towards +v (up).
    reach_texels : how far to look, along the longer axis.

    Returns
    -------
    (D, H, W) float32; below 0 where the field falls away on that side.
    """
    heights = np.ascontiguousarray(heights_m, np.float32)
    reach = int(min(reach_texels, max(heights.shape)))
    padded = np.pad(heights, reach + 1, mode="wrap" if tiling else "edge")
    out = np.empty((directions, *heights.shape), np.float32)
    for k in range(directions):
        azimuth = 2 * np.pi * k / directions
        out[k] = _horizon_towards(heights, padded, reach, cell_m, (float(np.cos(azimuth)), float(np.sin(azimuth))))
    return out


def _horizon_towards(
    heights: np.ndarray, padded: np.ndarray, reach: int, cell_m: tuple[float, float], way: tuple[float, float]
) -> np.ndarray:
    """The horizon along one direction (east, north); `padded` has `reach` + 1 more texels on every side."""
    step = np.array([way[0] / cell_m[0], -way[1] / cell_m[1]])  # texels: columns, rows
    step /= np.abs(step).max()
    step_m = float(np.hypot(step[0] * cell_m[0], step[1] * cell_m[1]))
    rows, columns = heights.shape
    top = float(heights.max())
    best = np.full_like(heights, -np.inf)
    rise, part = np.empty_like(heights), np.empty_like(heights)
    # The first patch bends most as seen from its corner: nearby the line is also sampled between the texels.
    for at in (*np.arange(0.5, min(NEAR_TEXELS, reach), 1.0), *range(1, reach + 1)):
        place = np.round(at * step, 9)
        low = np.floor(place).astype(int)
        rise[:] = -heights
        for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
            weight = float(np.prod(np.where(corner, place - low, low + 1 - place)))
            if weight > 0.0:
                x, y = low + corner + reach + 1
                np.multiply(padded[y : y + rows, x : x + columns], np.float32(weight), out=part)
                rise += part
        rise *= np.float32(1 / (at * step_m))
        np.maximum(best, rise, out=best)
        if at % 16 == 0 and ((top - heights) <= best * (at * step_m)).all():
            break  # nothing farther off stands higher
    return best
