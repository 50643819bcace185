"""Charts: flat pieces of an atlas, onto which the meshes around refractive matter are unfolded to collect its light.

A chart is an orthogonal projection of connected triangles along one axis. Coplanar neighbours share a chart, so that a
caustic crosses the diagonal of a quadrangle without a seam; neighbours of a curved surface share one while their
normals stay within the same sixth of the sphere and no crease parts them. Both sides of a thin sheet have charts of
their own. What lies out of reach of all matter has none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pellucid.scene import checks
from pellucid.surroundings.coverage import covered_area

COPLANAR = 1e-6  # 1 - cos of the angle between neighbours that lie in one plane
FLAT = 1e-5  # ... between a triangle and the mean of its group
CREASE_COS = 0.82  # an edge that bends by more, 35 degrees, parts two charts
TURNS = 6  # orientations of a chart that are tried for the smallest rectangle
ATLAS_WIDTH = 64  # at least, texels; a strip of charts would waste a square of it
LEVELS = 4  # resolutions at which light is collected, each a quarter of the one before: wide bundles go to coarse ones
LEVEL_FACTOR = 4
TABLE_CHARTS = 256  # charts in one row of the table texture
TABLE_TEXELS = 2 + LEVELS  # texels of the table for each chart


@dataclass(frozen=True)
class Reach:
    """A ball in which meshes receive the light of one refractive body.

    Parameters
    ----------
    centre : metres, world space. radius_m : of the ball of receivers.
    body_radius_m : of a ball around the body itself, where the light comes from.

    Raises
    ------
    SceneError : a radius that is not above 0, or a centre that is no point.
    """

    centre: checks.Vector
    radius_m: float
    body_radius_m: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", checks.vector("reach.centre", self.centre))
        for name in ("radius_m", "body_radius_m"):
            value = checks.number(f"reach.{name}", getattr(self, name), low=0.0, exclusive=True)
            object.__setattr__(self, name, value)


@dataclass(frozen=True)
class Charts:
    """The atlas of one scene.

    Attributes
    ----------
    front, back : (T,) uint32, chart of each triangle on either side, counted from 1; 0 where there is none.
    table : (C, 8 + 4 LEVELS) float32; rows x and y that give texel coordinates of a world point p as
        ``row[:3] @ p + row[3]``, then for each level the lowest and the highest x, y of its rectangle. A level that is
        as coarse as the one before shares its rectangle.
    area_m2 : (H, W) float32, surface that each texel of the atlas stands for, weighted by its tent.
    owner : (H, W) uint32, chart of each texel of the finest level, counted from 1; 0 elsewhere.
    texel_m : edge of a texel in metres, after coarsening.
    """

    front: np.ndarray
    back: np.ndarray
    table: np.ndarray
    area_m2: np.ndarray
    owner: np.ndarray
    texel_m: float

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the atlas in texels."""
        return self.area_m2.shape[1], self.area_m2.shape[0]


def no_charts(count: int) -> Charts:
    """An atlas of one empty texel for `count` triangles."""
    none = np.zeros(count, np.uint32)
    table = np.zeros((0, 8 + 4 * LEVELS), np.float32)
    return Charts(none, none, table, np.zeros((1, 1), np.float32), np.zeros((1, 1), np.uint32), 1.0)


