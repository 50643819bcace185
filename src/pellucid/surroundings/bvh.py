"""A bounding volume hierarchy over triangles, built level by level with the surface area heuristic.

All nodes of one level are split at once by array operations, so a hundred thousand triangles take about
a second in NumPy. The result is stored depth first: the left child of node ``i`` is node ``i + 1``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pellucid.errors import SceneError

LEAF_TRIANGLES = 4
BINS = 12
MAX_DEPTH = 30  # the traversal in raycast.wgsl keeps a stack of 32 nodes
MAX_TRIANGLES = 1_600_000  # 80 bytes of attributes each stay below the 128 MiB that WebGPU grants a storage binding


@dataclass(frozen=True)
class Bvh:
    """A flattened hierarchy.

    Attributes
    ----------
    lower, upper : (N, 3) float32, bounds of each node, in the unit of the vertices.
    link : (N,) uint32, first triangle of a leaf, index of the right child of an inner node.
    count : (N,) uint32, triangles of a leaf, 0 for an inner node.
    order : (T,) int64, the triangle that stands at each place of the reordered list.
    depth : levels below the root.
    """

    lower: np.ndarray
    upper: np.ndarray
    link: np.ndarray
    count: np.ndarray
    order: np.ndarray
    depth: int


def build(triangles: np.ndarray) -> Bvh:
    """Build the hierarchy of a triangle soup by the binned surface area heuristic [wald2007].

    Parameters
    ----------
    triangles : (T, 3, 3) vertex positions, T >= 1.

    Raises
    ------
    SceneError : no triangle, too many, or a vertex that is not finite.
    """
    _check(triangles)
    lower, upper = triangles.min(axis=1).astype(np.float32), triangles.max(axis=1).astype(np.float32)
    centroid = 0.5 * (lower + upper)
    count = len(triangles)
    sah_levels = max(0, MAX_DEPTH - 1 - int(np.ceil(np.log2(max(count / LEAF_TRIANGLES, 1.0)))))
    order = np.arange(count)
    starts, ends = np.array([0]), np.array([count])
    levels: list[_Level] = []
    while len(starts):
        splits = ends - starts > LEAF_TRIANGLES
        level = _Level(starts, ends, splits, *_range_bounds(lower[order], upper[order], starts, ends))
        levels.append(level)
        starts, ends = _split_level(order, lower, upper, centroid, level, len(levels) <= sah_levels)
    return _flatten(levels, order)


@dataclass(frozen=True)
class _Level:
    starts: np.ndarray
    ends: np.ndarray
    splits: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def _check(triangles: np.ndarray) -> None:
    if triangles.ndim != 3 or triangles.shape[1:] != (3, 3) or not len(triangles):
        raise SceneError("mesh.faces", f"expected triangles of shape (T, 3, 3), got {triangles.shape}")
    if len(triangles) > MAX_TRIANGLES:
        raise SceneError(
            "mesh.faces",
            f"{len(triangles):,} triangles in the scene, at most {MAX_TRIANGLES:,} fit",
            "simplify the meshes",
        )
    if not np.isfinite(triangles).all():
        raise SceneError("mesh.vertices", "a vertex is not a finite number")


def _range_bounds(
    lower: np.ndarray, upper: np.ndarray, starts: np.ndarray, ends: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the triangles start..end of every range; the ranges are disjoint and not empty."""
    edges = np.stack([starts, ends], axis=1).ravel()
    edges = edges[:-1] if edges[-1] == len(lower) else edges
    return np.minimum.reduceat(lower, edges)[::2], np.maximum.reduceat(upper, edges)[::2]


