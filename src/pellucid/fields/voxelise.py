"""Signed distance of a triangle mesh on a voxel grid; the mesh may be open and may cross itself.

Inside is where the generalised winding number exceeds one half. Hence the surface consists of
 * the parts of the triangles with inside on one side and outside on the other (a wall buried in
   the overlap of two bodies is no surface), and
 * across holes, the level set w = 1/2, which is meshed (`surface_nets`) from the same voxels.
The distance to both is exact in a band of three voxels; beyond, it is a lower bound that is safe to
step along [hart1996].
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

from .surface_nets import nets_in_voxels
from .triangles import TILE, Grid, band_distance, halved
from .winding import WindingNumber

BAND_VOXELS = 3.0
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Progress = Callable[[float], None]


def signed_distance(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    shape: tuple[int, int, int],
    origin_m: npt.ArrayLike,
    voxel_m: npt.ArrayLike,
    progress: Progress | None = None,
) -> npt.NDArray[np.float32]:
    """Signed distance from voxel centres to the surface of a mesh, negative inside.

    Sign: generalised winding number [jacobson2013] above one half, by a tree of dipoles [barill2018] and
    exact to rounding. Faces must be oriented consistently; a mesh turned inside out as a whole (negative
    volume about its centroid) is turned back.

    Parameters
    ----------
    vertices : (V, 3) metres.
    faces : (F, 3) vertex indices; faces without area are dropped, equal vertices are merged.
    shape : (Z, Y, X) voxels.
    origin_m : centre (x, y, z) of the first voxel.
    voxel_m : voxel edges (x, y, z), or one number for cubes.
    progress : called with the fraction done, 0 to 1.

    Returns
    -------
    (Z, Y, X) float32 in metres. Exact up to three voxels from the surface; farther away the
    magnitude is at most the true distance, and less than two voxel diagonals short of it. Parts of
    the mesh outside the grid are kept account of in that bound.

    Raises
    ------
    SceneError
        The mesh is empty, has values that are not finite, indices out of range or no face with
        area; or the grid is not one.
    """
    report = progress or (lambda fraction: None)
    grid = _grid(shape, origin_m, voxel_m)
    points, triangles = cleaned(vertices, faces)
    winding = WindingNumber(points, triangles)
    surface, buried = _surface_parts(points[triangles], winding, float(grid.voxel_m.min()))
    report(0.2)
    band_m = BAND_VOXELS * float(grid.voxel_m.max())
    half_diagonal = 0.5 * float(np.linalg.norm(grid.voxel_m))
    distance = band_distance(surface, grid, band_m)
    touched = distance <= half_diagonal
    if len(buried):
        touched |= np.isfinite(band_distance(buried, grid, half_diagonal))
    report(0.5)
    w = winding_on_grid(winding, grid, touched)
    report(0.8)
    if not winding.is_closed:
        distance = np.minimum(distance, band_distance(_closing_surface(w, grid), grid, band_m))
        _limit_at_crossings(distance, w, grid)
    inside_grid = _contains(grid, points)
    magnitude = _beyond_band(distance, grid, band_m, half_diagonal, inside_grid)
    report(1.0)
    return np.where(w > 0.5, -magnitude, magnitude).astype(np.float32)


def cleaned(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> tuple[Floats, Ints]:
    """Checked copies: equal vertices merged, faces without area dropped, facing outward as a whole.

    Raises
    ------
    SceneError
        See `signed_distance`.
    """
    points = np.asarray(vertices, dtype=np.float64)
    triangles = np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) == 0:
        raise SceneError("vertices", f"has shape {points.shape}", "give (V, 3) with at least three rows")
    if triangles.ndim != 2 or triangles.shape[1:] != (3,) or len(triangles) == 0:
        raise SceneError("faces", f"has shape {triangles.shape}", "give (F, 3) with at least one row")
    if not np.issubdtype(triangles.dtype, np.integer):
        raise SceneError("faces", f"is of type {triangles.dtype}", "give vertex indices")
    if not np.isfinite(points).all():
        raise SceneError("vertices", f"has {int((~np.isfinite(points)).any(axis=1).sum())} rows not finite")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise SceneError("faces", f"has indices outside 0..{len(points) - 1}")
    points, merged = np.unique(points, axis=0, return_inverse=True)
    triangles = merged.ravel()[triangles.astype(np.int64)]
    triangles = triangles[_has_area(points[triangles])]
    if len(triangles) == 0:
        raise SceneError("faces", "has no face with an area", "the mesh is made of points and lines only")
    return points, triangles[:, ::-1] if _volume(points[triangles]) < 0.0 else triangles


def _has_area(corners: Floats) -> npt.NDArray[np.bool_]:
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.sum(edges**2, axis=2).max(axis=1)
    doubled = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    return doubled > 1e-12 * longest


def _volume(corners: Floats) -> float:
    """Volume of the cones from the surface's centroid: the enclosed volume, also defined for open meshes."""
    doubled = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    centroid = np.average(corners.mean(axis=1), axis=0, weights=doubled)
    a, b, c = np.moveaxis(corners - centroid, 1, 0)
    return float(np.sum(a * np.cross(b, c)) / 6.0)


