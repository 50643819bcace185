"""What every kind of waves gives: heights, and the slopes that belong to them, at a time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.fields.waves import arguments

#: Places that are looked up at once.
PART = 16384

Singles = npt.NDArray[np.float32]
Array = npt.NDArray[Any]


@dataclass(frozen=True, eq=False)
class WaveSurface:
    """A water surface at one time, on a grid of cell centres.

    Attributes
    ----------
    heights : (H, W) float32, metres.
    slopes : (H, W, 2) float32, dh/dx and dh/dz.
    fold : (H, W) float32, area of a patch of water over its area at rest, the Jacobian of the horizontal displacement
        [tessendorf2001, 4.6]: 1 for calm water, small at crests, negative where waves break. None: 1 everywhere.
    """

    heights: Singles
    slopes: Singles
    fold: Singles | None = None

    def __post_init__(self) -> None:
        for array in (self.heights, self.slopes, self.fold):
            if array is not None:
                array.setflags(write=False)  # the same surface is given to everyone who asks

    @property
    def normals(self) -> Singles:
        """(H, W, 3) float32 unit vectors (-dh/dx, 1, -dh/dz) / length."""
        up = np.ones(self.heights.shape, np.float32)
        n = np.stack([-self.slopes[..., 0], up, -self.slopes[..., 1]], axis=-1)
        return np.asarray(n / np.linalg.norm(n, axis=-1, keepdims=True))


class WaveSource(ABC):
    """Water in motion over a rectangle, `fields.dynamic.DynamicHeights`.

    x and z are metres from its middle, x along the rows and z down them: the cell (j, i) has its centre at
    x = (i + 1/2) W_m / W - W_m / 2, likewise z. What is given for a time does not depend on the times asked before.

    Attributes
    ----------
    shape : (H, W) cells. tile_m : (along x, along z), metres.
    periodic : whether waves go on beyond the rectangle as on its other side; else they stay as at its border.
    """

    kind: ClassVar[str] = ""
    shape: tuple[int, int]
    periodic: bool

    _tile: tuple[float, float]
    _kept: tuple[Any, WaveSurface] | None = None

    @property
    def tile_m(self) -> tuple[float, float]:
        """Size along x and z, metres."""
        return self._tile

    @property
    @abstractmethod
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height that is ever given, metres."""

    @property
    def steepest(self) -> float | None:
        """Steepest slope that is to be expected at any time, None where that is not known beforehand."""
        return None

    @property
    def short_slopes(self) -> tuple[float, float, float]:
        """Mean squares (dh/dx)^2, dh/dx dh/dz, (dh/dz)^2 of the waves that are too short for the grid."""
        return 0.0, 0.0, 0.0

    @property
    def cell(self) -> tuple[float, float]:
        """Edges of a cell along x and z, metres."""
        width, depth = self.tile_m
        return width / self.shape[1], depth / self.shape[0]

    def surface(self, time_s: float) -> WaveSurface:
        """Heights and slopes at a time, seconds from the start; the same object as long as nothing changes.

        Raises
        ------
        SceneError : the time is negative or not finite.
        """
        key = self._key(arguments.moment(time_s))
        if self._kept is None or self._kept[0] != key:
            self._kept = key, self._surface(float(time_s))
        return self._kept[1]

    def advance(self, time_s: float) -> Singles:
        """(H, W) float32 heights at a time, metres."""
        return self.surface(time_s).heights

    def at(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike, time_s: float) -> tuple[Singles, Singles]:
        """Height (...) and slopes (..., 2) at places (...), bilinear between cell centres; what floats asks this.

        Parameters
        ----------
        x_m, z_m : metres from the middle.
        """
        found = self.surface(time_s)
        planes = (found.heights, found.slopes[..., 0], found.slopes[..., 1])
        heights, along_x, along_z = bilinear(planes, *self.places(x_m, z_m), self.periodic)
        return heights, np.stack([along_x, along_z], axis=-1)

    def places(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> tuple[Array, Array]:
        """Columns and rows, whole at the centres of cells, of places in metres from the middle."""
        (width, depth), (rows, columns) = self.tile_m, self.shape
        x, z = np.asarray(x_m), np.asarray(z_m)
        return (x / width + 0.5) * columns - 0.5, (z / depth + 0.5) * rows - 0.5

    def centres(self) -> tuple[Array, Array]:
        """(W,) x and (H,) z of the centres of cells, metres from the middle."""
        (width, depth), (rows, columns) = self.tile_m, self.shape
        return ((np.arange(columns) + 0.5) / columns - 0.5) * width, ((np.arange(rows) + 0.5) / rows - 0.5) * depth

    @abstractmethod
    def _surface(self, time_s: float) -> WaveSurface:
        """What `surface` gives, worked out anew."""

    def _key(self, time_s: float) -> Any:
        """What decides whether the last surface is still true."""
        return time_s


def difference_slopes(heights: Array, cell: tuple[float, float], periodic: bool) -> Singles:
    """(H, W, 2) central differences of heights (H, W), one-sided at a border that does not repeat."""
    slopes = np.empty((*heights.shape, 2), np.float32)
    for axis in (1, 0):
        h, out = np.moveaxis(heights, axis, 0), np.moveaxis(slopes[..., 1 - axis], axis, 0)
        np.subtract(h[2:], h[:-2], out=out[1:-1], casting="same_kind")
        if periodic:
            out[0], out[-1] = h[1] - h[-1], h[0] - h[-2]
        else:
            out[0], out[-1] = 2.0 * (h[1] - h[0]), 2.0 * (h[-1] - h[-2])
    slopes *= np.array([0.5 / cell[0], 0.5 / cell[1]], np.float32)
    return slopes


def bilinear(planes: Sequence[Array], column: Array, row: Array, periodic: bool) -> list[Singles]:
    """(...) values between the centres of cells, of each of several (H, W) planes, at (...) columns and rows.

    Plane by plane: NumPy is ten times as slow with the channels innermost. Part by part: what is in between stays in
    the cache then, and no fresh memory is asked for again and again.
    """
    shape = np.broadcast_shapes(np.shape(column), np.shape(row))
    found = [np.empty(shape, np.float32) for _ in planes]
    if not shape:
        _bilinear(planes, column, row, periodic, found)
        return found
    step = max(1, PART * shape[0] // max(1, int(np.prod(shape))))
    for start in range(0, shape[0], step):
        part = slice(start, start + step)
        x, z = (c[part] if c.ndim == len(shape) and c.shape[0] == shape[0] else c for c in (column, row))
        _bilinear(planes, x, z, periodic, [plane[part] for plane in found])
    return found


def _bilinear(planes: Sequence[Array], column: Array, row: Array, periodic: bool, found: list[Singles]) -> None:
    rows, columns = planes[0].shape
    i, j = np.floor(column), np.floor(row)
    a, b = (np.asarray(part, np.float32) for part in (column - i, row - j))
    left, right = _lines(i.astype(np.intp), columns, periodic)
    top, bottom = (line * columns for line in _lines(j.astype(np.intp), rows, periodic))
    corners = [first + second for first in (top, bottom) for second in (left, right)]
    for plane, out in zip(planes, found, strict=True):
        # Indices are inside: "wrap" only spares NumPy a copy that it makes for the case that they are not.
        flat = plane.reshape(-1)
        upper, upper_right, lower, lower_right = (np.asarray(flat.take(at, mode="wrap")) for at in corners)
        for here, next_to in ((upper, upper_right), (lower, lower_right)):
            next_to -= here
            next_to *= a
            here += next_to
        lower -= upper
        lower *= b
        np.add(upper, lower, out=out)


def _lines(first: Array, count: int, periodic: bool) -> tuple[Array, Array]:
    """Numbers of two neighbouring rows or columns that there are."""
    if not periodic:
        return np.clip(first, 0, count - 1), np.clip(first + 1, 0, count - 1)
    if count & (count - 1) == 0:
        return first & (count - 1), (first + 1) & (count - 1)
    return np.remainder(first, count), np.remainder(first + 1, count)
