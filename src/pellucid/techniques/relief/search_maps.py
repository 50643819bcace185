"""What the searches along rays look up beside the heights: free space, and how simple the heights are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pellucid.fields.heightfield import complexity_map, cone_map, distance_map

if TYPE_CHECKING:
    from pellucid.gpu import Device

Array = npt.NDArray[Any]

DISTANCE_LAYERS = 32


def search_map(
    search: str, heights: Array, two_layers: bool, tile_m: tuple[float, float], tiling: bool
) -> Array | None:
    """The map that a search needs, or None where bounds or nothing are enough.

    Parameters
    ----------
    search : one of ``scene.relief_quality.SEARCHES``. heights : (H, W, 2) metres, solid and translucent.

    Returns
    -------
    ``"cone"``: (2 H, 2 W, 2 or 4), the quadrants of ``cone_map`` side by side; of the upper of both layers, then of the
    solid one. ``"distance"``: (32, H, W, 2) metres, of the upper of both layers and of the solid one.
    """
    solid = heights[..., 0]
    both = [heights.max(axis=2), solid] if two_layers else [solid]
    if search == "cone":
        return np.concatenate([_side_by_side(cone_map(h, tiling)) for h in both], axis=-1)
    if search == "distance":
        cell = (tile_m[0] / solid.shape[1], tile_m[1] / solid.shape[0])
        low, high = float(solid.min()), float(both[0].max())
        if not high > low:
            high = low + 1e-3 * min(cell)
        found = [distance_map(h, cell, low, high, DISTANCE_LAYERS, tiling) for h in both]
        return np.stack([found[0], found[-1]], axis=-1)
    return None


def _side_by_side(quadrants: Array) -> Array:
    """(4, H, W, C) to (2 H, 2 W, C): columns of falling directions right, rows of falling ones below."""
    upper = np.concatenate([quadrants[0], quadrants[1]], axis=1)
    lower = np.concatenate([quadrants[2], quadrants[3]], axis=1)
    return np.concatenate([upper, lower], axis=0)


def simplicity_map(heights: Array, tiling: bool) -> Array:
    """(H, W, 1): ``complexity_map`` of whichever layer is less simple there."""
    return np.maximum(*(complexity_map(heights[..., k], tiling=tiling) for k in (0, 1)))[..., None]


def search_bindings(
    device: Device,
    search: str,
    complexity: bool,
    heights: Array,
    two_layers: bool,
    tile_m: tuple[float, float],
    tiling: bool,
) -> dict[str, Any]:
    """Textures that a search looks up, by their WGSL names; those that it has no use for are left out."""
    found: dict[str, Any] = {}
    drawn = search_map(search, heights, two_layers, tile_m, tiling)
    if drawn is not None:
        found[f"{search}_map"] = upload(device, drawn, filtered=search == "distance")
    if search == "linear" and complexity:
        simple = simplicity_map(heights, tiling)
        found["complexity_map"] = device.texture(simple, format="r16float", label="complexity")
    return found


def drawable_heights(device: Device, heights: Array) -> npt.NDArray[np.float32]:
    """Heights as this device can filter them: bounds and maps of free space must be of these, not of finer ones."""
    kept = heights if device.float32_filterable else heights.astype(np.float16)
    return np.asarray(kept, dtype=np.float32)


def upload(device: Device, values: Array, filtered: bool) -> Any:
    """A texture of (H, W, 2 or 4) or (Z, H, W, 2): 32-bit floats, or halves where only those can be filtered."""
    full = device.float32_filterable or not filtered
    kept = values.astype(np.float32)
    if not full and values.ndim == 4:
        # Distances may become shorter, not longer.
        half = kept.astype(np.float16)
        kept = np.where(half.astype(np.float32) > kept, np.nextafter(half, np.float16(0.0)), half).astype(np.float32)
    channels = "rgba" if values.shape[-1] == 4 else "rg"
    format = f"{channels}{32 if full else 16}float"
    return device.texture(kept, format=format, dimension="3d" if values.ndim == 4 else "2d", label="search")
