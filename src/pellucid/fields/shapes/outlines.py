"""Solids from a flat outline: turned on a lathe, or drawn out."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

from .primitives import Shape, Values, extruded, positive

#: Radii that differ by less than this share of the largest count as one.
SAME_RADIUS = 1e-12
#: Corners nearer to the axis than this share of the largest radius lie on it.
ON_AXIS = 1e-9


def polygon_distance(outline_m: npt.ArrayLike, u: Any, v: Any, silent_m: float = -1.0) -> Values:
    """Exact signed distance in the plane to a closed polygon, negative inside (even-odd rule).

    Distance: to the nearest edge. Sign: how often a ray along +u crosses the outline.

    Parameters
    ----------
    outline_m : (N, 2) corners, any orientation; the last is joined to the first.
    u, v : coordinates, arrays of one shape.
    silent_m : edges with both ends at `u <= silent_m` bound the inside but are no surface.
    """
    points = _checked(outline_m)
    u, v = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(v, dtype=float))
    squared = np.full(u.shape, np.inf)
    odd = np.zeros(u.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        ex, ey = bx - ax, by - ay
        length = ex * ex + ey * ey
        if length == 0.0:
            continue
        px, py = u - ax, v - ay
        if ax > silent_m or bx > silent_m:
            t = np.clip((px * ex + py * ey) / length, 0.0, 1.0)
            np.minimum(squared, (px - t * ex) ** 2 + (py - t * ey) ** 2, out=squared)
        if ey != 0.0:
            odd ^= ((v < ay) != (v < by)) & (px < py * (ex / ey))
    distance = np.sqrt(squared)
    return np.where(odd, -distance, distance)


def lathe(profile_m: npt.ArrayLike) -> Shape:
    """A polygon in (radius, height) turned about the y axis; exact.

    Edges on the axis close the polygon and are no surface. Points at the same radius and height
    share one evaluation, so a grid costs about as much as one of its slices for each of its radii.

    Parameters
    ----------
    profile_m : (N, 2) corners (r >= 0, y) of a closed polygon.

    Raises
    ------
    SceneError
        Fewer than three corners, values that are not finite, or a negative radius.
    """
    points = _checked(profile_m)
    if (points[:, 0] < 0.0).any():
        raise SceneError("profile_m", "has a negative radius")
    # A cosine of 90 degrees is not quite 0, but its point is meant to be on the axis.
    points[points[:, 0] < ON_AXIS * points[:, 0].max(), 0] = 0.0

    def distance(x: Any, y: Any, z: Any) -> Values:
        r, height = np.broadcast_arrays(np.hypot(x, z), np.asarray(y, dtype=float))
        grain = SAME_RADIUS * max(float(r.max(initial=0.0)), 1e-300)
        radii, which_r = np.unique(np.round(r / grain), return_inverse=True)
        heights, which_y = np.unique(height, return_inverse=True)
        if len(radii) * len(heights) >= r.size:
            return polygon_distance(points, r, height, silent_m=0.0)
        table = polygon_distance(points, (radii * grain)[:, None], heights[None, :], silent_m=0.0)
        return table[which_r.reshape(r.shape), which_y.reshape(r.shape)]

    return distance


def extruded_polygon(outline_m: npt.ArrayLike, height_m: float, rounding_m: float = 0.0) -> Shape:
    """A polygon (N, 2) in x, y drawn out along z; exact if `rounding_m` is 0."""
    points = _checked(outline_m)
    return extruded(lambda x, y: polygon_distance(points, x, y), height_m, rounding_m)


def prism(side_m: float, length_m: float) -> Shape:
    """Dispersing prism: an equilateral triangle in x, y, apex up, its centroid on the z axis; exact."""
    side = positive("side_m", side_m)
    low, high = -side / np.sqrt(12.0), side / np.sqrt(3.0)
    return extruded_polygon([(-0.5 * side, low), (0.5 * side, low), (0.0, high)], length_m)


def smooth_curve(knots_m: npt.ArrayLike, samples: int = 16) -> Values:
    """Points on a smooth curve through knots: the centripetal Catmull-Rom spline, ends included.

    Parameters
    ----------
    knots_m : (N, 2), neighbours distinct.
    samples : points for each stretch between knots.
    """
    p = np.asarray(knots_m, dtype=float)
    p = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    t = np.concatenate([[0.0], np.cumsum(np.sqrt(np.linalg.norm(np.diff(p, axis=0), axis=1)))])
    stretches = []
    for i in range(1, len(p) - 2):
        s = np.linspace(t[i], t[i + 1], samples, endpoint=False)[:, None]
        stretches.append(_barry_goldman(p[i - 1 : i + 3], t[i - 1 : i + 3], s))
    return np.concatenate([*stretches, p[-2:-1]])


def _barry_goldman(p: Values, t: Values, s: Values) -> Values:
    """Catmull-Rom by repeated interpolation over the knot times of four points."""
    row = [p[i] + (p[i + 1] - p[i]) * (s - t[i]) / (t[i + 1] - t[i]) for i in range(3)]
    pair = [row[i] + (row[i + 1] - row[i]) * (s - t[i]) / (t[i + 2] - t[i]) for i in range(2)]
    return pair[0] + (pair[1] - pair[0]) * (s - t[1]) / (t[2] - t[1])


def _checked(outline_m: npt.ArrayLike) -> Values:
    points = np.array(outline_m, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise SceneError("profile_m", f"has shape {points.shape}", "give at least three corners, (N, 2)")
    if not np.isfinite(points).all():
        raise SceneError("profile_m", "has values that are not finite")
    return points
