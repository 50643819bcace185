"""Several kinds of waves on one water."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.waves import arguments
from pellucid.fields.waves.disturbances import Disturbance, Push
from pellucid.fields.waves.ripples import Ripples
from pellucid.fields.waves.source import WaveSource, WaveSurface, bilinear

#: Most layers that water adds up.
MOST_LAYERS = 8


class Sum(WaveSource):
    """Waves added up, each on its own tile and grid, such as an Ocean and Ripples.

    Water shows each layer with its own tile. The grid of the sum itself is that of the layer that does not repeat, or
    else of the largest tile, in the cells of the finest layer; `LARGEST` at most a side.

    Parameters
    ----------
    layers : sources of waves, or sums of them.

    Raises
    ------
    SceneError : no layers, too many, or something else; layers that do not repeat on tiles of different sizes.
    """

    kind: ClassVar[str] = "sum"

    def __init__(self, *layers: WaveSource) -> None:
        flat: list[WaveSource] = []
        for layer in layers:
            flat += layer.layers if isinstance(layer, Sum) else [layer]
        wrong = [type(layer).__name__ for layer in flat if not isinstance(layer, WaveSource)]
        if wrong:
            raise SceneError("layers", f"hold {wrong[0]!r}", "add up sources of pellucid.waves")
        if not 1 <= len(flat) <= MOST_LAYERS:
            raise SceneError("layers", f"are {len(flat)}", f"give 1 to {MOST_LAYERS}")
        self.layers: tuple[WaveSource, ...] = tuple(flat)
        bounded = [layer for layer in flat if not layer.periodic]
        largest = max(bounded or flat, key=lambda layer: layer.tile_m[0] * layer.tile_m[1])
        if any(not np.allclose(layer.tile_m, largest.tile_m) for layer in bounded):
            sizes = ", ".join(str(layer.tile_m) for layer in bounded)
            raise SceneError("layers", f"that do not repeat have tiles of {sizes} m", "give them the same tile_m")
        self._tile = largest.tile_m
        self.periodic = not bounded and all(_fits(layer.tile_m, self._tile) for layer in flat)
        cells = [min(layer.cell[axis] for layer in flat) for axis in (0, 1)]
        columns, rows = (int(np.ceil(t / c - 1e-6)) for t, c in zip(self._tile, cells, strict=True))
        self.shape = min(rows, arguments.LARGEST), min(columns, arguments.LARGEST)

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height, metres."""
        low, high = (sum(layer.limits_m[side] for layer in self.layers) for side in (0, 1))
        return low, high

    @property
    def steepest(self) -> float | None:
        """Steepest slope that is to be expected, None where that of a layer is not known beforehand."""
        slopes = [layer.steepest for layer in self.layers]
        return None if None in slopes else sum(slope for slope in slopes if slope is not None)

    @property
    def short_slopes(self) -> tuple[float, float, float]:
        """Mean squares of slopes of the waves that are too short for the grids."""
        xx, xz, zz = (sum(layer.short_slopes[n] for layer in self.layers) for n in range(3))
        return xx, xz, zz

    def drop(self, *given: Any, **named: Any) -> Disturbance:
        """Something falls into the water; see `Ripples.drop`."""
        return ripples_of(self).drop(*given, **named)

    def push(self, *given: Any, **named: Any) -> Push:
        """Something floats along a path; see `Ripples.push`."""
        return ripples_of(self).push(*given, **named)

    def _surface(self, time_s: float) -> WaveSurface:
        x, z = self.centres()
        heights = np.zeros(self.shape, np.float32)
        slopes, fold = np.zeros((*self.shape, 2), np.float32), np.ones(self.shape, np.float32)
        for layer in self.layers:
            found = layer.surface(time_s)
            planes = [found.heights, found.slopes[..., 0], found.slopes[..., 1]]
            planes += [] if found.fold is None else [found.fold]
            if not (layer.shape == self.shape and layer.tile_m == self._tile):
                planes = bilinear(planes, *layer.places(x, z[:, None]), layer.periodic)
            heights += planes[0]
            slopes[..., 0] += planes[1]
            slopes[..., 1] += planes[2]
            if found.fold is not None:
                fold += planes[3] - 1.0
        folds = any(layer.surface(time_s).fold is not None for layer in self.layers)
        return WaveSurface(heights, slopes, fold if folds else None)

    def _key(self, time_s: float) -> Any:
        return tuple(layer._key(time_s) for layer in self.layers)


def ripples_of(source: Any) -> Ripples:
    """The Ripples among waves.

    Raises
    ------
    SceneError : there are none.
    """
    for layer in getattr(source, "layers", (source,)):
        if isinstance(layer, Ripples):
            return layer
    raise SceneError("waves", "have no Ripples", "add them: Sum(waves, Ripples(...))")


def _fits(small: tuple[float, float], large: tuple[float, float]) -> bool:
    """Whether tiles fill a larger one a whole number of times."""
    times = np.array(large) / np.array(small)
    return bool(np.allclose(times, np.round(times), rtol=1e-6))
