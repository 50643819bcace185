"""From a `RefractiveSheet` to arrays: vertices with normals at a time, levels of its pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.waves import WaveSource
from pellucid.fields.waves.source import bilinear, difference_slopes
from pellucid.scene.shapes import vertex_normals
from pellucid.surroundings.resample import area_resample
from pellucid.techniques.sheet.layouts import SheetVertex

if TYPE_CHECKING:
    from pellucid.scene import RefractiveSheet

HALF_MAX = 65504.0


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
    y, slopes = _waves(item, x, z, time_s)
    normals = np.stack([-slopes[:, 0], np.ones_like(y), -slopes[:, 1]], 1)
    return np.stack([x, y, z], 1), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _waves(item: RefractiveSheet, x: np.ndarray, z: np.ndarray, time_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights (N,) and slopes (N, 2) of the waves of a sheet at places: their own, or central differences."""
    waves: Any = item.waves
    if isinstance(waves, WaveSource):
        heights, slopes = waves.at(x, z, time_s)
    else:
        (left, right), (back, front) = item.extents_m
        moves = hasattr(waves, "advance")
        grid = np.asarray(waves.advance(time_s) if moves else waves, np.float64)
        tile_m = waves.tile_m if moves else (right - left, front - back)
        rows, columns = grid.shape
        slope = difference_slopes(grid, (tile_m[0] / columns, tile_m[1] / rows), False)
        column, row = (x / tile_m[0] + 0.5) * columns - 0.5, (z / tile_m[1] + 0.5) * rows - 0.5
        heights, along_x, along_z = bilinear([grid, slope[..., 0], slope[..., 1]], column, row, False)
        slopes = np.stack([along_x, along_z], axis=1)
    if not (np.isfinite(heights).all() and np.isfinite(slopes).all()):
        raise SceneError("refractive_sheet.waves", f"hold values that are not finite at {time_s:g} s")
    if heights.min() <= -item.depth_m:
        reason = f"reach {-heights.min():g} metres down at {time_s:g} s, the picture lies {item.depth_m:g} below"
        raise SceneError("refractive_sheet.waves", reason, "make the picture deeper or the waves lower")
    return np.asarray(heights, np.float64), np.asarray(slopes, np.float64)


def picture_levels(picture: np.ndarray) -> list[np.ndarray]:
    """(h, w, 4) float32 levels of a picture, each half as large as the one before, down to one texel."""
    level = np.minimum(np.asarray(picture, np.float32), HALF_MAX)
    out = [level]
    while max(level.shape[:2]) > 1:
        level = area_resample(level, (max(level.shape[0] // 2, 1), max(level.shape[1] // 2, 1)))
        out.append(level)
    return [np.pad(one, ((0, 0), (0, 0), (0, 1)), constant_values=1.0) for one in out]
