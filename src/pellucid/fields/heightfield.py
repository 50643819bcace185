"""Height fields: their slopes, and what searches along rays need to know of them beforehand.

Heights are bilinear between texel centres, row 0 at the top (v = 1). A *cell* (j, i) is the square between the
centres of the texels i, i + 1 and j, j + 1; outside of the array heights repeat (`tiling`) or stay as at the border.
A bilinear patch is never higher than the highest of its four corners, nor lower than the lowest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import real_array

Array = npt.NDArray[Any]

# Where a relief has no translucent layer, it is put this far below the solid one, metres.
ABSENT_M = 1.0


def slopes_of(heights_m: npt.ArrayLike, cell_m: tuple[float, float], tiling: bool = True) -> npt.NDArray[np.float32]:
    """Slopes at texel centres by central differences, one-sided at a border that does not repeat.

    Parameters
    ----------
    heights_m : (H, W) metres. cell_m : distance of texel centres along u and v, metres.

    Returns
    -------
    (H, W, 2) float32, metres per metre: dh/dx along growing u, dh/dy along growing v (against the rows).

    Raises
    ------
    SceneError : heights that are no finite (H, W) array, or cells without a size.
    """
    h = _checked(heights_m, "heights_m")
    width, height = _checked_cell(cell_m)
    along_u = _next(h, 1, tiling) - _previous(h, 1, tiling)
    along_v = _previous(h, 0, tiling) - _next(h, 0, tiling)
    rows, columns = (np.full(n, 2.0) if tiling else _spans(n) for n in h.shape)
    slopes = np.stack([along_u / (columns * width), along_v / (rows[:, None] * height)], axis=-1)
    return slopes.astype(np.float32)


def bounds_pyramid(
    solid: npt.ArrayLike, translucent: npt.ArrayLike | None = None, tiling: bool = True
) -> list[npt.NDArray[np.float32]]:
    """Highest and lowest heights of two layers over squares of 1, 2, 4, ... cells [tevs2008].

    Level k has max(1, W >> k) x max(1, H >> k) nodes, as mipmaps have. Node n spans the cells n 2^k to
    (n + 1) 2^k - 1, and the last one all cells to the end of the array, where W is no multiple of 2^k.

    Parameters
    ----------
    solid, translucent : (H, W) metres. Without a second layer it lies `ABSENT_M` below the first.

    Returns
    -------
    One (h, w, 4) float32 array a level: max and min of the solid layer, max and min of the translucent one.

    Raises
    ------
    SceneError : heights that are no finite (H, W) array, or layers of different shapes.
    """
    lower = _checked(solid, "solid").astype(np.float32)
    upper = lower - np.float32(ABSENT_M) if translucent is None else _checked(translucent, "translucent")
    if upper.shape != lower.shape:
        raise SceneError("translucent", f"has shape {upper.shape}, the solid layer {lower.shape}")
    upper = upper.astype(np.float32)
    layers = (lower, upper)
    level = np.stack([f(h, tiling) for h in layers for f in (cell_maxima, cell_minima)], axis=-1)
    levels = [level]
    while max(level.shape[:2]) > 1:
        level = _halved(_halved(level, 0), 1)
        levels.append(level)
    return levels


def cell_maxima(heights: Array, tiling: bool) -> Array:
    """(H, W): the highest corner of each cell, hence of its bilinear patch."""
    along = np.maximum(heights, _next(heights, 1, tiling))
    return np.maximum(along, _next(along, 0, tiling))


def cell_minima(heights: Array, tiling: bool) -> Array:
    """(H, W): the lowest corner of each cell."""
    return -cell_maxima(-heights, tiling)


def cone_map(heights_m: npt.ArrayLike, tiling: bool = True, gaps: int = 96) -> npt.NDArray[np.float32]:
    """How steeply the surface may rise around each cell, for each quadrant of directions of rays.

    Cones of [dummer2006], but with their apex over a whole cell, measured in steps from cell to cell, and narrower
    because rays of a quadrant meet only what lies in it, as in [chen2009].

    Let M be the highest corner of a cell c, and D(Q) = dx(Q) + dy(Q) the sum of the gaps along both axes between a
    point Q and c, in cells. The map holds the least r >= 0 with

        h(V) <= M + r D(V)      for all corners V of cells that rays of the quadrant can reach from c.

    **Nothing is skipped.** Each gap is a linear function within any cell, so h - M - r D is bilinear there, and is
    nowhere greater than at the corners, where it is <= 0. So h(Q) <= M + r D(Q) for *all* points Q of the quadrant. A
    ray leaves c at a point E. A horizontal way (a, b) further on, its gaps sum to at most |a| + |b|. So long as the
    ray is above M + r (|a| + |b|) it is above the surface, whatever its azimuth in the quadrant.

    The greatest corner at gap D is the greatest of two at gap D - 1, seen from the next cell along either axis; so
    the cones are exact, at the cost of one maximum a cell for each D. After `gaps` of them the highest corner of all
    counts as if it came next, which makes cones a little wider than they must be.

    Parameters
    ----------
    heights_m : (H, W) metres. gaps : cells, 1 or more.

    Returns
    -------
    (4, H, W, 2) float32: M in metres, r in metres per cell. Quadrant 0: columns and rows of the array grow along the
    ray; 1: columns fall; 2: rows fall; 3: both fall.

    Raises
    ------
    SceneError : heights that are no finite (H, W) array, or no gaps.
    """
    highest = cell_maxima(_checked(heights_m, "heights_m").astype(np.float32), tiling)
    if gaps < 1:
        raise SceneError("gaps", f"is {gaps}", "use 1 or more")
    falls = [(column, row) for row in (False, True) for column in (False, True)]
    ratios = [_steepest(highest, column, row, tiling, gaps) for column, row in falls]
    return np.stack([np.stack([highest, ratio], axis=-1) for ratio in ratios])


def _steepest(highest: Array, column_falls: bool, row_falls: bool, tiling: bool, gaps: int) -> npt.NDArray[np.float32]:
    """Of one quadrant: the greatest rise a cell of gap to any corner."""
    along = _previous if column_falls else _next
    across = _previous if row_falls else _next
    # All corners of a map that repeats, or ends, have been seen at this gap.
    last = sum(highest.shape)
    ahead, top = highest, highest.max()
    ratio: Array = np.zeros_like(highest)
    for gap in range(1, min(gaps, last) + 1):
        ahead = np.maximum(along(ahead, 1, tiling), across(ahead, 0, tiling))
        np.maximum(ratio, (ahead - highest) / np.float32(gap), out=ratio)
        # Even the top of the relief, if it came next, would raise no ratio any more.
        if gap % 16 == 0 and ((top - highest) <= ratio * np.float32(gap + 1)).all():
            break
    if gaps < last:
        np.maximum(ratio, (top - highest) / np.float32(gaps + 1), out=ratio)
    # Divisions round to the nearest: the least number above is safe.
    return np.where(ratio > 0.0, np.nextafter(ratio, np.float32(np.inf)), ratio).astype(np.float32)


def distance_map(
    heights_m: npt.ArrayLike,
    cell_m: tuple[float, float],
    low_m: float,
    high_m: float,
    layers: int = 32,
    tiling: bool = True,
) -> npt.NDArray[np.float32]:
    """Radii around points over a height field within which there is no matter [donnelly2005].

    The matter is taken to fill each cell up to its highest corner. Exact Euclidean distances to that are found by
    two passes of least sums of squares, one along each axis [felzenszwalb2012]. Half a diagonal of a voxel is taken
    off: with weights w of corners V a trilinear look-up at x is at most the mean of (distance at x + |x - V|), and
    the mean of |x - V| is at most its root mean square, at most half the diagonal. So a look-up anywhere is at most
    the true distance there.

    Parameters
    ----------
    heights_m : (H, W) metres. cell_m : distance of texel centres along u and v, metres.
    low_m, high_m : heights of the first and the last layer of voxels. layers : 2 or more.

    Returns
    -------
    (layers, H, W) float32 metres at the centres of texels, 0 where matter is nearer than half a diagonal.

    Raises
    ------
    SceneError : heights that are no finite (H, W) array, cells without a size, or a box without a height.
    """
    h = _checked(heights_m, "heights_m")
    width, height = _checked_cell(cell_m)
    if layers < 2 or not high_m > low_m:
        raise SceneError("layers", f"are {layers} from {low_m} to {high_m} m", "give 2 or more, and low below high")
    z = np.linspace(low_m, high_m, layers, dtype=np.float32)
    # The nearest point of a box with its corners on texel centres, seen from one, is one.
    top = cell_maxima(h.astype(np.float32), tiling)
    top = np.maximum(top, _previous(top, 1, tiling))
    top = np.maximum(top, _previous(top, 0, tiling))
    squared = np.maximum(z[:, None, None] - top, 0.0) ** 2
    squared = _least_sums(squared, 2, np.float32(width), tiling)
    squared = _least_sums(squared, 1, np.float32(height), tiling)
    half_diagonal = 0.5 * float(np.linalg.norm([width, height, z[1] - z[0]]))
    return np.maximum(np.sqrt(squared) * (1.0 - 1e-6) - half_diagonal, 0.0).astype(np.float32)


def _least_sums(squared: Array, axis: int, edge: np.float32, tiling: bool) -> Array:
    """min over n of squared[.. + n ..] + (n edge)^2 along an axis; n up to where nothing can be less any more."""
    least = squared.copy()
    forward = backward = squared
    for n in range(1, squared.shape[axis]):
        away = (edge * np.float32(n)) ** 2
        if away >= least.max():
            break
        forward, backward = _next(forward, axis, tiling), _previous(backward, axis, tiling)
        np.minimum(least, forward + away, out=least)
        np.minimum(least, backward + away, out=least)
    return least


def complexity_map(heights_m: npt.ArrayLike, radius: int = 4, tiling: bool = True) -> npt.NDArray[np.float32]:
    """How much a straight line may err about the heights near each texel, as a share of their whole range.

    [timonen2006, 2.3.1] carries the intensity of a search in a texture. Over a window of length L in which the slope
    changes by V altogether, a height departs from the chord by at most V L / 4.

    Parameters
    ----------
    heights_m : (H, W) metres. radius : half the window, texels.

    Returns
    -------
    (H, W) float32, 0 (plane) to 1.

    Raises
    ------
    SceneError : heights that are no finite (H, W) array, or a window without a size.
    """
    h = _checked(heights_m, "heights_m")
    if radius < 1:
        raise SceneError("radius", f"is {radius}", "use 1 or more")
    spread = float(np.ptp(h))
    if spread == 0.0:
        return np.zeros(h.shape, np.float32)
    worst: Array = np.zeros_like(h)
    for axis in (0, 1):
        change = np.abs(_next(h, axis, tiling) - 2.0 * h + _previous(h, axis, tiling))
        total = forward = backward = change
        for _ in range(radius):
            forward, backward = _next(forward, axis, tiling), _previous(backward, axis, tiling)
            total = total + forward + backward
        worst = np.maximum(worst, total)
    return np.minimum(worst * (2 * radius) / 4.0 / spread, 1.0).astype(np.float32)


def _checked(heights: npt.ArrayLike, field: str) -> npt.NDArray[np.float64]:
    h = np.asarray(real_array(field, heights), dtype=np.float64)
    if h.ndim != 2 or not h.size:
        raise SceneError(field, f"has shape {h.shape}", "give an array (H, W)")
    if not np.isfinite(h).all():
        raise SceneError(field, "has values that are not finite")
    return h


def _checked_cell(cell_m: tuple[float, float]) -> tuple[float, float]:
    width, height = (float(x) for x in cell_m)
    if not (width > 0.0 and height > 0.0 and np.isfinite(width + height)):
        raise SceneError("cell_m", f"is {cell_m}", "give two positive lengths")
    return width, height


def _spans(count: int) -> npt.NDArray[np.float64]:
    """Texels between the neighbours of each texel of a row that does not repeat; 1 where there are none."""
    index = np.arange(count)
    return np.maximum(np.minimum(index + 1, count - 1) - np.maximum(index - 1, 0), 1).astype(np.float64)


def _next(values: Array, axis: int, tiling: bool) -> Array:
    if tiling:
        return np.roll(values, -1, axis)
    count = values.shape[axis]
    return np.take(values, np.minimum(np.arange(1, count + 1), count - 1), axis)


def _previous(values: Array, axis: int, tiling: bool) -> Array:
    if tiling:
        return np.roll(values, 1, axis)
    return np.take(values, np.maximum(np.arange(-1, values.shape[axis] - 1), 0), axis)


def _halved(level: Array, axis: int) -> Array:
    """Two nodes to one along an axis; an odd one at the end belongs to the last."""
    count = level.shape[axis]
    if count == 1:
        return level
    nodes = np.moveaxis(level, axis, 0)
    pairs = nodes[: count // 2 * 2].reshape(count // 2, 2, *nodes.shape[1:])
    out = _hull(pairs[:, 0], pairs[:, 1])
    if count % 2:
        out[-1] = _hull(out[-1], nodes[-1])
    return np.moveaxis(out, 0, axis)


def _hull(a: Array, b: Array) -> Array:
    """Bounds of both: maxima in the even channels, minima in the odd ones."""
    out = np.maximum(a, b)
    out[..., 1::2] = np.minimum(a[..., 1::2], b[..., 1::2])
    return out