def _grid(shape: tuple[int, int, int], origin_m: npt.ArrayLike, voxel_m: npt.ArrayLike) -> Grid:
    if len(shape) != 3 or min(shape) < 1:
        raise SceneError("shape", f"is {tuple(shape)}", "give (Z, Y, X), each at least 1")
    origin = np.asarray(origin_m, dtype=np.float64)
    voxel = np.broadcast_to(np.asarray(voxel_m, dtype=np.float64), (3,))
    if origin.shape != (3,) or not np.isfinite(origin).all():
        raise SceneError("origin_m", f"is {origin_m!r}", "give three finite numbers")
    if not (np.isfinite(voxel).all() and (voxel > 0.0).all()):
        raise SceneError("voxel_m", f"is {voxel_m!r}", "give positive edges in metres")
    z, y, x = (int(n) for n in shape)
    return Grid((z, y, x), origin, voxel)


def _surface_parts(corners: Floats, winding: WindingNumber, voxel_m: float) -> tuple[Floats, Floats]:
    """Triangles that part inside from outside, and those that do not.

    A triangle is asked at four places on both sides; where they disagree it is halved, down to half a voxel.
    """
    kept, buried = [], []
    while len(corners):
        parting = _parts_space(corners, winding, 1e-3 * voxel_m)
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        mixed = parting.any(axis=1) & ~parting.all(axis=1) & (lengths.max(axis=1) > 0.5 * voxel_m)
        # The last of the four places is the middle; it decides for pieces too small to halve.
        surface = parting[:, 3]
        kept.append(corners[~mixed & surface])
        buried.append(corners[~mixed & ~surface])
        corners = halved(corners[mixed], lengths[mixed].argmax(axis=1))
    return np.concatenate(kept), np.concatenate(buried)


def _parts_space(corners: Floats, winding: WindingNumber, step_m: float) -> npt.NDArray[np.bool_]:
    places = np.array([[0.9, 0.05, 0.05], [0.05, 0.9, 0.05], [0.05, 0.05, 0.9], [1 / 3, 1 / 3, 1 / 3]])
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal *= step_m / np.linalg.norm(normal, axis=1)[:, None]
    middle = np.einsum("pc,tcx->tpx", places, corners)
    w = winding.of_neighbours(np.concatenate([middle - normal[:, None], middle + normal[:, None]], axis=1))
    return (w[:, :4] > 0.5) != (w[:, 4:] > 0.5)


def winding_on_grid(winding: WindingNumber, grid: Grid, touched: npt.NDArray[np.bool_]) -> npt.NDArray[np.float64]:
    """Winding number at voxel centres; interpolated in tiles where it is certainly on one side of 1/2.

    Away from the triangles w is harmonic and so takes its extremes on the border of a tile. A tile
    without triangles is settled by its eight corners if they are on one side of 1/2 by a margin that grows
    with their spread; all others are computed voxel by voxel.

    Parameters
    ----------
    touched : (Z, Y, X), true where a triangle may be within half a voxel diagonal.
    """
    corners = _tile_corners(winding, grid)
    low, high = corners.min(axis=1), corners.max(axis=1)
    margin = 0.1 + 0.5 * (high - low)
    settled = ((low > 0.5 + margin) | (high < 0.5 - margin)) & ~_tiles_touched(grid, touched)
    f = np.arange(TILE) / TILE
    line = np.stack([1.0 - f, f])
    weights = np.einsum("az,by,cx->abczyx", line, line, line).reshape(8, TILE**3)
    w = corners @ weights
    open_tiles = np.flatnonzero(~settled)
    first = grid.tile_first_m(open_tiles)
    w[open_tiles] = winding(first[:, None, :] + grid.tile_offsets_m)
    return grid.assemble(w)


