"""From a `ReliefSurface` to arrays: maps of one size with their blurred levels, and the hull."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pellucid.fields.heightfield import bounds_pyramid
from pellucid.surroundings.resample import area_resample
from pellucid.techniques.relief.frames import Hull, hull_of

if TYPE_CHECKING:
    from pellucid.scene import ReliefLayer, ReliefSurface

MARGIN = 1e-3  # of the range of heights, by which the hull lies outside of them
SOLID_ROUGHNESS, TRANSLUCENT_ROUGHNESS = 0.6, 0.05  # unless the layer says


@dataclass(frozen=True)
class Maps:
    """What the layers are made of.

    Attributes
    ----------
    heights : (H, W, 2) float32 metres, solid and translucent. low, high : their extremes (2,).
    bounds : levels of ``fields.heightfield.bounds_pyramid``.
    solid, translucent : levels of slopes (h, w, 2), metres a metre of the nominal tile.
    colors : levels (h, w, 3), linear.
    """

    heights: np.ndarray
    low: np.ndarray
    high: np.ndarray
    bounds: list[np.ndarray]
    solid: list[np.ndarray]
    translucent: list[np.ndarray]
    colors: list[np.ndarray]


def roughness_of(layer: ReliefLayer | None, unless_given: float) -> float:
    """What a layer says, or else what its kind has."""
    return unless_given if layer is None or layer.roughness is None else layer.roughness


def hull(item: ReliefSurface) -> Hull:
    """The hull of a surface in its own coordinates, scaled, so that lengths are metres of the world."""
    vertices, faces, normals, uvs = _geometry(item)
    return hull_of(vertices, faces, normals, uvs * tiles_of(item))


def tiles_of(item: ReliefSurface) -> np.ndarray:
    """Tiles along u and v for each unit of the mesh's texture coordinates, (2,)."""
    if item.tile_m is None:
        return np.asarray(item.tiles, np.float64)
    return np.asarray(hull_of(*_geometry(item)).tile_m) / np.asarray(item.tile_m)


def _geometry(item: ReliefSurface) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    mesh = item.mesh
    vertices = item.scale * np.asarray(mesh.vertices, np.float64)
    return vertices, np.asarray(mesh.faces), np.asarray(mesh.normals, np.float64), np.asarray(mesh.uvs, np.float64)


def maps(
    item: ReliefSurface,
    tile_m: tuple[float, float],
    exact: bool = True,
    time_s: float = 0.0,
    before: Maps | None = None,
) -> Maps:
    """The maps of a surface whose tiles are `tile_m` metres large in the mean.

    Parameters
    ----------
    exact : keep heights in 32 bits; else in halves.
    time_s : of heights that move. before : maps of the same surface at another time; what rests is taken from them.
    """
    solid, translucent = item.solid, item.translucent
    both = [solid] if translucent is None else [solid, translucent]
    layers = [layer.heights_at(time_s) for layer in both]
    size = (max(h.shape[0] for h in layers), max(h.shape[1] for h in layers))
    layers = [resized_heights(h, size, item.tiling) for h in layers]
    if not exact:  # bounds must hold for the heights that are drawn
        layers = [np.asarray(h, np.float16).astype(np.float64) for h in layers]
    upper = layers[1] if translucent is not None else layers[0] - 1.0
    heights = np.stack([layers[0], upper], axis=-1).astype(np.float32)
    limits = [(float(h.min()), float(h.max())) for h in (layers[0], upper)]
    for k, layer in enumerate(both):
        if layer.is_dynamic:
            limits[k] = layer.limits_m
    return Maps(
        heights,
        np.array([low for low, _ in limits]),
        np.array([high for _, high in limits]),
        bounds_pyramid(layers[0], upper if translucent is not None else None, item.tiling),
        before.solid if before and not solid.is_dynamic else levels(_slopes(solid, tile_m, item.tiling, time_s)),
        _upper_slopes(item, tile_m, time_s, before),
        before.colors if before else levels(_colors(solid)),
    )


def _upper_slopes(
    item: ReliefSurface, tile_m: tuple[float, float], time_s: float, before: Maps | None
) -> list[np.ndarray]:
    if item.translucent is None:
        return [np.zeros((1, 1, 2), np.float32)]
    if before and not item.translucent.is_dynamic:
        return before.translucent
    return levels(_slopes(item.translucent, tile_m, item.tiling, time_s))


def _colors(layer: ReliefLayer) -> np.ndarray:
    return np.asarray(layer.colors if isinstance(layer.colors, np.ndarray) else np.ones((1, 1, 3)), np.float32)


def _slopes(layer: ReliefLayer, tile_m: tuple[float, float], tiling: bool, time_s: float) -> np.ndarray:
    height, width = layer.heights.shape
    return np.asarray(layer.slopes((tile_m[0] / width, tile_m[1] / height), tiling, time_s), np.float32)


def levels(image: np.ndarray) -> list[np.ndarray]:
    """(H, W, C) and its means over twice, four times ... as large texels, down to one."""
    found = [np.ascontiguousarray(image, np.float32)]
    while max(found[-1].shape[:2]) > 1:
        height, width = found[-1].shape[:2]
        found.append(area_resample(found[-1], (max(height // 2, 1), max(width // 2, 1))))
    return found


def resized_heights(heights: np.ndarray, size: tuple[int, int], tiling: bool) -> np.ndarray:
    """Heights of another number of texels, bilinear between texel centres: (H, W) to `size`."""
    out = np.asarray(heights, np.float64)
    for axis, count in enumerate(size):
        old = out.shape[axis]
        if old == count:
            continue
        at = (np.arange(count) + 0.5) * old / count - 0.5
        first = np.floor(at).astype(int)
        share = (at - first).reshape([-1 if k == axis else 1 for k in range(2)])
        pair = [k % old if tiling else np.clip(k, 0, old - 1) for k in (first, first + 1)]
        out = (1.0 - share) * out.take(pair[0], axis) + share * out.take(pair[1], axis)
    return out