def build_charts(
    corners: np.ndarray,
    mesh: np.ndarray,
    single_sided: np.ndarray,
    reaches: Sequence[Reach],
    texel_m: float,
    most_texels: int,
) -> Charts:
    """Unfold the triangles that the reaches touch.

    Parameters
    ----------
    corners : (T, 3, 3) metres. mesh : (T,) which mesh each triangle is of. single_sided : (T,) bool.
    reaches : where light can land. texel_m : edge of a texel; coarsened until the atlas fits.
    most_texels : of the atlas; exceeded only when there are more charts than that.

    Raises
    ------
    SceneError : for a texel that is not above 0.
    """
    texel_m = checks.number("texel_m", texel_m, low=0.0, exclusive=True)
    corners = np.asarray(corners, np.float64)
    if not len(corners):
        return no_charts(0)
    face, back = _receiving_sides(corners, mesh, single_sided, reaches)
    if not len(face):
        return no_charts(len(corners))
    points = corners[face]
    points[back] = points[back][:, ::-1]
    normal, _ = _normals(points)
    label, axis = _groups(points, normal, mesh[face])
    order = np.argsort(label, kind="stable")
    face, back, points, label = face[order], back[order], points[order], label[order]
    first = np.searchsorted(label, np.arange(len(axis)))
    frame, low, high = _frames(points, label, first, axis, reaches)
    kept = np.logical_and(*(high > low).T)
    number = np.cumsum(kept)  # from 1
    frame, low, high = frame[kept], low[kept], high[kept]
    inside = kept[label]
    face, back, points, label = face[inside], back[inside], points[inside], number[label[inside]] - 1
    if not len(frame):
        return no_charts(len(corners))
    cells, corner, size, texel_m = _fit(high - low, texel_m, most_texels)
    table = _table(frame, low, high, cells, corner)
    rows, base = table[label], table[label][:, None, 8:10]
    at = np.einsum("fcd,fkd->fck", points, rows[:, :8].reshape(-1, 2, 4)[..., :3]) + rows[:, None, [3, 7]]
    _, double_area = _normals(points)
    area = np.zeros(size[::-1])
    for level, new in enumerate(_distinct(cells).T):
        on = new[label]
        bounds = rows[on, 8 + 4 * level : 12 + 4 * level]
        scale = (bounds[:, 2:] - bounds[:, :2]) / (rows[on, 10:12] - rows[on, 8:10])
        here = (at[on] - base[on]) * scale[:, None] + bounds[:, None, :2]
        area += covered_area(here, 0.5 * double_area[on], bounds[:, :2], bounds[:, 2:], size)
    word = np.zeros((2, len(corners)), np.uint32)
    word[back.astype(int), face] = label + 1
    owner = _owner(cells[:, 0], corner[:, 0], size)
    return Charts(word[0], word[1], table.astype(np.float32), area.astype(np.float32), owner, texel_m)