def _tile_corners(winding: WindingNumber, grid: Grid) -> Floats:
    """(tiles, 8) winding numbers at the first voxels of a tile and of its upper neighbours."""
    lattice = Grid(
        tuple(n + 1 for n in grid.tiles),  # type: ignore[arg-type]
        grid.origin_m,
        grid.voxel_m * TILE,
    )
    every = np.arange(int(np.prod(lattice.tiles)))
    values = winding(lattice.tile_first_m(every)[:, None, :] + lattice.tile_offsets_m)
    w = lattice.assemble(values)
    z, y, x = grid.tiles
    parts = [w[a : a + z, b : b + y, c : c + x] for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    return np.stack(parts, axis=-1).reshape(-1, 8)


def _tiles_touched(grid: Grid, touched: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Whether a voxel of the tile, or of the next layer after it, is touched."""
    marked = touched
    for axis in range(3):
        lines = np.moveaxis(marked, axis, 0)
        count = grid.tiles[axis] * TILE
        padded = np.zeros((count + 1, *lines.shape[1:]), dtype=bool)
        padded[: len(lines)] = lines
        tiles = padded[:count].reshape(-1, TILE, *lines.shape[1:]).any(axis=1) | padded[TILE::TILE]
        marked = np.moveaxis(tiles, 0, axis)
    return marked.ravel()


def _closing_surface(w: Floats, grid: Grid) -> Floats:
    """Triangles of the level set w = 1/2 across the holes.

    Between two voxels on either side of a triangle w jumps by more than one half, between voxels that
    see each other past its open edge by less: by the angle of the step, as seen from the edge, over 2 pi.
    """
    if min(w.shape) < 2:
        return np.empty((0, 3, 3))
    vertices, faces = nets_in_voxels(0.5 - w, largest_step=0.5)
    corners = (grid.origin_m + vertices * grid.voxel_m)[faces].reshape(-1, 3, 3)
    return corners[_has_area(corners)] if len(corners) else corners


def _limit_at_crossings(distance: Floats, w: Floats, grid: Grid) -> None:
    """No voxel is farther from the surface than the crossing on its own edge.

    The meshed level set ends up to half a voxel short of the open edge; this bridges the gap.
    """
    for axis in range(3):
        voxel = float(grid.voxel_m[2 - axis])
        a, b = np.moveaxis(w, axis, 0)[:-1], np.moveaxis(w, axis, 0)[1:]
        lines = np.moveaxis(distance, axis, 0)
        apart = lines[:-1] + lines[1:] > voxel
        crossed = ((a > 0.5) != (b > 0.5)) & ((np.abs(a - b) < 0.5) | apart)
        reach = (0.5 - a[crossed]) / (b[crossed] - a[crossed]) * voxel
        lines[:-1][crossed] = np.minimum(lines[:-1][crossed], reach)
        lines[1:][crossed] = np.minimum(lines[1:][crossed], voxel - reach)


def _contains(grid: Grid, points: Floats) -> bool:
    last = grid.origin_m + (np.array(grid.shape[::-1]) - 1) * grid.voxel_m
    return bool((points >= grid.origin_m).all() and (points <= last).all())


def _beyond_band(distance: Floats, grid: Grid, band_m: float, half_diagonal: float, contained: bool) -> Floats:
    """Fill what the band leaves open with a lower bound.

    Every point of the surface has a voxel centre within half a diagonal, and that voxel is marked. So the
    distance to the nearest marked voxel, less half a diagonal, is at most the distance to the surface; it is
    also more than the band. A surface outside the grid is at least as far as the border.
    """
    from scipy.ndimage import distance_transform_edt

    marked = distance <= half_diagonal
    bound = np.full(grid.shape, np.inf)
    if marked.any():
        bound = distance_transform_edt(~marked, sampling=grid.voxel_m[::-1]) - half_diagonal
    if not contained or not marked.any():
        bound = np.minimum(bound, _to_border(grid))
    beyond = ~np.isfinite(distance)
    return np.where(beyond, np.maximum(bound, band_m), distance)


def _to_border(grid: Grid) -> Floats:
    lines = []
    for n, h in zip(grid.shape, grid.voxel_m[::-1], strict=True):
        index = np.arange(n)
        lines.append(np.minimum(index, n - 1 - index) * h)
    return np.minimum(np.minimum(lines[0][:, None, None], lines[1][:, None]), lines[2])
