"""Arrays of voxels and numbers of matter, checked once for volumes and for the bodies in them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import real_array
from pellucid.fields.sampling import check_size

Voxels = npt.NDArray[np.float32]


def voxels(name: str, values: npt.ArrayLike, channels: int | None, shape: tuple[int, int, int] | None = None) -> Voxels:
    """A checked, contiguous, read-only float32 copy. `channels`: None for a scalar, -1 for a scalar or three."""
    array = real_array(name, values)
    allowed: list[tuple[int, ...]] = [(), (3,)] if channels == -1 else [() if channels is None else (channels,)]
    if array.ndim < 3 or array.shape[3:] not in allowed or (shape is not None and array.shape[:3] != shape):
        where = "Z, Y, X" if shape is None else ", ".join(map(str, shape))
        wanted = " or ".join(f"({', '.join([where, *map(str, a)])})" for a in allowed)
        raise SceneError(name, f"has shape {array.shape}", f"give {wanted}")
    check_size(name, array.shape[:3])
    if array.dtype == np.float32 and array.flags.c_contiguous and not array.flags.writeable:
        kept = array
    else:
        kept = np.array(array, dtype=np.float32, order="C")
        kept.flags.writeable = False
    if not np.isfinite(kept).all():
        raise SceneError(name, f"has {int((~np.isfinite(kept)).sum())} values that are not finite")
    return kept


def unit_vectors(name: str, vectors: Voxels) -> Voxels:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    bad = int(np.count_nonzero(length < 1e-6))
    if bad:
        raise SceneError(name, f"has {bad} vectors of length 0", "give it a direction everywhere")
    return voxels(name, vectors if np.abs(length - 1.0).max() < 1e-6 else vectors / length, 3)


def not_negative(name: str, values: Any) -> tuple[float, float, float]:
    """Three finite numbers, 0 or more."""
    try:
        rgb = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        rgb = np.full(3, np.nan)
    if rgb.shape != (3,) or not np.isfinite(rgb).all() or (rgb < 0.0).any():
        raise SceneError(name, f"is {values}", "give three numbers, 0 or more")
    return float(rgb[0]), float(rgb[1]), float(rgb[2])


def mean_cosine(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not abs(np.float32(value)) < 1.0:
        raise SceneError(name, f"is {value!r}", "a mean cosine lies in (-1, 1)")
    return float(value)


def refractive_index(name: str, value: float) -> float:
    try:
        index = float(value)
    except (TypeError, ValueError):
        raise SceneError(name, f"is {value!r}", "give a number") from None
    if not (np.isfinite(index) and index > 0.0):
        raise SceneError(name, f"is {index:g}", "a refractive index is above 0")
    return index
