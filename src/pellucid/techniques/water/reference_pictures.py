"""What look-ups in pictures are held to, in float64: exact intersections, and the iteration as the thesis has it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def first_triangle(origins: ArrayLike, directions: ArrayLike, triangles: ArrayLike) -> Array:
    """Way (N,) of rays to the first of all triangles, from either side; infinite where there is none [moller1997].

    Parameters
    ----------
    origins, directions : (N, 3). triangles : (T, 3, 3) corners.
    """
    corners = np.asarray(triangles, np.float64)
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    ways = []
    for o, d in zip(np.asarray(origins, np.float64), np.asarray(directions, np.float64), strict=True):
        p = np.cross(d, e2)
        determinant = np.einsum("ij,ij->i", e1, p)
        to_origin = o - a
        q = np.cross(to_origin, e1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.einsum("ij,ij->i", to_origin, p) / determinant
            v = q @ d / determinant
            t = np.einsum("ij,ij->i", e2, q) / determinant
            inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > 1e-9)
        ways.append(t[inside].min() if inside.any() else np.inf)
    return np.array(ways)


@dataclass(frozen=True, eq=False)
class Iterated:
    """Result of the iteration for N rays.

    w, a : (N, 3) points of the ray, and of the bottom where the camera's ray through them ends.
    gap : (N,) metres between the two, the least of all steps.
    """

    w: Array
    a: Array
    gap: Array


def iterate(
    u: ArrayLike,
    r: ArrayLike,
    bottom: Callable[[Array], Array],
    depth_of: Callable[[Array], Array],
    steps: int,
) -> Iterated:
    """Where rays meet the bottom, by the iteration of [mihalik2008, 7.1], one look-up a step.

    Parameters
    ----------
    u, r : (N, 3) points of the surface, unit directions.
    bottom : points (N, 3) to the points where the camera's rays through them end; where there is
        no bottom, any that is far away.
    depth_of : points (N, 3) to their depth (N,) before the camera, metres.
    """
    u, r = np.asarray(u, np.float64), np.asarray(r, np.float64)
    w, a = u.copy(), u.copy()
    best = Iterated(u.copy(), u.copy(), np.full(len(u), np.inf))
    for i in range(steps):
        a_next = bottom(w)
        gap = np.linalg.norm(a_next - w, axis=1)
        nearer = gap < best.gap
        best = Iterated(
            np.where(nearer[:, None], w, best.w),
            np.where(nearer[:, None], a_next, best.a),
            np.where(nearer, gap, best.gap),
        )
        crossed = crossing(u, r, a, a_next)
        lengths = [np.linalg.norm(v, axis=1) for v in (crossed - a, a_next - crossed, a_next - a)]
        between = (lengths[0] + lengths[1] <= 1.001 * lengths[2]) & (i > 0)
        behind = depth_of(w) > depth_of(a_next)
        onward = w + np.where(behind, -gap, gap)[:, None] * r
        w, a = np.where(between[:, None], crossed, onward), a_next
    return best


def crossing(u: Array, r: Array, a_0: Array, a_1: Array) -> Array:
    """Points (N, 3) of the rays on the lines through a_0 and a_1 [mihalik2008, eq. 3]."""
    q = a_1 - a_0
    across = np.cross(r, q)
    square = np.einsum("ij,ij->i", across, across)
    share = np.einsum("ij,ij->i", np.cross(a_0 - u, q), across) / np.maximum(square, 1e-20)
    return u + share[:, None] * r
