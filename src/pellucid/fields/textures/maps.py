"""What a procedural texture gives: heights, normals and colours of one tile, which agree; and the checks of all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.heightfield import slopes_of
from pellucid.fields.numbers import number

Values = npt.NDArray[np.float64]
Texels = npt.NDArray[np.float32]
LARGEST = 4096


@dataclass(frozen=True, eq=False)
class Maps:
    """Heights, normals and colours of a square piece of surface that repeats without a seam.

    Row 0 is the top. Texel (j, i) lies at u = (i + 0.5) / W, v = 1 - (j + 0.5) / H. Arrays are read-only.

    Parameters
    ----------
    heights_m : (H, W) float32 along the normal of the polygon, metres; 0 is the polygon.
    normals : (H, W, 3) float32 unit vectors (x to the right, y up, z away from the polygon).
    colors : (H, W, 3) float32 linear Rec. 709, reflectance or tint, 0 to 1.
    tile_m : edge of the piece, metres.

    Raises
    ------
    SceneError
        Names the map that has the wrong shape or values.
    """

    heights_m: Texels = field(repr=False)
    normals: Texels = field(repr=False)
    colors: Texels = field(repr=False)
    tile_m: float

    def __post_init__(self) -> None:
        heights = _texels("heights_m", self.heights_m, None)
        object.__setattr__(self, "heights_m", heights)
        object.__setattr__(self, "normals", _texels("normals", self.normals, (*heights.shape, 3)))
        object.__setattr__(self, "colors", _texels("colors", self.colors, (*heights.shape, 3)))
        object.__setattr__(self, "tile_m", number("tile_m", self.tile_m, low=1e-6, unit="metres"))
        if np.abs(np.linalg.norm(self.normals, axis=-1) - 1.0).max() > 1e-3:
            raise SceneError("normals", "are not of unit length", "divide them by their length")
        if self.colors.min() < 0.0 or self.colors.max() > 1.0:
            raise SceneError("colors", "leave 0 to 1", "give linear reflectances")

    @classmethod
    def of(cls, heights_m: npt.ArrayLike, colors: npt.ArrayLike, tile_m: float) -> Maps:
        """Maps with normals that follow from heights; `colors` are (H, W, 3), or one colour."""
        heights = np.asarray(heights_m, dtype=np.float64)
        tint = np.broadcast_to(np.asarray(colors, dtype=np.float64), (*heights.shape, 3))
        return cls(heights, normals_of(heights, tile_m), np.clip(tint, 0.0, 1.0), tile_m)  # type: ignore[arg-type]


def normals_of(heights_m: npt.ArrayLike, tile_m: float) -> Texels:
    """Unit normals of a height field that repeats, from central differences in metres per metre.

    Parameters
    ----------
    heights_m : (H, W) metres, row 0 at the top. tile_m : edge of the field, metres.

    Returns
    -------
    (H, W, 3) float32, x to the right, y up.
    """
    rows, columns = np.shape(heights_m)
    slopes = slopes_of(heights_m, (tile_m / columns, tile_m / rows)).astype(np.float64)
    normals = np.concatenate([-slopes, np.ones((rows, columns, 1))], axis=-1)
    return (normals / np.linalg.norm(normals, axis=-1, keepdims=True)).astype(np.float32)


def places(size: int) -> tuple[Values, Values]:
    """(u, v) of texel centres, each (size, size): u to the right, v up."""
    across = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(across, across[::-1])
    return u, v


def averaged(size: int, evaluate: Callable[[Values, Values], tuple[Values, Values]]) -> tuple[Values, Values]:
    """Heights and colours at the texels, each the mean of four places: edges that are thinner do not flicker.

    evaluate : from (u, v) to heights (N, N) and colours (N, N, 3).
    """
    heights, colors = evaluate(*places(2 * size))
    return (
        heights.reshape(size, 2, size, 2).mean(axis=(1, 3)),
        colors.reshape(size, 2, size, 2, 3).mean(axis=(1, 3)),
    )


def ramp(x: Values | float, low: float, high: float) -> Values:
    """0 below `low`, 1 above `high`, and a cubic between them that is smooth at both."""
    t = np.clip((np.asarray(x, dtype=np.float64) - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def mixed(a: npt.ArrayLike, b: npt.ArrayLike, share: Values) -> Values:
    """Colours from `a` (share 0) to `b` (share 1); shares are (...), colours (..., 3) or (3,)."""
    first, second = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    return first + (second - first) * share[..., None]


def whole(extent_m: float, pitch_m: float, *, even: bool = False) -> int:
    """How many pieces of about `pitch_m` fill the tile; an even number of courses when bonds alternate."""
    step = 2 if even else 1
    return max(step, step * round(extent_m / pitch_m / step))


def grid(size: Any, seed: Any, tile_m: Any) -> tuple[int, np.random.Generator, float]:
    """The parameters that all textures share, checked: texels, generator of random numbers, edge in metres."""
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or not 8 <= size <= LARGEST:
        raise SceneError("size", f"is {size!r}", f"give a whole number of texels, 8 to {LARGEST}")
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise SceneError("seed", f"is {seed!r}", "give a whole number, at least 0")
    return int(size), np.random.default_rng(int(seed)), number("tile_m", tile_m, low=1e-6, unit="metres")


def color(name: str, value: Sequence[float]) -> Values:
    """(3,) linear reflectance from 0 to 1, or SceneError."""
    try:
        rgb = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        rgb = np.empty(0)
    if rgb.shape != (3,) or not np.isfinite(rgb).all() or rgb.min() < 0.0 or rgb.max() > 1.0:
        raise SceneError(name, f"is {value!r}", "give three linear reflectances, 0 to 1")
    return rgb


def _texels(name: str, values: npt.ArrayLike, shape: tuple[int, ...] | None) -> Texels:
    result = np.array(values, dtype=np.float32, order="C")
    if result.shape != shape if shape else (result.ndim != 2 or min(result.shape) < 2):
        raise SceneError(name, f"has shape {result.shape}", f"give {shape or '(H, W)'}")
    if not np.isfinite(result).all():
        raise SceneError(name, f"has {np.count_nonzero(~np.isfinite(result))} values that are not finite")
    result.setflags(write=False)
    return result
