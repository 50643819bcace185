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


def hull(item: ReliefSurface) -> Hull:
    """The hull of a surface in its own coordinates, scaled, so that lengths are metres of the world."""
    mesh = item.mesh
    vertices = item.scale * np.asarray(mesh.vertices, np.float64)
    faces, normals = np.asarray(mesh.faces), np.asarray(mesh.normals, np.float64)
    uvs = np.asarray(mesh.uvs, np.float64)
    tiles = np.asarray(item.tiles, np.float64)
    if item.tile_m is not None:
        tiles = np.asarray(hull_of(vertices, faces, normals, uvs).tile_m) / np.asarray(item.tile_m)
    return hull_of(vertices, faces, normals, uvs * tiles)


def maps(item: ReliefSurface, tile_m: tuple[float, float], exact: bool = True) -> Maps:
    """The maps of a surface whose tiles are `tile_m` metres large in the mean; heights as halves unless `exact`."""
    solid, translucent = item.solid, item.translucent
    layers = [solid.heights_m] if translucent is None else [solid.heights_m, translucent.heights_m]
    size = (max(h.shape[0] for h in layers), max(h.shape[1] for h in layers))
    layers = [resized_heights(h, size, item.tiling) for h in layers]
    if not exact:  # bounds must hold for the heights that are drawn
        layers = [np.asarray(h, np.float16).astype(np.float64) for h in layers]
    upper = layers[1] if translucent is not None else layers[0] - 1.0
    colors = solid.colors if isinstance(solid.colors, np.ndarray) else np.ones((1, 1, 3), np.float32)
    nothing = [np.zeros((1, 1, 2), np.float32)]
    heights = np.stack([layers[0], upper], axis=-1).astype(np.float32)
    return Maps(
        heights,
        heights.min(axis=(0, 1)),
        heights.max(axis=(0, 1)),
        bounds_pyramid(layers[0], upper if translucent is not None else None, item.tiling),
        levels(_slopes(solid, tile_m, item.tiling)),
        nothing if translucent is None else levels(_slopes(translucent, tile_m, item.tiling)),
        levels(np.asarray(colors, np.float32)),
    )


def _slopes(layer: ReliefLayer, tile_m: tuple[float, float], tiling: bool) -> np.ndarray:
    height, width = layer.heights.shape
    return np.asarray(layer.slopes((tile_m[0] / width, tile_m[1] / height), tiling), np.float32)


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
