"""How a box of space is cut into voxels, and a function sampled at their centres."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

MOST_VOXELS = 1024**3

FieldFunction = Callable[[Any, Any, Any], Any]
Extent = float | Sequence[float]


def check_size(name: str, shape: tuple[int, ...]) -> None:
    """Raise for a grid without voxels or with more than 1024^3."""
    if len(shape) != 3 or min(shape) < 1:
        raise SceneError(name, f"has shape {tuple(shape)}", "give (Z, Y, X), each at least 1")
    if int(np.prod([int(n) for n in shape])) > MOST_VOXELS:
        raise SceneError(name, f"has shape {tuple(shape)}", "at most 1024 x 1024 x 1024 voxels are possible")


def box_edges(extent_m: Extent, shape: tuple[int, int, int] | None) -> tuple[float, float, float]:
    """Edges (x, y, z); one number is the longest edge, the others follow from cubic voxels."""
    try:
        edges = np.asarray(extent_m, dtype=np.float64)
    except (TypeError, ValueError):
        raise SceneError("extent_m", f"is {extent_m!r}", "give one or three numbers in metres") from None
    if edges.ndim == 0:
        count = np.ones(3) if shape is None else np.array(shape[::-1], dtype=np.float64)
        edges = edges * count / count.max()
    if edges.shape != (3,) or not np.isfinite(edges).all() or (edges <= 0.0).any():
        raise SceneError("extent_m", f"is {extent_m}", "give one or three positive lengths in metres")
    return float(edges[0]), float(edges[1]), float(edges[2])


def check_resolution(resolution: int) -> None:
    """Raise for anything but a whole number from 2 to 4096."""
    if isinstance(resolution, bool) or not isinstance(resolution, int | np.integer) or resolution < 2:
        raise SceneError("resolution", f"is {resolution!r}", "give a whole number of voxels, at least 2")
    if resolution > 4096:
        raise SceneError("resolution", f"is {resolution}", "at most 1024 x 1024 x 1024 voxels are possible")


def sampling(resolution: int, extent_m: Extent) -> tuple[tuple[int, int, int], tuple[float, float, float]]:
    """Shape (Z, Y, X) and edges (x, y, z) of a box with `resolution` voxels along its longest edge."""
    check_resolution(resolution)
    extent = box_edges(extent_m, None)
    voxel = max(extent) / resolution
    x, y, z = (max(1, round(edge / voxel)) for edge in extent)
    check_size("resolution", (z, y, x))
    return (z, y, x), extent


def sampled(
    name: str, f: FieldFunction, shape: tuple[int, int, int], extent: tuple[float, float, float]
) -> npt.NDArray[np.float64]:
    """Values of a function at all voxel centres, a few million at a time."""
    lines = [(np.arange(n) + 0.5) * (e / n) - 0.5 * e for n, e in zip(shape[::-1], extent, strict=True)]
    out = np.empty(shape)
    layers = max(1, 4_000_000 // (shape[1] * shape[2]))
    for start in range(0, shape[0], layers):
        stop = min(start + layers, shape[0])
        z, y, x = np.meshgrid(lines[2][start:stop], lines[1], lines[0], indexing="ij")
        values = np.asarray(f(x, y, z))
        try:
            out[start:stop] = values
        except (TypeError, ValueError):
            raise SceneError(
                name, f"gives shape {values.shape} for points of shape {x.shape}", "it must work on arrays"
            ) from None
    return out
