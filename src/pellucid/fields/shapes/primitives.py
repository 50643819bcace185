"""Simple solids and how to join them, as signed distance functions `f(x, y, z)` in metres.

Every function here returns a function of three arrays that gives metres, negative inside. "Exact"
means the Euclidean distance; otherwise the magnitude is a lower bound of it, safe to step along
[hart1996]. Formulas of the exact solids after [quilez2013].
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

Values = npt.NDArray[np.float64]
Shape = Callable[[Any, Any, Any], Values]


def positive(name: str, value: float) -> float:
    """The value as a float, or a SceneError that names it."""
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise SceneError(name, f"is {value!r}", "give a positive length in metres")
    return number


def sphere(radius_m: float) -> Shape:
    """Ball about the origin; exact."""
    radius = positive("radius_m", radius_m)
    return lambda x, y, z: np.sqrt(x * x + y * y + z * z) - radius


def box(size_m: Sequence[float] | float) -> Shape:
    """Box of edges (x, y, z), or a cube; exact."""
    return rounded_box(size_m, 0.0)


def rounded_box(size_m: Sequence[float] | float, radius_m: float) -> Shape:
    """Box of outer edges (x, y, z) whose edges and corners are rounded; exact.

    Raises
    ------
    SceneError
        The radius is negative or more than half of the shortest edge.
    """
    edges = [positive("size_m", e) for e in np.broadcast_to(np.asarray(size_m, dtype=float), (3,))]
    if not 0.0 <= radius_m <= 0.5 * min(edges):
        raise SceneError("radius_m", f"is {radius_m}", "use 0 to half of the shortest edge")

    def distance(x: Any, y: Any, z: Any) -> Values:
        q = [np.abs(v) - (0.5 * e - radius_m) for v, e in zip((x, y, z), edges, strict=True)]
        outside = np.sqrt(sum(np.maximum(v, 0.0) ** 2 for v in q))
        return outside + np.minimum(np.maximum(np.maximum(q[0], q[1]), q[2]), 0.0) - radius_m

    return distance


def cylinder(radius_m: float, height_m: float) -> Shape:
    """Upright cylinder (axis y), centred; exact."""
    radius, half = positive("radius_m", radius_m), 0.5 * positive("height_m", height_m)
    return lambda x, y, z: _both(np.hypot(x, z) - radius, np.abs(y) - half)


def capsule(start_m: Sequence[float], end_m: Sequence[float], radius_m: float) -> Shape:
    """All points within a radius of the segment between two points; exact."""
    radius = positive("radius_m", radius_m)
    a, b = np.asarray(start_m, dtype=float), np.asarray(end_m, dtype=float)
    d = b - a
    squared = max(float(d @ d), 1e-300)

    def distance(x: Any, y: Any, z: Any) -> Values:
        px, py, pz = x - a[0], y - a[1], z - a[2]
        t = np.clip((px * d[0] + py * d[1] + pz * d[2]) / squared, 0.0, 1.0)
        return np.sqrt((px - t * d[0]) ** 2 + (py - t * d[1]) ** 2 + (pz - t * d[2]) ** 2) - radius

    return distance


def torus(ring_radius_m: float, tube_radius_m: float) -> Shape:
    """Ring about the y axis; exact."""
    ring, tube = positive("ring_radius_m", ring_radius_m), positive("tube_radius_m", tube_radius_m)
    return lambda x, y, z: np.hypot(np.hypot(x, z) - ring, y) - tube


def plane(normal: Sequence[float], offset_m: float = 0.0) -> Shape:
    """Half space behind the plane `normal . p = offset_m`; exact."""
    n = np.asarray(normal, dtype=float)
    length = float(np.linalg.norm(n))
    if n.shape != (3,) or not (np.isfinite(length) and length > 0.0):
        raise SceneError("normal", f"is {normal!r}", "give a direction of three numbers")
    n = n / length
    return lambda x, y, z: n[0] * x + n[1] * y + n[2] * z - offset_m


def ellipsoid(radii_m: Sequence[float]) -> Shape:
    """Ellipsoid of half axes (x, y, z): the implicit function over its gradient, right near the surface only."""
    r = np.array([positive("radii_m", v) for v in radii_m])

    def distance(x: Any, y: Any, z: Any) -> Values:
        k0 = np.sqrt((x / r[0]) ** 2 + (y / r[1]) ** 2 + (z / r[2]) ** 2)
        k1 = np.sqrt((x / r[0] ** 2) ** 2 + (y / r[1] ** 2) ** 2 + (z / r[2] ** 2) ** 2)
        # At the centre both vanish and the distance is that of the shortest half axis.
        return np.where(k1 > 0.0, k0 * (k0 - 1.0) / np.where(k1 > 0.0, k1, 1.0), -r.min())

    return distance


def union(*shapes: Shape) -> Shape:
    """In any of the shapes; exact outside."""
    return _fold(np.minimum, shapes)


def intersection(*shapes: Shape) -> Shape:
    """In all of the shapes; a lower bound outside, exact inside."""
    return _fold(np.maximum, shapes)


def difference(shape: Shape, *removed: Shape) -> Shape:
    """In the first shape and in none of the others; a lower bound."""
    taken = union(*removed)
    return lambda x, y, z: np.maximum(shape(x, y, z), -taken(x, y, z))


def smooth_union(width_m: float, *shapes: Shape) -> Shape:
    """Union with a fillet: the quadratic smooth minimum, which blends where two distances differ by less than a width.

    A lower bound of the distance to the union by at most a quarter of the width [quilez2013].
    """
    width = positive("width_m", width_m)

    def blend(a: Values, b: Values) -> Values:
        h = np.maximum(width - np.abs(a - b), 0.0) / width
        return np.minimum(a, b) - 0.25 * width * h * h

    return _fold(blend, shapes)


def moved(shape: Shape, offset_m: Sequence[float]) -> Shape:
    """The shape with its origin at `offset_m`."""
    dx, dy, dz = (float(v) for v in offset_m)
    return lambda x, y, z: shape(x - dx, y - dy, z - dz)


def rotated(shape: Shape, rotation: npt.ArrayLike) -> Shape:
    """The shape turned by a rotation matrix (3, 3) that takes its own directions to the outer ones.

    Raises
    ------
    SceneError
        The matrix is no rotation: it would stretch distances.
    """
    m = np.asarray(rotation, dtype=float)
    if m.shape != (3, 3) or not np.allclose(m @ m.T, np.eye(3), atol=1e-9):
        raise SceneError("rotation", "is not a rotation matrix", "its rows must be orthonormal")
    return lambda x, y, z: shape(*(m[0, i] * x + m[1, i] * y + m[2, i] * z for i in range(3)))


def grown(shape: Shape, by_m: float) -> Shape:
    """The shape with its surface moved outward (inward if negative) by a distance."""
    return lambda x, y, z: shape(x, y, z) - by_m


def nested_rounded_cubes(size_m: float, shell_m: float, radius_m: float | None = None) -> tuple[Shape, Shape, Shape]:
    """Three rounded cubes one inside the other, innermost first, as `Volume.from_regions` wants them.

    Parameters
    ----------
    size_m : edge of the outermost.
    shell_m : thickness of each of the two shells.
    radius_m : of the outermost cube's edges; an eighth of its size if not given.
    """
    outer = 0.125 * positive("size_m", size_m) if radius_m is None else radius_m
    positive("size_m", size_m - 4.0 * positive("shell_m", shell_m))
    edges = [size_m - 2.0 * k * shell_m for k in (2, 1, 0)]
    first, second, third = (rounded_box(e, outer * e / size_m) for e in edges)
    return first, second, third


def extruded(flat: Callable[[Any, Any], Values], height_m: float, rounding_m: float = 0.0) -> Shape:
    """A flat shape in x, y drawn out along z, centred; exact if the flat distance is.

    Parameters
    ----------
    flat : signed distance `f(x, y)` in metres.
    height_m : along z, rounding included.
    rounding_m : radius of the rims; the flat shape keeps its outline and must be wider than twice this.
    """
    half = 0.5 * positive("height_m", height_m)
    if not 0.0 <= rounding_m <= half:
        raise SceneError("rounding_m", f"is {rounding_m}", "use 0 to half of the height")
    return lambda x, y, z: _both(flat(x, y) + rounding_m, np.abs(z) - (half - rounding_m)) - rounding_m


def _both(a: Values, b: Values) -> Values:
    """Distance to the product of two sets in orthogonal spaces."""
    return np.hypot(np.maximum(a, 0.0), np.maximum(b, 0.0)) + np.minimum(np.maximum(a, b), 0.0)


def _fold(join: Callable[[Values, Values], Values], shapes: Sequence[Shape]) -> Shape:
    if not shapes:
        raise SceneError("shapes", "is empty", "give at least one shape")

    def distance(x: Any, y: Any, z: Any) -> Values:
        joined = shapes[0](x, y, z)
        for shape in shapes[1:]:
            joined = join(joined, shape(x, y, z))
        return joined

    return distance
