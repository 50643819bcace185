"""Exact distance from the voxels of a grid to triangles, in a narrow band around them.

The grid is cut into tiles of 4x4x4 voxels. A triangle is measured against the voxels of a tile only
if it can be the nearest one for some voxel of that tile.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

TILE = 4
#: Corners (x, y, z) of a cube of eight voxels, z slowest.
_CUBE = np.array([(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)], dtype=np.float64)
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Grid:
    """Voxel centres `origin_m + (i, j, k) * voxel_m` (x, y, z), and their tiles.

    Parameters
    ----------
    shape : (Z, Y, X).
    origin_m : centre of the first voxel, (x, y, z) metres.
    voxel_m : voxel edges (x, y, z), metres.
    """

    shape: tuple[int, int, int]
    origin_m: Floats
    voxel_m: Floats

    @property
    def tiles(self) -> tuple[int, int, int]:
        """Number of tiles (z, y, x); the last ones may stick out of the grid."""
        z, y, x = (-(-n // TILE) for n in self.shape)
        return z, y, x

    @property
    def tile_offsets_m(self) -> Floats:
        """(64, 3) voxel centres of a tile from its first voxel, z slowest."""
        k, j, i = np.meshgrid(*(np.arange(TILE),) * 3, indexing="ij")
        return np.stack([i, j, k], axis=-1).reshape(-1, 3) * self.voxel_m

    def tile_first_m(self, tile: Ints) -> Floats:
        """Centre (x, y, z) of the first voxel of each tile."""
        k, j, i = np.unravel_index(tile, self.tiles)
        return self.origin_m + np.stack([i, j, k], axis=-1) * TILE * self.voxel_m

    def assemble(self, tile_values: npt.NDArray) -> npt.NDArray:
        """(tiles, 64) values as a (Z, Y, X) array."""
        tz, ty, tx = self.tiles
        full = tile_values.reshape(tz, ty, tx, TILE, TILE, TILE).transpose(0, 3, 1, 4, 2, 5)
        full = full.reshape(tz * TILE, ty * TILE, tx * TILE)
        z, y, x = self.shape
        return np.ascontiguousarray(full[:z, :y, :x])


class TriangleFrames:
    """Triangles laid flat: each has a frame in which its corners are (0,0), (b,0) and (c_x,c_y>0)."""

    def __init__(self, corners: Floats) -> None:
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, ac = b - a, c - a
        self.base = np.linalg.norm(ab, axis=1)
        e1 = ab / self.base[:, None]
        normal = np.cross(ab, ac)
        e3 = normal / np.linalg.norm(normal, axis=1)[:, None]
        e2 = np.cross(e3, e1)
        self.first = a
        self.axes = np.stack([e1, e2, e3], axis=1)
        self.apex = np.stack([np.sum(ac * e1, axis=1), np.sum(ac * e2, axis=1)], axis=1)

    def squared_distance(self, which: Ints, points_m: Floats, offsets_m: Floats) -> Floats:
        """(N, K) squared distances of `points_m[n] + offsets_m[k]` to triangle `which[n]`.

        In the flat frame the distance is the height over the plane, and within the plane the
        distance to the nearest edge, or nothing when the foot is inside all three edges.
        """
        axes = self.axes[which]
        start = np.einsum("nij,nj->ni", axes, points_m - self.first[which])
        local = (axes.reshape(-1, 3) @ offsets_m.T).reshape(len(which), 3, -1) + start[:, :, None]
        x, y, height = local[:, 0], local[:, 1], local[:, 2]
        base = self.base[which][:, None]
        cx, cy = self.apex[which].T[:, :, None]
        flat, inside = _edge(x, y, base, np.zeros_like(base))
        second, left = _edge(x - base, y, cx - base, cy)
        third, right = _edge(x - cx, y - cy, -cx, -cy)
        np.minimum(flat, second, out=flat)
        np.minimum(flat, third, out=flat)
        inside &= left
        inside &= right
        flat[inside] = 0.0
        height *= height
        flat += height
        return flat


def _edge(x: Floats, y: Floats, ux: Floats, uy: Floats) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """Squared distance of (x, y) to the segment (0,0)-(ux,uy), and whether it lies to the left."""
    t = np.clip((x * ux + y * uy) / (ux * ux + uy * uy), 0.0, 1.0)
    dx, dy = x - t * ux, y - t * uy
    return dx * dx + dy * dy, ux * y >= uy * x


def band_distance(corners: Floats, grid: Grid, band_m: float) -> npt.NDArray[np.float64]:
    """Distance from every voxel centre to the nearest triangle, exact up to `band_m`, inf beyond.

    Parameters
    ----------
    corners : (T, 3, 3) triangle corners in metres, none degenerate.
    grid : the voxels.
    band_m : how far to measure.

    Returns
    -------
    (Z, Y, X) float64, metres.
    """
    squared = np.full((int(np.prod(grid.tiles)) * 8, 8), np.inf)
    if len(corners):
        small = split_longer_than(corners, 3 * TILE * float(grid.voxel_m.min()))
        frames = TriangleFrames(small)
        tile, triangle = _candidates(small, frames, grid, band_m)
        octant, triangle = _octants(tile, triangle, frames, grid, band_m)
        first, offsets = _octant_first_m(octant, grid), _CUBE * grid.voxel_m
        for part in _runs(octant, 16384):
            d2 = frames.squared_distance(triangle[part], first[part], offsets)
            starts = np.flatnonzero(np.diff(octant[part], prepend=-1))
            which = octant[part][starts]
            squared[which] = np.minimum(squared[which], np.minimum.reduceat(d2, starts, axis=0))
    by_axis = squared.reshape(-1, 2, 2, 2, 2, 2, 2).transpose(0, 1, 4, 2, 5, 3, 6)
    distance = grid.assemble(np.sqrt(by_axis.reshape(-1, TILE**3)))
    distance[distance > band_m] = np.inf
    return distance


def split_longer_than(corners: Floats, edge_m: float) -> Floats:
    """Halve triangles at their longest edge until no edge is longer than `edge_m`; covers the same points."""
    done = []
    while len(corners):
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        long = lengths.max(axis=1) > edge_m
        done.append(corners[~long])
        corners = halved(corners[long], lengths[long].argmax(axis=1))
    return np.concatenate(done) if done else corners


def halved(corners: Floats, edge: Ints) -> Floats:
    """Two triangles for each one, split in the middle of its edge number `edge`; (2T, 3, 3)."""
    row = np.arange(len(corners))
    p, q, r = (corners[row, (edge + k) % 3] for k in range(3))
    middle = 0.5 * (p + q)
    return np.concatenate([np.stack([p, middle, r], axis=1), np.stack([middle, q, r], axis=1)])


def _candidates(corners: Floats, frames: TriangleFrames, grid: Grid, band_m: float) -> tuple[Ints, Ints]:
    """Pairs (tile, triangle), sorted by tile, in which the triangle can be nearest to some voxel."""
    low = (corners.min(axis=1) - band_m - grid.origin_m) / grid.voxel_m
    high = (corners.max(axis=1) + band_m - grid.origin_m) / grid.voxel_m
    count = np.array(grid.tiles[::-1])
    first = np.clip(np.floor(np.ceil(low) / TILE), 0, count).astype(np.int64)
    last = np.clip(np.floor(np.floor(high) / TILE), -1, count - 1).astype(np.int64)
    size = np.maximum(last - first + 1, 0)
    triangle = np.repeat(np.arange(len(corners)), size.prod(axis=1))
    within = np.arange(len(triangle)) - np.repeat(np.cumsum(size.prod(axis=1)) - size.prod(axis=1), size.prod(axis=1))
    nx, ny = size[triangle, 0], size[triangle, 1]
    i = first[triangle, 0] + within % nx
    j = first[triangle, 1] + within // nx % ny
    k = first[triangle, 2] + within // (nx * ny)
    tile = np.ravel_multi_index((k, j, i), grid.tiles)
    return _prune(tile, triangle, frames, grid, band_m)


def _prune(tile: Ints, triangle: Ints, frames: TriangleFrames, grid: Grid, band_m: float) -> tuple[Ints, Ints]:
    half = 0.5 * (TILE - 1) * grid.voxel_m
    radius = float(np.linalg.norm(half))
    to_centre = np.empty(len(tile))
    for s in _runs(tile, 65536):
        d2 = frames.squared_distance(triangle[s], grid.tile_first_m(tile[s]), half[None, :])
        to_centre[s] = np.sqrt(d2[:, 0])
    nearest = np.full(int(np.prod(grid.tiles)), np.inf)
    np.minimum.at(nearest, tile, to_centre)
    kept = np.flatnonzero(to_centre <= _limit(nearest[tile], radius, band_m))
    order = kept[np.argsort(tile[kept], kind="stable")]
    return tile[order], triangle[order]


def _octants(tile: Ints, triangle: Ints, frames: TriangleFrames, grid: Grid, band_m: float) -> tuple[Ints, Ints]:
    """The same pairs for the eight octants of a tile (number 8 tile + octant), pruned once more."""
    radius = 0.5 * float(np.linalg.norm(grid.voxel_m))
    centres = (2.0 * _CUBE + 0.5) * grid.voxel_m
    to_centre = np.empty((len(tile), 8))
    for s in _runs(tile, 16384):
        to_centre[s] = np.sqrt(frames.squared_distance(triangle[s], grid.tile_first_m(tile[s]), centres))
    nearest = np.full((int(np.prod(grid.tiles)), 8), np.inf)
    starts = np.flatnonzero(np.diff(tile, prepend=-1))
    if len(tile):
        nearest[tile[starts]] = np.minimum.reduceat(to_centre, starts, axis=0)
    pair, octant = np.nonzero(to_centre <= _limit(nearest[tile], radius, band_m))
    number = tile[pair] * 8 + octant
    order = np.argsort(number, kind="stable")
    return number[order], triangle[pair[order]]


def _limit(nearest: Floats, radius: float, band_m: float) -> Floats:
    """How far a triangle may be from the centre of a group of voxels and yet be nearest to one of them."""
    return np.minimum(nearest + 2.0 * radius, band_m + radius) * (1.0 + 1e-9)


def _octant_first_m(octant: Ints, grid: Grid) -> Floats:
    return grid.tile_first_m(octant // 8) + 2.0 * _CUBE[octant % 8] * grid.voxel_m


def _runs(tile: Ints, length: int) -> Iterator[slice]:
    for start in range(0, len(tile), length):
        yield slice(start, min(start + length, len(tile)))
