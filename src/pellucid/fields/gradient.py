"""Gradients of voxel fields on the grid. Both estimates are exact on linear fields, borders included."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError


def central(field: npt.ArrayLike, voxel_m: tuple[float, float, float]) -> npt.NDArray[np.float32]:
    """Central differences inside, one-sided differences on the border.

    Parameters
    ----------
    field : (Z, Y, X).
    voxel_m : voxel edges (x, y, z) in metres.

    Returns
    -------
    (Z, Y, X, 3) float32 derivative along x, y, z, in field units per metre.

    Raises
    ------
    SceneError
        The field has not three axes, or a voxel edge is not positive.
    """
    values = _scalar_field(field, voxel_m)
    return _stack([_difference(values, axis, h) for axis, h in zip((2, 1, 0), voxel_m, strict=True)])


def sobel(field: npt.ArrayLike, voxel_m: tuple[float, float, float]) -> npt.NDArray[np.float32]:
    """Sobel's 3x3x3 gradient: a central difference, averaged (1, 2, 1)/4 along both other axes.

    Less noise and less direction dependence than `central`, for 27 samples in place of 6.
    Parameters, result and errors are those of `central`.
    """
    values = _scalar_field(field, voxel_m)
    parts = []
    for axis, h in zip((2, 1, 0), voxel_m, strict=True):
        across = [a for a in range(3) if a != axis]
        parts.append(_difference(_average(_average(values, across[0]), across[1]), axis, h))
    return _stack(parts)


def _scalar_field(field: npt.ArrayLike, voxel_m: tuple[float, float, float]) -> npt.NDArray[np.float64]:
    values = np.asarray(field, dtype=np.float64)
    if values.ndim != 3:
        raise SceneError("field", f"has shape {values.shape}", "give one scalar a voxel, (Z, Y, X)")
    if len(voxel_m) != 3 or not all(np.isfinite(h) and h > 0.0 for h in voxel_m):
        raise SceneError("voxel_m", f"is {voxel_m}", "give three positive edges in metres")
    return values


def _difference(values: npt.NDArray[np.float64], axis: int, h: float) -> npt.NDArray[np.float64]:
    if values.shape[axis] == 1:
        return np.zeros_like(values)
    return np.asarray(np.gradient(values, h, axis=axis, edge_order=1))


def _average(values: npt.NDArray[np.float64], axis: int) -> npt.NDArray[np.float64]:
    # Repeating the border shifts a linear field there by a constant, which a difference does not see.
    pad = [(1, 1) if a == axis else (0, 0) for a in range(3)]
    padded = np.moveaxis(np.pad(values, pad, mode="edge"), axis, 0)
    return np.moveaxis((padded[:-2] + 2.0 * padded[1:-1] + padded[2:]) / 4.0, 0, axis)


def _stack(parts: list[npt.NDArray[np.float64]]) -> npt.NDArray[np.float32]:
    return np.stack([p.astype(np.float32) for p in parts], axis=-1)
