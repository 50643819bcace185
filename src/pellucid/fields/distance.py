"""How far a ray may go in one straight step: the distance to the nearest place where a field changes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError


def homogeneous_distance(
    fields: Sequence[npt.ArrayLike],
    voxel_m: tuple[float, float, float],
    tolerance: float | Sequence[float] = 0.0,
) -> npt.NDArray[np.float32]:
    """Radius around each voxel centre in which trilinear interpolation of every field is constant.

    A trilinear interpolant can change only inside a cell (the cube between eight voxel centres)
    whose corners differ. Such cells are grown by one voxel on each side and the Euclidean distance
    to them is taken. The nearest point of a box with corners on the lattice, seen from a lattice
    point, is a lattice point, so the distance to marked voxels is the exact distance to the boxes.
    Growing makes the radius valid for **any** point of the eight cells around a voxel; hence also a
    trilinear look-up of the result at any x is at most the true radius at x.

    Parameters
    ----------
    fields : arrays (Z, Y, X) or (Z, Y, X, C), all of one grid.
    voxel_m : voxel edges (x, y, z) in metres.
    tolerance : differences within a cell up to this count as none; one number, or one for each
        field. With 0 the radius is rigorous; otherwise a field may drift by `tolerance` a cell.

    Returns
    -------
    (Z, Y, X) float32 in metres, 0 where inhomogeneous, at most the diagonal of the grid.

    Raises
    ------
    SceneError
        No field, shapes that differ, a value that is not finite, or a negative tolerance.
    """
    from scipy.ndimage import distance_transform_edt

    arrays = [np.asarray(f) for f in fields]
    tolerances = _checked(arrays, tolerance)
    shape = arrays[0].shape[:3]
    changing = np.zeros(tuple(max(n - 1, 1) for n in shape), dtype=bool)
    for values, allowed in zip(arrays, tolerances, strict=True):
        changing |= _cell_range(values) > allowed
    diagonal = float(np.linalg.norm(np.array(shape[::-1]) * np.asarray(voxel_m)))
    if not changing.any():
        return np.full(shape, diagonal, dtype=np.float32)
    radius = distance_transform_edt(~_grown(changing, shape), sampling=tuple(voxel_m)[::-1])
    # Rounding to float32 must not round up.
    return np.nextafter(radius.astype(np.float32), np.float32(0.0))


def _checked(arrays: list[npt.NDArray], tolerance: float | Sequence[float]) -> list[float]:
    if not arrays:
        raise SceneError("fields", "is empty", "give at least one field")
    shape = arrays[0].shape[:3]
    for i, values in enumerate(arrays):
        if values.ndim not in (3, 4) or values.shape[:3] != shape:
            raise SceneError(f"fields[{i}]", f"has shape {values.shape}, the first has {shape}")
        if not np.isfinite(values).all():
            raise SceneError(f"fields[{i}]", "has values that are not finite")
    allowed = [float(t) for t in np.broadcast_to(np.asarray(tolerance, dtype=float), (len(arrays),))]
    if not all(t >= 0.0 for t in allowed):
        raise SceneError("tolerance", f"is {tolerance}", "use 0 or more")
    return allowed


def _cell_range(values: npt.NDArray) -> npt.NDArray:
    """Largest minus smallest of the eight corners of every cell (over channels: the worst)."""
    low = high = values
    for axis in range(3):
        if values.shape[axis] > 1:
            low = np.minimum(_but_last(low, axis), _but_first(low, axis))
            high = np.maximum(_but_last(high, axis), _but_first(high, axis))
    spread = high - low
    return spread if spread.ndim == 3 else spread.max(axis=3)


def _but_last(values: npt.NDArray, axis: int) -> npt.NDArray:
    return np.take(values, range(values.shape[axis] - 1), axis=axis)


def _but_first(values: npt.NDArray, axis: int) -> npt.NDArray:
    return np.take(values, range(1, values.shape[axis]), axis=axis)


def _grown(cells: npt.NDArray[np.bool_], shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Voxels in cells grown by one voxel: cell i spans voxels i..i+1, so i-1..i+2 are marked."""
    marked = cells
    for axis in range(3):
        n = shape[axis]
        lines = np.moveaxis(marked, axis, 0)
        out = np.zeros((n + 3, *lines.shape[1:]), dtype=bool)
        for shift in range(4):
            out[shift : shift + lines.shape[0]] |= lines
        marked = np.moveaxis(out[1 : n + 1], 0, axis)
    return marked
