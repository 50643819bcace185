"""From waves that move water sideways to heights over places: x = x0 + D(x0) turned round."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.fields.waves.source import PART, Singles, bilinear

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


def grid_origins(
    move_x: Singles, move_z: Singles, cell: tuple[float, float], gradients: tuple[Array, Array, Array]
) -> tuple[Singles, Singles]:
    """Columns and rows where the water of each cell of a periodic grid comes from; x0 - x = -D(x0), by and by.

    Moves of less than a cell are turned round with the gradient at the cell itself, twice: what is left is of the
    third order. Else steps go three quarters of the way, so that they end where waves nearly fold, and the first ones
    are taken on every other row and column: a move bends little over two cells.

    Parameters
    ----------
    move_x, move_z : (H, W) D_x, D_z in metres at cell centres, H and W even.
    gradients : (H, W) each, dD_x/dx, dD_z/dz, dD_x/dz, which is also dD_z/dx.
    """
    planes = move_x / np.float32(cell[0]), move_z / np.float32(cell[1])
    rows, columns = move_x.shape
    column, row = np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)[:, None]
    if max(float(plane.max()) for plane in planes) < 1.0 and min(float(plane.min()) for plane in planes) > -1.0:
        return _near_origins(planes, column, row, gradients, cell)
    back = [-plane[::2, ::2] for plane in planes]
    for _ in range(7):
        back = _nearer(planes, column[::2], row[::2], back)
    back = _nearer(planes, column, row, [_twice_as_fine(part) for part in back])
    return column + back[0], row + back[1]


def _near_origins(planes: Any, column: Singles, row: Singles, gradients: Any, cell: Any) -> tuple[Singles, Singles]:
    """Two steps of Newton's method, both with the gradient where the first one starts."""
    found = np.empty((2, *planes[0].shape), np.float32)
    across = np.float32(cell[1] / cell[0]), np.float32(cell[0] / cell[1])
    for start in range(0, len(row), step := max(1, PART // column.size)):
        part = slice(start, start + step)
        xx, zz, xz = (gradient[part] for gradient in gradients)
        a, b = 1.0 + xx, 1.0 + zz
        share = 1.0 / np.maximum(a * b - xz * xz, LEAST_FOLD)
        a, b, c = share * a, share * b, share * xz
        c_x, c_z = c * across[0], c * across[1]
        d_x, d_z = (plane[part] for plane in planes)
        x, z = column - b * d_x + c_x * d_z, row[part] - a * d_z + c_z * d_x
        d_x, d_z = bilinear(planes, x, z, True)
        d_x += x - column
        d_z += z - row[part]
        found[0, part] = x - b * d_x + c_x * d_z
        found[1, part] = z - a * d_z + c_z * d_x
    return found[0], found[1]


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
