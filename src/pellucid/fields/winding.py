"""The generalised winding number of a triangle mesh: how often the surface wraps around a point.

w is 1 inside and 0 outside of a closed mesh, and falls smoothly from one to the other across a hole
[jacobson2013]. Far triangles are gathered into dipoles in a tree [barill2018]. What the dipoles get
wrong is put right exactly: a fan of triangles over the open edges closes the mesh, and the winding
number of a closed mesh is a whole number, so w = round(w_tree + w_fan) - w_fan, with w_fan summed
triangle by triangle.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

#: A cluster is a dipole when it is farther than this many of its radii. Its error needs only stay below
#: one half, because the sum is rounded.
FAR_RADII = 1.7
#: The same where the open edges are too many for the exact correction.
FAR_RADII_UNCORRECTED = 3.5
FAN_LIMIT = 2000
LEAF = 8
#: Groups that share one list of clusters in `WindingNumber.of_neighbours`.
SHARED = 4


def solid_angle(corners: Floats, points: Floats) -> Floats:
    """Signed solid angle of triangle n from points (n, k) [oosterom1983, eq. 8].

    Parameters
    ----------
    corners : (N, 3, 3); counter-clockwise seen from outside, then positive from inside.
    points : (N, K, 3) or (1, K, 3).

    Returns
    -------
    (N, K) steradians in [-2 pi, 2 pi].
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    ax, bx, cx = (_lengths(v, points) for v in (a, b, c))
    det = np.sum(normal * a, axis=1)[:, None] - _dots(normal, points)
    ab2, bc2, ca2 = (np.sum((p - q) ** 2, axis=1)[:, None] for p, q in ((a, b), (b, c), (c, a)))
    aa, bb, cc = ax * ax, bx * bx, cx * cx
    denominator = ax * bx * cx
    denominator += 0.5 * ((aa + bb - ab2) * cx + (bb + cc - bc2) * ax + (cc + aa - ca2) * bx)
    return 2.0 * np.arctan2(det, denominator)


def _lengths(vertex: Floats, points: Floats) -> Floats:
    d2 = (points[..., 0] - vertex[:, 0:1]) ** 2
    d2 += (points[..., 1] - vertex[:, 1:2]) ** 2
    d2 += (points[..., 2] - vertex[:, 2:3]) ** 2
    return np.sqrt(d2, out=d2)


def _dots(vector: Floats, points: Floats) -> Floats:
    out = points[..., 0] * vector[:, 0:1]
    out += points[..., 1] * vector[:, 1:2]
    out += points[..., 2] * vector[:, 2:3]
    return out


