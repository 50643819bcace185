"""Which triangles a view can show at all, from the upper levels of their hierarchy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from pellucid.surroundings.geometry import Geometry

# Finer cuts send fewer triangles, but each range is a draw of its own.
CLUSTERS = 256
SMALLEST = 64  # triangles


@dataclass(frozen=True, eq=False)
class Clusters:
    """A cut through the hierarchy: every triangle is in one of them, and theirs follow one another.

    Attributes
    ----------
    lower, upper : (N, 3) float64, bounds in metres.
    first, last : (N,) int64, the triangles first .. last - 1 of the list.
    """

    lower: np.ndarray
    upper: np.ndarray
    first: np.ndarray
    last: np.ndarray


def clusters(geometry: Geometry) -> Clusters:
    """Cut the hierarchy where its nodes hold about a 256th of all triangles: depth first, a node's are contiguous."""
    nodes, total = geometry.nodes, geometry.count
    most = max(SMALLEST, total // CLUSTERS)
    leaves = np.flatnonzero(nodes["count"])
    starts = np.append(nodes["link"][leaves].astype(np.int64), total)
    found: list[tuple[int, int, int]] = []
    waiting = [(0, len(nodes))] if total else []
    while waiting:
        node, end = waiting.pop()
        first, last = (int(starts[np.searchsorted(leaves, k)]) for k in (node, end))
        if nodes["count"][node] or last - first <= most:
            found.append((node, first, last))
            continue
        right = int(nodes["link"][node])
        waiting += [(right, end), (node + 1, right)]
    cut, firsts, lasts = np.array(found, np.int64).reshape(-1, 3).T
    return Clusters(nodes["lower"][cut].astype(np.float64), nodes["upper"][cut].astype(np.float64), firsts, lasts)


def visible_ranges(
    parts: Clusters,
    clip_from_world: np.ndarray,
    clip_plane: np.ndarray | None = None,
    hidden: tuple[ArrayLike, ArrayLike] | None = None,
) -> list[tuple[int, int]]:
    """(first triangle, number) of all clusters that reach into a view, neighbours joined.

    Parameters
    ----------
    clip_from_world : (4, 4), points as columns to clip space with reversed depth, so that near is z = w.
    clip_plane : (4,), what has dot(plane, (p, 1)) < 0 is not shown; None for all.
    hidden : lower and upper corner of a box within which nothing is shown.
    """
    m = np.asarray(clip_from_world, np.float64)
    planes = np.stack([m[3] + m[0], m[3] - m[0], m[3] + m[1], m[3] - m[1], m[3] - m[2], m[2]])
    if clip_plane is not None:
        planes = np.concatenate([planes, np.asarray(clip_plane, np.float64)[None]])
    middle, half = 0.5 * (parts.lower + parts.upper), 0.5 * (parts.upper - parts.lower)
    farthest = middle @ planes[:, :3].T + half @ np.abs(planes[:, :3]).T + planes[:, 3]
    slack = 1e-5 * (np.abs(middle) @ np.abs(planes[:, :3]).T + np.abs(planes[:, 3]))  # the GPU has 32-bit floats
    shown = (farthest >= -slack).all(axis=1)
    if hidden is not None:
        low, high = hidden
        shown &= ~((parts.lower > low) & (parts.upper < high)).all(axis=1)
    seen = np.flatnonzero(shown)
    if not len(seen):
        return []
    apart = np.flatnonzero(parts.first[seen[1:]] != parts.last[seen[:-1]])
    first = parts.first[seen[np.append(0, apart + 1)]]
    last = parts.last[seen[np.append(apart, len(seen) - 1)]]
    return [(int(a), int(b - a)) for a, b in zip(first, last, strict=True)]
