"""From waves that move water sideways to heights over places: x = x0 + D(x0) turned round."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.fields.waves.source import Singles, bilinear

Array = npt.NDArray[Any]

#: Least Jacobian that a step divides by: where water folds there is no one place that it comes from.
LEAST_FOLD = 0.25
STEPS = 12

Displacements = Callable[[Array, Array], tuple[Array, ...]]


def origins(displaced: Displacements, x: Array, z: Array, enough_m: float, steps: int = STEPS) -> tuple[Array, Array]:
    """(x0, z0) that D moves to x, z: x0 is put to x - D(x0) again and again [fournier1986], divided by 1 + grad D.

    Parameters
    ----------
    displaced : of x0, z0: D_x, D_z, dD_x/dx, dD_z/dz, dD_x/dz, which is also dD_z/dx, metres and 1.
    x, z : (...) metres. enough_m : steps end when all places are as near.
    """
    x0, z0 = x, z
    for _ in range(steps):
        d_x, d_z, xx, zz, xz = displaced(x0, z0)
        r_x, r_z = x - x0 - d_x, z - z0 - d_z
        share = 1.0 / np.maximum((1.0 + xx) * (1.0 + zz) - xz * xz, LEAST_FOLD)
        x0 = x0 + share * ((1.0 + zz) * r_x - xz * r_z)
        z0 = z0 + share * ((1.0 + xx) * r_z - xz * r_x)
        if max(float(np.abs(r_x).max()), float(np.abs(r_z).max())) < enough_m:
            break
    return x0, z0


def moved_slopes(slope_x: Array, slope_z: Array, xx: Array, zz: Array, xz: Array) -> tuple[Array, Array, Array]:
    """Slopes over places of heights whose slopes over x0 are given, (I + grad D)^-1 grad h, and the Jacobian.

    Where it is below `LEAST_FOLD` the slopes are those of that Jacobian: a fold has no slope.
    """
    a, b = 1.0 + xx, 1.0 + zz
    fold = a * b - xz * xz
    share = 1.0 / np.maximum(fold, LEAST_FOLD)
    return share * (b * slope_x - xz * slope_z), share * (a * slope_z - xz * slope_x), fold


def grid_origins(move_x: Singles, move_z: Singles, cell: tuple[float, float]) -> tuple[Singles, Singles]:
    """Columns and rows where the water of each cell of a periodic grid comes from; x0 - x = -D(x0), by and by.

    Steps go three quarters of the way, so that they end where waves nearly fold. The first ones are taken on every
    other row and column: a move bends little over two cells.

    Parameters
    ----------
    move_x, move_z : (H, W) D_x, D_z in metres at cell centres, H and W even.
    """
    planes = move_x / np.float32(cell[0]), move_z / np.float32(cell[1])
    rows, columns = move_x.shape
    column, row = np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)[:, None]
    back = [-plane[::2, ::2] for plane in planes]
    for _ in range(7):
        back = _nearer(planes, column[::2], row[::2], back)
    back = _nearer(planes, column, row, [_twice_as_fine(part) for part in back])
    return column + back[0], row + back[1]


def _nearer(planes: Any, column: Singles, row: Singles, back: list[Singles]) -> list[Singles]:
    moves = bilinear(planes, column + back[0], row + back[1], True)
    return [np.float32(0.25) * old - np.float32(0.75) * new for old, new in zip(back, moves, strict=True)]


def _twice_as_fine(plane: Singles) -> Singles:
    """(2 H, 2 W) linear between the values of a periodic plane, which are those of its even rows and columns."""
    rows, columns = plane.shape
    fine = np.empty((2 * rows, 2 * columns), np.float32)
    fine[::2, ::2] = plane
    fine[::2, 1::2] = 0.5 * (plane + np.roll(plane, -1, 1))
    fine[1::2] = 0.5 * (fine[::2] + np.roll(fine[::2], -1, 0))
    return fine