def _split_level(
    order: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    centroid: np.ndarray,
    level: _Level,
    use_sah: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """Split every node of the level that is too large; reorders ``order`` in place, returns the children."""
    starts, ends = level.starts[level.splits], level.ends[level.splits]
    if not len(starts):
        return starts, ends
    sizes = ends - starts
    node = np.repeat(np.arange(len(starts)), sizes)
    place = np.arange(len(node)) + np.repeat(starts - np.concatenate([[0], np.cumsum(sizes)[:-1]]), sizes)
    items = order[place]
    if use_sah:
        right = _sah_sides(lower[items], upper[items], centroid[items], node, len(starts))
        n_right = np.bincount(node[right], minlength=len(starts))
        lopsided = (n_right == 0) | (n_right == sizes)
    else:
        right, lopsided = np.zeros(len(node), bool), np.ones(len(starts), bool)
    if lopsided.any():
        right = np.where(lopsided[node], _median_sides(centroid[items], node, starts, sizes), right)
        n_right = np.bincount(node[right], minlength=len(starts))
    order[place] = items[np.argsort(2 * node + right, kind="stable")]
    middles = ends - n_right
    return np.stack([starts, middles], 1).ravel(), np.stack([middles, ends], 1).ravel()


def _sah_sides(lower: np.ndarray, upper: np.ndarray, centroid: np.ndarray, node: np.ndarray, nodes: int) -> np.ndarray:
    """Whether each triangle goes right at its node's cheapest of the 3 (BINS - 1) candidate planes."""
    first = np.searchsorted(node, np.arange(nodes))
    c_lower = np.minimum.reduceat(centroid, first)
    c_extent = np.maximum.reduceat(centroid, first) - c_lower
    scale = np.where(c_extent > 0, BINS * (1 - 1e-6) / np.where(c_extent > 0, c_extent, 1), 0)
    bins = np.minimum(((centroid - c_lower[node]) * scale[node]).astype(np.int32), BINS - 1)
    costs = np.stack([_plane_costs(lower, upper, node * BINS + bins[:, a], nodes) for a in range(3)], axis=1)
    costs[~(c_extent > 0)] = np.inf
    best = costs.reshape(nodes, -1).argmin(axis=1)
    axis, plane = best // (BINS - 1), best % (BINS - 1)
    return bins[np.arange(len(node)), axis[node]] > plane[node]


def _plane_costs(lower: np.ndarray, upper: np.ndarray, cell: np.ndarray, nodes: int) -> np.ndarray:
    """Surface area times triangle count, left plus right, of each plane between bins: (nodes, BINS - 1)."""
    count = np.bincount(cell, minlength=nodes * BINS).reshape(nodes, BINS)
    low = np.full((3, nodes * BINS), np.inf, np.float32)
    high = np.full((3, nodes * BINS), -np.inf, np.float32)
    for k in range(3):
        np.minimum.at(low[k], cell, lower[:, k])
        np.maximum.at(high[k], cell, upper[:, k])
    lows, highs = low.reshape(3, nodes, BINS), high.reshape(3, nodes, BINS)
    left = _area(np.minimum.accumulate(lows, -1), np.maximum.accumulate(highs, -1))
    right = _area(
        np.minimum.accumulate(lows[..., ::-1], -1)[..., ::-1],
        np.maximum.accumulate(highs[..., ::-1], -1)[..., ::-1],
    )
    n_left = np.cumsum(count, axis=1)
    n_right = n_left[:, -1:] - n_left
    return left[:, :-1] * n_left[:, :-1] + right[:, 1:] * n_right[:, :-1]


def _area(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    size = np.maximum(high.astype(np.float64) - low, 0.0)
    size[~np.isfinite(size)] = 0.0
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0]


def _median_sides(centroid: np.ndarray, node: np.ndarray, starts: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Right half of each node by the order of centroids along its longest axis; halves even equal centroids."""
    first = np.searchsorted(node, np.arange(len(starts)))
    extent = np.maximum.reduceat(centroid, first) - np.minimum.reduceat(centroid, first)
    key = centroid[np.arange(len(node)), extent.argmax(axis=1)[node]]
    sorted_items = np.lexsort((key, node))
    rank = np.empty(len(node), np.int64)
    rank[sorted_items] = np.arange(len(node)) - first[node]
    return rank >= (sizes // 2)[node]


def _flatten(levels: list[_Level], order: np.ndarray) -> Bvh:
    """Number the nodes depth first: a node, its left subtree, its right subtree."""
    subtree: list[np.ndarray] = []
    for level in reversed(levels):
        size = np.ones(len(level.starts), np.int64)
        if subtree:
            size[level.splits] += subtree[-1][0::2] + subtree[-1][1::2]
        subtree.append(size)
    subtree.reverse()
    total = int(subtree[0][0])
    lower, upper = np.empty((total, 3), np.float32), np.empty((total, 3), np.float32)
    link, count = np.zeros(total, np.uint32), np.zeros(total, np.uint32)
    index = np.array([0])
    for depth, level in enumerate(levels):
        lower[index], upper[index] = level.lower, level.upper
        leaf = ~level.splits
        link[index[leaf]] = level.starts[leaf]
        count[index[leaf]] = (level.ends - level.starts)[leaf]
        parent = index[level.splits]
        if len(parent):
            left = parent + 1
            right = left + subtree[depth + 1][0::2]
            link[parent] = right
            index = np.stack([left, right], axis=1).ravel()
    return Bvh(lower, upper, link, count, order, len(levels) - 1)