def _normals(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit normals (F, 3) and twice the areas (F,); a degenerate triangle has both 0."""
    cross = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    length = np.linalg.norm(cross, axis=1)
    return cross / np.where(length > 0, length, 1.0)[:, None], length


def _receiving_sides(
    corners: np.ndarray, mesh: np.ndarray, single_sided: np.ndarray, reaches: Sequence[Reach]
) -> tuple[np.ndarray, np.ndarray]:
    """Triangle and side (True: back) of everything within a reach that its body can shine on."""
    normal, area = _normals(corners)
    low, high = corners.min(axis=1), corners.max(axis=1)
    front, back = np.zeros(len(corners), bool), np.zeros(len(corners), bool)
    shut = _closed(corners, mesh)
    for reach in reaches:
        centre = np.array(reach.centre)
        height = np.einsum("fd,fd->f", centre - corners[:, 0], normal)
        near = np.linalg.norm(np.clip(centre, low, high) - centre, axis=1) < reach.radius_m
        near &= (area > 0) & (np.abs(height) < reach.radius_m)
        front |= near & (height > -reach.body_radius_m)
        back |= near & (height < reach.body_radius_m) & ~(shut & ~_encloses(mesh, low, high, centre))
    back &= ~single_sided
    face = np.concatenate([np.flatnonzero(front), np.flatnonzero(back)])
    return face, np.arange(len(face)) >= front.sum()


def _encloses(mesh: np.ndarray, low: np.ndarray, high: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Whether the box of each triangle's mesh holds a point."""
    lowest = np.full((mesh.max() + 1, 3), np.inf)
    highest = np.full((mesh.max() + 1, 3), -np.inf)
    np.minimum.at(lowest, mesh, low)
    np.maximum.at(highest, mesh, high)
    return np.logical_and.reduce((lowest <= point) & (point <= highest), axis=1)[mesh]


def _closed(corners: np.ndarray, mesh: np.ndarray) -> np.ndarray:
    """Whether each triangle's mesh is a closed surface that faces outwards: its back is never seen from outside."""
    key, forward = _edges(corners, mesh)
    _, place, count = np.unique(key, return_inverse=True, return_counts=True)
    balance = np.bincount(place, np.where(forward, 1.0, -1.0))
    paired = np.logical_and.reduce(((count[place] == 2) & (balance[place] == 0)).reshape(-1, 3), axis=1)
    volume = np.einsum("fd,fd->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    outward = np.bincount(mesh, volume) > 0
    whole = np.bincount(mesh, ~paired) == 0
    return (outward & whole)[mesh]


def _edges(points: np.ndarray, mesh: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Key of each of the three edges of each triangle (3 F,), equal for neighbours, and whether it runs upwards.

    Vertices are the same when they lie at the same place to the last bit of 32.
    """
    bits = (points.reshape(-1, 3).astype(np.float32) + np.float32(0.0)).view(np.uint32).astype(np.uint64)
    bits = np.column_stack([bits, np.repeat(mesh, 3).astype(np.uint64)])
    # Sums of odd multiples modulo 2^64: two of a million vertices collide once in ten million scenes.
    mixed = bits * np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0xD6E8FEB86659FD93], np.uint64)
    mixed ^= mixed >> np.uint64(29)
    mixed = mixed.sum(axis=1, dtype=np.uint64) * np.uint64(0xBF58476D1CE4E5B9)
    names, vertex = np.unique(mixed, return_inverse=True)
    start = vertex.reshape(-1, 3)
    end = np.roll(start, -1, axis=1)
    key = np.minimum(start, end).astype(np.int64) * len(names) + np.maximum(start, end)
    return key.ravel(), (start < end).ravel()


def _groups(points: np.ndarray, normal: np.ndarray, mesh: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Chart of each face, numbered from 0, and the axis (C, 3) along which each chart is projected."""
    key, _ = _edges(points, mesh)
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[same] // 3, order[same + 1] // 3
    cosine = np.einsum("fd,fd->f", normal[a], normal[b])
    plane = cosine > 1 - COPLANAR
    flat = _components(len(points), a[plane], b[plane])
    mean = _mean_normals(points, flat)
    bent = np.bincount(flat, np.einsum("fd,fd->f", normal, mean[flat]) < 1 - FLAT) > 0
    flat = _renumbered(np.where(bent[flat], len(mean) + np.arange(len(points)), flat))
    mean = _mean_normals(points, flat)
    side = np.abs(mean).argmax(axis=1)
    sixth = 2 * side + (np.take_along_axis(mean, side[:, None], axis=1)[:, 0] < 0)
    joins = (sixth[flat[a]] == sixth[flat[b]]) & (cosine > CREASE_COS)
    chart_of_flat = _components(len(mean), flat[a[joins]], flat[b[joins]])
    parts = np.bincount(chart_of_flat)
    axis = np.zeros((len(parts), 3))
    axis[chart_of_flat] = np.concatenate([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]][sixth]
    alone = parts[chart_of_flat] == 1
    axis[chart_of_flat[alone]] = mean[alone]
    return chart_of_flat[flat], axis


def _mean_normals(points: np.ndarray, label: np.ndarray) -> np.ndarray:
    cross = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    total = np.column_stack([np.bincount(label, cross[:, k]) for k in range(3)])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(length > 0, length, 1.0)


def _components(count: int, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Number from 0 of the connected component of each of `count` nodes; the smallest label spreads along edges."""
    label = np.arange(count)
    while (label[a] != label[b]).any():
        smaller = np.minimum(label[a], label[b])
        np.minimum.at(label, label[a], smaller)
        np.minimum.at(label, label[b], smaller)
        while (label != label[label]).any():
            label = label[label]
    return _renumbered(label)


def _renumbered(label: np.ndarray) -> np.ndarray:
    return np.unique(label, return_inverse=True)[1].reshape(-1)


def _frames(
    points: np.ndarray, label: np.ndarray, first: np.ndarray, axis: np.ndarray, reaches: Sequence[Reach]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors (C, 2, 3) in the plane of each chart, turned for the smallest rectangle, and its bounds (C, 2)."""
    aside = np.eye(3)[np.abs(axis).argmin(axis=1)]
    across = np.cross(aside, axis)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    upright = np.stack([across, np.cross(axis, across)], axis=1)
    frame = upright
    low, high = _bounds(points, label, first, axis, frame, reaches)
    for turn in range(1, TURNS):
        angle = 0.5 * np.pi * turn / TURNS
        turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) @ upright
        low_turned, high_turned = _bounds(points, label, first, axis, turned, reaches)
        # A little smaller is not worth a turn: equal sides would be decided by rounding.
        smaller = (high_turned - low_turned).prod(axis=1) < 0.99 * (high - low).prod(axis=1)
        frame = np.where(smaller[:, None, None], turned, frame)
        low, high = np.where(smaller[:, None], low_turned, low), np.where(smaller[:, None], high_turned, high)
    return frame, low, high


def _bounds(
    points: np.ndarray,
    label: np.ndarray,
    first: np.ndarray,
    axis: np.ndarray,
    frame: np.ndarray,
    reaches: Sequence[Reach],
) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinates (C, 2) of each chart in metres, as far as the reaches go; low = high for none."""
    at = np.einsum("fcd,fkd->fck", points, frame[label])
    low, high = np.minimum.reduceat(at.min(axis=1), first), np.maximum.reduceat(at.max(axis=1), first)
    height = np.einsum("fcd,fd->fc", points, axis[label])
    bottom, top = np.minimum.reduceat(height.min(axis=1), first), np.maximum.reduceat(height.max(axis=1), first)
    reach_low, reach_high = np.full(low.shape, np.inf), np.full(high.shape, -np.inf)
    for reach in reaches:
        centre = np.einsum("d,ckd->ck", np.array(reach.centre), frame)
        z = axis @ np.array(reach.centre)
        off = np.maximum(np.maximum(bottom - z, z - top), 0.0)
        radius = np.sqrt(np.maximum(reach.radius_m**2 - off**2, 0.0))[:, None]
        touches = ((centre + radius > low) & (centre - radius < high)).all(axis=1, keepdims=True) & (radius > 0)
        reach_low = np.where(touches, np.minimum(reach_low, centre - radius), reach_low)
        reach_high = np.where(touches, np.maximum(reach_high, centre + radius), reach_high)
    low, high = np.maximum(low, reach_low), np.minimum(high, reach_high)
    return low, np.maximum(high, low)


def _fit(extent: np.ndarray, texel_m: float, most: int) -> tuple[np.ndarray, np.ndarray, tuple[int, int], float]:
    """Texels (C, LEVELS, 2) of each chart, lower corners (C, LEVELS, 2), the size of the atlas, and the texel used."""
    while True:
        finest = np.maximum(np.ceil(extent / texel_m - 1e-6), 1).astype(np.int64)
        cells = np.stack([-(-finest // LEVEL_FACTOR**level) for level in range(LEVELS)], axis=1)
        new = _distinct(cells)
        packed, size = _pack(cells[new])
        if size[0] * size[1] <= most or (cells == 1).all():
            corner = np.zeros_like(cells)
            corner[new] = packed
            for level in range(1, LEVELS):
                corner[:, level] = np.where(new[:, level, None], corner[:, level], corner[:, level - 1])
            return cells, corner, size, texel_m
        texel_m *= max(1.05, np.sqrt(min(size[0] * size[1] / most, 1e6)))


def _distinct(cells: np.ndarray) -> np.ndarray:
    """Whether each level (C, LEVELS) has a rectangle of its own."""
    coarser = np.logical_or.reduce(cells[:, 1:] != cells[:, :-1], axis=2)
    return np.concatenate([np.ones((len(cells), 1), bool), coarser], axis=1)


def _owner(cells: np.ndarray, corner: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Which rectangle (C, 2) covers each texel, counted from 1."""
    count = cells.prod(axis=1)
    chart = np.repeat(np.arange(len(cells)), count)
    place = np.arange(len(chart)) - np.repeat(np.cumsum(count) - count, count)
    owner = np.zeros(size[::-1], np.uint32)
    x, y = corner[chart, 0] + place % cells[chart, 0], corner[chart, 1] + place // cells[chart, 0]
    owner[y, x] = chart + 1
    return owner


def _pack(cells: np.ndarray) -> tuple[np.ndarray, tuple[int, int]]:
    """Place rectangles (C, 2) on shelves, highest first: lower corners (C, 2), and (width, height) of the whole."""
    width = int(max(ATLAS_WIDTH, cells[:, 0].max(), np.ceil(np.sqrt(1.1 * cells.prod(axis=1, dtype=float).sum()))))
    order = np.lexsort((-cells[:, 0], -cells[:, 1]))
    ends = np.cumsum(cells[order, 0])
    corner = np.zeros_like(cells)
    start, top = 0, 0
    while start < len(order):
        before = ends[start] - cells[order[start], 0]
        stop = max(int(np.searchsorted(ends, before + width, side="right")), start + 1)
        shelf = order[start:stop]
        corner[shelf, 0] = ends[start:stop] - cells[shelf, 0] - before
        corner[shelf, 1] = top
        top += int(cells[shelf[0], 1])
        start = stop
    return corner, (width, top)


def _table(frame: np.ndarray, low: np.ndarray, high: np.ndarray, cells: np.ndarray, corner: np.ndarray) -> np.ndarray:
    scale = cells[:, 0] / (high - low)
    rows = np.concatenate([frame * scale[..., None], (corner[:, 0] - low * scale)[..., None]], axis=-1)
    bounds = np.concatenate([corner, corner + cells], axis=-1)
    return np.concatenate([rows.reshape(-1, 8), bounds.reshape(len(cells), -1)], axis=1)
