"""Waves as arrays for the device, and the parameters of a body of water; no GPU."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.heightfield import slopes_of
from pellucid.surroundings.submersion import every_edge
from pellucid.techniques.water.layouts import WAVE_LAYERS, WaterParams
from pellucid.techniques.water.wave_moments import short_slopes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pellucid.scene.water import Water
    from pellucid.scene.water_quality import WaterQuality

NO_LAYERS: Mapping[int, Any] = MappingProxyType({})


@dataclass(frozen=True)
class WaveMaps:
    """The surface at a time, as the shaders read it.

    Attributes
    ----------
    texels : (L, H, W, 4) float32: height m, dh/dx, dh/dz, fold; a layer a source.
    tiles : (L, 4) float32: width and depth in metres, 1 where it repeats, 0.
    limits_m : lowest and highest sum of heights at any time.
    slope : steepest slope of the moment. cell_m : side of a texel of the finest layer.
    surfaces : what the sources gave. range_m : lowest and highest sum of heights of the moment, or beyond.
    """

    texels: np.ndarray
    tiles: np.ndarray
    limits_m: tuple[float, float]
    slope: float
    cell_m: float
    surfaces: tuple[Any, ...] = ()
    range_m: tuple[float, float] = (0.0, 0.0)


def sources_of(waves: Any) -> Sequence[Any]:
    """The layers of a source of waves: those that it adds up, or itself; none of a flat surface."""
    if waves is None:
        return ()
    return tuple(getattr(waves, "layers", (waves,)))


def surfaces_of(waves: Any, time_s: float, stand_ins: Mapping[int, Any] = NO_LAYERS) -> tuple[Any, ...]:
    """What each layer gives for a time: a `WaveSurface`, or heights alone.

    Parameters
    ----------
    stand_ins : what is asked in place of a layer, by its number.
    """
    sources = [stand_ins.get(n, source) for n, source in enumerate(sources_of(waves))]
    return tuple(s.surface(time_s) if hasattr(s, "surface") else s.advance(time_s) for s in sources)


def same_surfaces(a: tuple[Any, ...], b: tuple[Any, ...]) -> bool:
    """Whether nothing moved: sources give the same object as long as that is so."""
    return len(a) == len(b) and all(x is y for x, y in zip(a, b, strict=True))


def wave_maps(item: Water, surfaces: tuple[Any, ...]) -> WaveMaps:
    """The waves of a body of water as its sources gave them.

    Raises
    ------
    SceneError : too many layers, or heights that are not finite.
    """
    sources = sources_of(item.waves)
    if not sources:
        flat = np.zeros((1, 1, 1, 4), np.float32)
        flat[..., 3] = 1.0
        return WaveMaps(flat, np.array([[1.0, 1.0, 1.0, 0.0]], np.float32), (0.0, 0.0), 0.0, 1.0)
    if len(sources) > WAVE_LAYERS:
        raise SceneError("water.waves", f"are {len(sources)} layers", f"add up at most {WAVE_LAYERS}")
    rows, columns = (max(s.shape[axis] for s in sources) for axis in (0, 1))
    texels = np.empty((len(sources), rows, columns, 4), np.float32)
    tiles = np.array([[*s.tile_m, _repeats(s), 0.0] for s in sources], np.float32)
    limits = sum(float(s.limits_m[0]) for s in sources), sum(float(s.limits_m[1]) for s in sources)
    slope, low, high = 0.0, 0.0, 0.0
    for layer, source, surface in zip(texels, sources, surfaces, strict=True):
        heights = _fill(layer, source, surface)
        low, high = low + float(heights.min()), high + float(heights.max())
        slope += _steepest(heights, (source.tile_m[0] / columns, source.tile_m[1] / rows))
    cell = min(min(s.tile_m[0] / s.shape[1], s.tile_m[1] / s.shape[0]) for s in sources)
    return WaveMaps(texels, tiles, limits, slope, float(cell), surfaces, (low, high))


def _fill(texels: np.ndarray, source: Any, surface: Any) -> np.ndarray:
    """Write a layer (H, W, 4) of texels; gives its heights (H, W)."""
    heights = np.asarray(getattr(surface, "heights", surface), np.float32)
    if not np.isfinite(heights).all():
        raise SceneError("water.waves", "give heights that are not finite", "give finite heights in metres")
    slopes, fold = getattr(surface, "slopes", None), getattr(surface, "fold", None)
    if slopes is None:
        slopes = _slopes(heights, source)
    same = heights.shape == texels.shape[:2]
    out = texels if same else np.empty((*heights.shape, 4), np.float32)
    out[..., 0], out[..., 1], out[..., 2] = heights, slopes[..., 0], slopes[..., 1]
    out[..., 3] = 1.0 if fold is None else fold
    if same:
        return heights
    texels[...] = _resized(out, texels.shape[:2], _repeats(source))
    return np.ascontiguousarray(texels[..., 0])


def _resized(texels: np.ndarray, shape: tuple[int, ...], repeats: bool) -> np.ndarray:
    """Linear between the centres of texels, along both axes."""
    for axis, count in enumerate(shape):
        have = texels.shape[axis]
        at = (np.arange(count) + 0.5) * have / count - 0.5
        first = np.floor(at).astype(int)
        both = [(first + k) % have if repeats else np.clip(first + k, 0, have - 1) for k in (0, 1)]
        share = np.expand_dims(at - first, tuple(k for k in range(3) if k != axis)).astype(np.float32)
        texels = np.take(texels, both[0], axis) * (1.0 - share) + np.take(texels, both[1], axis) * share
    return texels


def _repeats(source: Any) -> bool:
    return bool(getattr(source, "periodic", getattr(source, "boundary", "periodic") == "periodic"))


def _steepest(heights: np.ndarray, cell_m: tuple[float, float]) -> float:
    """Bound of the slope of the surface that is linear along both axes between the centres of texels."""
    along_x, along_z = (
        np.abs(np.roll(heights, -1, axis) - heights) / cell for axis, cell in ((1, cell_m[0]), (0, cell_m[1]))
    )
    # Within a cell a slope along one axis lies between those of the two edges along it.
    either_x = np.maximum(along_x, np.roll(along_x, -1, 0))
    either_z = np.maximum(along_z, np.roll(along_z, -1, 1))
    return float(np.sqrt((either_x**2 + either_z**2).max()))


def _slopes(heights: np.ndarray, source: Any) -> np.ndarray:
    """(H, W, 2) dh/dx and dh/dz; z runs down the rows, v up."""
    cell = source.tile_m[0] / source.shape[1], source.tile_m[1] / source.shape[0]
    return slopes_of(heights, cell, _repeats(source)) * np.array([1.0, -1.0], np.float32)


def parameters(item: Water, quality: WaterQuality, waves: WaveMaps, time_s: float) -> np.ndarray:
    """() structured array of dtype `layouts.WaterParams`."""
    p = np.zeros((), WaterParams)
    p["low"], p["high"] = item.bounds_m
    p["center"], p["level"] = item.center, item.level
    p["wave_low"], p["wave_high"] = waves.limits_m
    p["trough"], p["crest"] = waves.range_m
    matter = item.matter
    p["n_water"] = matter.n_rgb if item.dispersion else np.full(3, matter.n_d)
    p["n_outside"] = item.ambient_n
    p["absorption"], p["scattering"] = matter.absorption_rgb_per_m, matter.scattering_rgb_per_m
    p["asymmetry"] = matter.asymmetry
    p["color"], p["clarity"], p["foam"] = item.color, item.clarity_per_m, item.foam
    p["wave_slope"], p["wave_cell_m"] = waves.slope, waves.cell_m
    p["schlick_power"] = quality.schlick_power
    p["steps"], p["march_steps"] = quality.steps, quality.march_steps
    p["point_distance_m"], p["underside_distance_m"] = quality.point_distance_m, quality.underside_distance_m
    p["short_slopes"] = short_slopes(sources_of(item.waves))
    shape = item.shape
    p["shape"] = *shape.bend, shape.depth_m, 0.0
    p["middle"], p["half"] = shape.middle, shape.half
    p["edges"] = every_edge(shape.edges)
    p["wave_layers"], p["time_s"] = len(waves.tiles), time_s
    p["wave_tiles"][: len(waves.tiles)] = waves.tiles
    return p
