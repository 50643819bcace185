"""Waves that come as an animated triangle mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import real_array
from pellucid.fields.waves import arguments
from pellucid.fields.waves.heights import between
from pellucid.fields.waves.source import Singles, WaveSource, WaveSurface, difference_slopes

MOST_PAIRS = 20_000_000  # cells that boxes of triangles cover

Array = npt.NDArray[Any]


class MeshWaves(WaveSource):
    """The surface of a triangle mesh, y up, as heights over x and z.

    Parameters
    ----------
    mesh : what has `vertices` (V, 3) and `faces` (F, 3), metres, or a pair of them; several in a row with `times_s`,
        alike in their faces, linear between them; or a function of the time in seconds that gives one.
    tile_m : size of the rectangle about x = z = 0 that the mesh covers. shape : (H, W) cells.
    times_s : (T,) of several meshes, rising.
    limits_m : lowest and highest height; must be given for a function.
    loop : the first mesh follows the last one.

    Raises
    ------
    SceneError : arrays that are no mesh; a mesh that is folded, so that it has two heights at one place, or stands
        upright; one that leaves cells of the tile open. When a time is asked for, too.
    """

    kind: ClassVar[str] = "mesh"
    periodic = False

    def __init__(
        self,
        mesh: Any,
        tile_m: float | tuple[float, float],
        shape: tuple[int, int] = (256, 256),
        times_s: npt.ArrayLike | None = None,
        limits_m: tuple[float, float] | None = None,
        loop: bool = False,
    ) -> None:
        self.shape = arguments.grid(shape, low=2)
        self._tile = arguments.tile(tile_m)
        self.loop = arguments.flag("loop", loop)
        self.function: Callable[[float], Any] | None = None
        self.meshes: tuple[tuple[Array, Array], ...] = ()
        self.times_s = np.zeros(1)
        if callable(mesh):
            self.function = mesh
            if limits_m is None:
                raise SceneError("limits_m", "are missing", "say how low and high the function's meshes ever are")
        else:
            self.meshes = _meshes(mesh)
            self._set_times(times_s)
        self._limits = self._own_limits() if limits_m is None else _limits(limits_m)
        self.surface(0.0)

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height, metres; heights beyond are cut off."""
        return self._limits

    def _surface(self, time_s: float) -> WaveSurface:
        if self.function is not None:
            ((vertices, faces),) = _meshes(self.function(time_s))
        else:
            first, second, share = between(self.times_s, time_s, self.loop)
            (vertices, faces), (following, _) = self.meshes[first], self.meshes[second]
            vertices = vertices + share * (following - vertices)
        heights = np.clip(heights_of(vertices, faces, self._tile, self.shape), *self._limits).astype(np.float32)
        return WaveSurface(heights, difference_slopes(heights, self.cell, False))

    def _key(self, time_s: float) -> Any:
        return time_s if self.function is not None else between(self.times_s, time_s, self.loop)

    def _own_limits(self) -> tuple[float, float]:
        heights = [vertices[:, 1] for vertices, _ in self.meshes]
        return float(min(h.min() for h in heights)), float(max(h.max() for h in heights))

    def _set_times(self, times_s: npt.ArrayLike | None) -> None:
        count = len(self.meshes)
        if times_s is None and count > 1:
            raise SceneError("times_s", f"are missing for {count} meshes", "say when each of them is")
        if times_s is not None:
            self.times_s = arguments.numbers("times_s", times_s, low=0.0)
        if len(self.times_s) != count or not (np.diff(self.times_s) > 0.0).all():
            raise SceneError("times_s", f"are {len(self.times_s)} for {count} meshes", "give one a mesh, rising")
        for _, faces in self.meshes[1:]:
            if not np.array_equal(faces, self.meshes[0][1]):
                raise SceneError("mesh", "changes its faces", "use the same faces at all times, or a function of time")