def open_edges(faces: Ints) -> Ints:
    """Directed edges that no neighbour runs along the other way, repeated by their multiplicity; (E, 2)."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward = edges[:, 0] < edges[:, 1]
    pairs, index = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    net = np.zeros(len(pairs), dtype=np.int64)
    np.add.at(net, index.ravel(), np.where(forward, 1, -1))
    directed = np.where(net[:, None] > 0, pairs, pairs[:, ::-1])
    return np.repeat(directed, np.abs(net), axis=0)


class WindingNumber:
    """Winding number of one mesh at many points.

    Parameters
    ----------
    vertices : (V, 3); corners at the same place must be the same vertex.
    faces : (F, 3), none degenerate.
    """

    def __init__(self, vertices: Floats, faces: Ints) -> None:
        self._corners = vertices[faces]
        edges = open_edges(faces)
        self.is_closed = len(edges) == 0
        self._corrected = len(edges) <= FAN_LIMIT
        self._fan = _fan(vertices, edges) if self._corrected else np.empty((0, 3, 3))
        self._far_radii = FAR_RADII if self._corrected else FAR_RADII_UNCORRECTED
        self._build()

    def __call__(self, groups: Floats) -> Floats:
        """(G, K) winding numbers of points (G, K, 3); the points of a group should be close together."""
        total = np.zeros(groups.shape[:2])
        for start in range(0, len(groups), 4096):
            part = groups[start : start + 4096]
            w = self._hierarchical(part)
            total[start : start + 4096] = self._exact(w, part) if self._corrected else w
        return total

    def of_neighbours(self, groups: Floats) -> Floats:
        """The same for many small groups of nearby points: groups that are close together share their sums."""
        count = -(-len(groups) // SHARED)
        order = _along_curve(groups[:, 0])
        padded = np.concatenate([order, np.repeat(order[-1:], count * SHARED - len(order))])
        w = self(groups[padded].reshape(count, -1, 3)).reshape(len(padded), -1)
        out = np.empty(groups.shape[:2])
        out[padded] = w
        return out

    def _exact(self, w: Floats, groups: Floats) -> Floats:
        if self.is_closed:
            return np.round(w)
        points = groups.reshape(1, -1, 3)
        fan: Floats = np.empty(points.shape[1])
        for start in range(0, len(fan), 256):
            s = slice(start, start + 256)
            fan[s] = solid_angle(self._fan, points[:, s]).sum(axis=0) / (4.0 * np.pi)
        open_part = fan.reshape(w.shape)
        return np.round(w + open_part) - open_part

    def _build(self) -> None:
        """Halve the triangles at the median of their widest axis; nodes are stored parents first."""
        centre = self._corners.mean(axis=1)
        area_normal = 0.5 * np.cross(
            self._corners[:, 1] - self._corners[:, 0], self._corners[:, 2] - self._corners[:, 0]
        )
        area = np.linalg.norm(area_normal, axis=1)
        order = np.arange(len(centre))
        ranges, children = [(0, len(order))], []
        for lo, hi in ranges:
            if hi - lo <= LEAF:
                children.append(-1)
                continue
            members = order[lo:hi]
            axis = int(np.ptp(centre[members], axis=0).argmax())
            middle = (hi - lo) // 2
            order[lo:hi] = members[np.argpartition(centre[members, axis], middle)]
            children.append(len(ranges))
            ranges += [(lo, lo + middle), (lo + middle, hi)]
        self._order, self._child = order, np.array(children)
        self._range = np.array(ranges)
        # The triangles themselves are the last level of clusters, so they too can be dipoles.
        lo, hi = self._range.T
        weights = np.concatenate(
            [np.zeros((1, 7)), np.cumsum(np.column_stack([area, area[:, None] * centre, area_normal])[order], axis=0)]
        )
        sums = weights[hi] - weights[lo]
        node_centre = sums[:, 1:4] / sums[:, 0:1]
        radius = np.array(
            [
                np.sqrt(np.max(np.sum((self._corners[order[a:b]] - c) ** 2, axis=-1)))
                for (a, b), c in zip(ranges, node_centre, strict=True)
            ]
        )
        own_radius = np.sqrt(np.max(np.sum((self._corners - centre[:, None]) ** 2, axis=-1), axis=1))
        self._nodes = len(ranges)
        self._centre = np.concatenate([node_centre, centre])
        self._dipole = np.concatenate([sums[:, 4:7], area_normal])
        self._radius = np.concatenate([radius, own_radius])

    def _interactions(self, centre: Floats, reach: Floats) -> tuple[Ints, Ints, Ints, Ints]:
        """(group, cluster) pairs that are far, (group, triangle) pairs that are near; sorted by group."""
        group = np.arange(len(centre))
        node = np.zeros(len(centre), dtype=np.int64)
        far: list[tuple[Ints, Ints]] = []
        near: list[tuple[Ints, Ints]] = []
        while len(group):
            away = np.linalg.norm(self._centre[node] - centre[group], axis=1) - reach[group]
            is_far = away > self._far_radii * self._radius[node]
            far.append((group[is_far], node[is_far]))
            group, node = group[~is_far], node[~is_far]
            single = node >= self._nodes
            near.append((group[single], node[single] - self._nodes))
            group, node = self._opened(group[~single], node[~single])
        return *_sorted(far), *_sorted(near)

    def _opened(self, group: Ints, node: Ints) -> tuple[Ints, Ints]:
        child = self._child[node]
        inner = child >= 0
        lo, hi = self._range[node[~inner]].T
        count = hi - lo
        within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        triangles = self._order[np.repeat(lo, count) + within] + self._nodes
        groups = [group[inner], group[inner], np.repeat(group[~inner], count)]
        return np.concatenate(groups), np.concatenate([child[inner], child[inner] + 1, triangles])

    def _hierarchical(self, groups: Floats) -> Floats:
        centre = 0.5 * (groups.min(axis=1) + groups.max(axis=1))
        reach = np.sqrt(np.max(np.sum((groups - centre[:, None]) ** 2, axis=2), axis=1))
        far_group, cluster, near_group, triangle = self._interactions(centre, reach)
        w = np.zeros(groups.shape[:2])
        for s, starts in _batches(far_group, groups.shape[1]):
            parts = self._dipole_angle(cluster[s], groups[far_group[s]])
            _add(w, far_group[s], starts, parts)
        for s, starts in _batches(near_group, groups.shape[1]):
            parts = solid_angle(self._corners[triangle[s]], groups[near_group[s]])
            _add(w, near_group[s], starts, parts)
        return w / (4.0 * np.pi)

    def _dipole_angle(self, cluster: Ints, points: Floats) -> Floats:
        """First term of the far field: (c - x) . sum(area normal) / |c - x|^3 [barill2018]."""
        centre, dipole = self._centre[cluster], self._dipole[cluster]
        along = np.sum(dipole * centre, axis=1)[:, None] - _dots(dipole, points)
        return along / _lengths(centre, points) ** 3


def _fan(vertices: Floats, edges: Ints) -> Floats:
    """Triangles that close the mesh: from one point to every open edge, run backwards."""
    if len(edges) == 0:
        return np.empty((0, 3, 3))
    start, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    apex = np.broadcast_to(start.mean(axis=0), start.shape)
    return np.stack([end, start, apex], axis=1)


def _along_curve(points: Floats) -> Ints:
    """Order along the Z curve of Morton: points that follow each other are mostly near each other."""
    low, size = points.min(axis=0), np.ptp(points, axis=0).max()
    cell = ((points - low) / (size if size > 0.0 else 1.0) * 1023.0).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")


def _sorted(pairs: list[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    group = np.concatenate([p[0] for p in pairs])
    item = np.concatenate([p[1] for p in pairs])
    order = np.argsort(group, kind="stable")
    return group[order], item[order]


def _batches(group: Ints, points: int) -> list[tuple[slice, Ints]]:
    length = max(1, 65536 // points)
    out = []
    for start in range(0, len(group), length):
        s = slice(start, min(start + length, len(group)))
        out.append((s, np.flatnonzero(np.diff(group[s], prepend=-1))))
    return out


def _add(w: Floats, group: Ints, starts: Ints, parts: Floats) -> None:
    w[group[starts]] += np.add.reduceat(parts, starts, axis=0)
