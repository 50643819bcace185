"""From a `RefractiveSheet` to arrays: vertices with normals at a time, levels of its pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene.shapes import vertex_normals
from pellucid.surroundings.resample import area_resample
from pellucid.techniques.sheet.layouts import SheetVertex

if TYPE_CHECKING:
    from pellucid.scene import RefractiveSheet

HALF_MAX = 65504.0


class WaveMap(NamedTuple):
    """Heights (H, W) in metres and slopes (H, W, 2) along x and z at cell centres about the middle; (x, z) metres."""

    heights: np.ndarray
    slopes: np.ndarray
    tile_m: tuple[float, float]
    periodic: bool


def faces_of(item: RefractiveSheet) -> np.ndarray:
    """(F, 3) uint32, counter-clockwise seen from above."""
    if item.mesh is not None:
        return np.asarray(item.mesh.faces, np.uint32)
    columns, rows = item.cells
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    below = first + columns + 1
    pairs = [np.stack([first, below, first + 1], 1), np.stack([first + 1, below, below + 1], 1)]
    return np.concatenate(pairs).astype(np.uint32)


def vertices_of(item: RefractiveSheet, time_s: float) -> np.ndarray:
    """(V,) of dtype `layouts.SheetVertex` at a time.

    Raises
    ------
    SceneError : heights that are not finite or reach down to the picture.
    """
    if item.mesh is None:
        positions, normals = _grid(item, time_s)
    else:
        positions = item.vertices_at(time_s)
        at_rest = item.motion is None and item.mesh.normals is not None
        normals = np.asarray(item.mesh.normals) if at_rest else vertex_normals(positions, item.mesh.faces)
    out = np.zeros(len(positions), SheetVertex)
    out["position"], out["normal"] = positions, normals
    return out


def _grid(item: RefractiveSheet, time_s: float) -> tuple[np.ndarray, np.ndarray]:
    columns, rows = item.cells
    x, z = (np.linspace(*ends, count + 1) for ends, count in zip(item.extents_m, (columns, rows), strict=True))
    x, z = (v.ravel() for v in np.meshgrid(x, z))
    if item.waves is None:
        return np.stack([x, 0.0 * x, z], 1), np.tile([0.0, 1.0, 0.0], (len(x), 1))
    waves = wave_map(item, time_s)
    y, slope_x, slope_z = sampled(waves, x, z).T
    normals = np.stack([-slope_x, np.ones_like(y), -slope_z], 1)
    return np.stack([x, y, z], 1), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def wave_map(item: RefractiveSheet, time_s: float) -> WaveMap:
    """The waves of a sheet at a time, with slopes of their own or else central differences."""
    waves: Any = item.waves
    if isinstance(waves, np.ndarray):
        (x_low, x_high), (z_low, z_high) = item.extents_m
        tile_m, periodic = (x_high - x_low, z_high - z_low), False
        heights, slopes = np.asarray(waves, np.float64), None
    else:
        surface = waves.surface(time_s) if hasattr(waves, "surface") else None
        heights = np.asarray(waves.advance(time_s) if surface is None else surface.heights, np.float64)
        slopes = None if surface is None else np.asarray(surface.slopes, np.float64)
        tile_m = (float(waves.tile_m[0]), float(waves.tile_m[1]))
        periodic = bool(getattr(waves, "periodic", getattr(waves, "boundary", "") == "periodic"))
    if not np.isfinite(heights).all():
        raise SceneError("refractive_sheet.waves", f"hold values that are not finite at {time_s:g} s")
    if heights.min() <= -item.depth_m:
        reason = f"reach {-heights.min():g} metres down at {time_s:g} s, the picture lies {item.depth_m:g} below"
        raise SceneError("refractive_sheet.waves", reason, "make the picture deeper or the waves lower")
    if slopes is None:
        slopes = _slopes(heights, tile_m, periodic)
    return WaveMap(heights, slopes, tile_m, periodic)


def _slopes(heights: np.ndarray, tile_m: tuple[float, float], periodic: bool) -> np.ndarray:
    out = np.zeros((*heights.shape, 2))
    for k, axis in enumerate((1, 0)):
        count = heights.shape[axis]
        if count > 1:
            ends = [(1, 1) if a == axis else (0, 0) for a in (0, 1)]
            padded = np.pad(heights, ends, mode="wrap" if periodic else "reflect", **_odd(periodic))
            ahead, behind = (padded.take(np.arange(s, s + count), axis) for s in (2, 0))
            out[..., k] = (ahead - behind) * count / (2.0 * tile_m[k])
    return out


def _odd(periodic: bool) -> dict[str, Any]:
    """Beyond a border that is none, heights go on as they come in."""
    return {} if periodic else {"reflect_type": "odd"}


def sampled(waves: WaveMap, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Height and slopes (N, 3) at places, bilinear between cell centres; periodic, or going on as they end."""
    stack = np.concatenate([waves.heights[..., None], waves.slopes], axis=2)
    rows, columns = waves.heights.shape
    places = []
    for at, tile, count in ((x, waves.tile_m[0], columns), (z, waves.tile_m[1], rows)):
        cell = (at / tile + 0.5) * count - 0.5
        cell = cell if waves.periodic else np.clip(cell, 0.0, count - 1.0)
        first = np.floor(cell).astype(int)
        share = (cell - first)[:, None]
        both = [(first + k) % count if waves.periodic else np.minimum(first + k, count - 1) for k in (0, 1)]
        places.append((both, share))
    (i, u), (j, v) = places
    upper = stack[j[0], i[0]] * (1.0 - u) + stack[j[0], i[1]] * u
    lower = stack[j[1], i[0]] * (1.0 - u) + stack[j[1], i[1]] * u
    return np.asarray(upper * (1.0 - v) + lower * v)


def picture_levels(picture: np.ndarray) -> list[np.ndarray]:
    """(h, w, 4) float32 levels of a picture, each half as large as the one before, down to one texel."""
    level = np.minimum(np.asarray(picture, np.float32), HALF_MAX)
    out = [level]
    while max(level.shape[:2]) > 1:
        level = area_resample(level, (max(level.shape[0] // 2, 1), max(level.shape[1] // 2, 1)))
        out.append(level)
    return [np.pad(one, ((0, 0), (0, 0), (0, 1)), constant_values=1.0) for one in out]