def heights_of(vertices: Array, faces: Array, tile_m: tuple[float, float], shape: tuple[int, int]) -> Singles:
    """(H, W) float32 heights of a mesh over the centres of cells of a tile about the origin.

    All pairs of a triangle and a cell of its box are made, those kept whose centre is inside by its barycentric
    coordinates.

    Raises
    ------
    SceneError : the mesh is folded or stands upright, or leaves cells open.
    """
    (rows, columns), size = shape, np.array(tile_m)
    corners = vertices[faces]
    at = (corners[..., ::2] / size + 0.5) * (columns, rows) - 0.5  # (F, 3, 2) columns and rows
    edges = at[:, 1:] - at[:, :1]
    doubled = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    _check_upright(doubled)
    low = np.clip(np.ceil(at.min(axis=1) - 1e-6), 0, (columns, rows)).astype(int)
    high = np.clip(np.floor(at.max(axis=1) + 1e-6), -1, (columns - 1, rows - 1)).astype(int)
    counts = np.maximum(high - low + 1, 0)
    number = counts[:, 0] * counts[:, 1]
    if number.sum() > MOST_PAIRS:
        raise SceneError("mesh", f"has {len(faces)} triangles that overlap {number.sum()} cells", "use fewer cells")
    face = np.repeat(np.arange(len(faces)), number)
    step = np.arange(len(face)) - np.repeat(np.cumsum(number) - number, number)
    column = low[face, 0] + step % np.maximum(counts[face, 0], 1)
    row = low[face, 1] + step // np.maximum(counts[face, 0], 1)
    x, z = column - at[face, 0, 0], row - at[face, 0, 1]
    second = (x * edges[face, 1, 1] - z * edges[face, 1, 0]) / doubled[face]
    third = (z * edges[face, 0, 0] - x * edges[face, 0, 1]) / doubled[face]
    inside = (second >= -1e-6) & (third >= -1e-6) & (second + third <= 1.0 + 1e-6)
    y, cell = corners[..., 1], (row * columns + column)[inside]
    height = y[face, 0] + second * (y[face, 1] - y[face, 0]) + third * (y[face, 2] - y[face, 0])
    return _gathered(cell, height[inside], rows * columns).reshape(shape)


def _gathered(cell: Array, height: Array, count: int) -> Singles:
    """Heights by cell; where several triangles meet they have to agree."""
    highest, lowest = np.full(count, -np.inf), np.full(count, np.inf)
    np.maximum.at(highest, cell, height)
    np.minimum.at(lowest, cell, height)
    missing = int(np.isinf(highest).sum())
    if missing:
        raise SceneError("mesh", f"leaves {missing} of {count} cells open", "close it, or use a smaller tile_m")
    spread = float(np.abs(height).max()) if height.size else 0.0
    twice = int((highest - lowest > 1e-4 * max(spread, 1e-6)).sum())
    if twice:
        raise SceneError("mesh", f"is folded: it has two heights over {twice} cells", "give one height for each place")
    return np.asarray(highest, np.float32)


def _check_upright(doubled: Array) -> None:
    """Triangles seen from above must all turn the same way round."""
    flat = np.abs(doubled) < 1e-12
    if flat.any():
        raise SceneError("mesh", f"has {int(flat.sum())} triangles that stand upright or are empty", "leave them out")
    turned = min(int((doubled > 0.0).sum()), int((doubled < 0.0).sum()))
    if turned:
        raise SceneError("mesh", f"is folded: {turned} triangles lie upside down", "give one height for each place")


def _meshes(given: Any) -> tuple[tuple[Array, Array], ...]:
    if hasattr(given, "vertices") and hasattr(given, "faces"):
        return (_mesh(given.vertices, given.faces),)
    if not isinstance(given, Sequence) or isinstance(given, str) or not given:
        raise SceneError("mesh", f"is {type(given).__name__}", "give vertices and faces, several, or a function")
    if len(given) == 2 and not hasattr(given[0], "faces") and not isinstance(given[0], tuple):
        return (_mesh(*given),)
    return tuple(one for item in given for one in _meshes(item))


def _mesh(vertices: Any, faces: Any) -> tuple[Array, Array]:
    v, f = real_array("mesh.vertices", vertices).astype(np.float64), real_array("mesh.faces", faces)
    if v.ndim != 2 or v.shape[1:] != (3,) or not len(v) or not np.isfinite(v).all():
        raise SceneError("mesh.vertices", f"have shape {v.shape}", "give (V, 3) finite places in metres")
    if f.ndim != 2 or f.shape[1:] != (3,) or not len(f) or f.dtype.kind not in "iu":
        raise SceneError("mesh.faces", f"have shape {f.shape}", "give (F, 3) whole numbers")
    if f.min() < 0 or f.max() >= len(v):
        raise SceneError("mesh.faces", f"name the vertices {f.min()} to {f.max()}", f"there are 0 to {len(v) - 1}")
    return v, f


def _limits(value: Any) -> tuple[float, float]:
    parts = arguments.numbers("limits_m", value)
    if len(parts) != 2 or parts[0] > parts[1]:
        raise SceneError("limits_m", f"are {value!r}", "give (lowest, highest)")
    return float(parts[0]), float(parts[1])
