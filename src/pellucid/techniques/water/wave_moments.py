"""What of waves is left over large patches: means of slopes, and of their products [olano2010]."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def moment_levels(texels: np.ndarray) -> list[np.ndarray]:
    """Levels of the texture ``wave_moments``, each half as wide as the one before, down to one texel.

    A mean of patches of equal size is the mean of all: so the variance of the slopes over a patch of any size is the
    mean of their squares less the square of their mean.

    Parameters
    ----------
    texels : (L, H, W, 4) heights, dh/dx, dh/dz, fold; a layer a source.

    Returns
    -------
    (2 L, h, w, 4) float32 arrays, the first half as wide as `texels`. Layer 2 n: means of dh/dx, dh/dz, fold, height of
    source n; layer 2 n + 1: of (dh/dx)^2, (dh/dz)^2, dh/dx dh/dz, fold^2.
    """
    count, rows, columns = texels.shape[:3]
    # Planes first: NumPy is several times as slow with the channels innermost.
    planes = np.empty((2, 4, count, rows, columns), np.float32)
    for n, channel in enumerate((1, 2, 3, 0)):
        planes[0, n] = texels[..., channel]
    along_x, along_z, fold = planes[0, :3]
    for n, (one, other) in enumerate(((along_x, along_x), (along_z, along_z), (along_x, along_z), (fold, fold))):
        np.multiply(one, other, out=planes[1, n])
    levels = []
    while True:
        planes = _halved(_halved(planes, -2), -1)
        stacked = planes.transpose(2, 0, 3, 4, 1)
        levels.append(np.ascontiguousarray(stacked).reshape(2 * count, *planes.shape[3:], 4))
        if planes.shape[3:] == (1, 1):
            return levels


def _halved(planes: np.ndarray, axis: int) -> np.ndarray:
    """Means of pairs along an axis; of n = 2 m + 1 lines each result takes n / m, so that none counts more."""
    count = planes.shape[axis]
    if count == 1:
        return planes
    lines = np.moveaxis(planes, axis, 0)
    half = count // 2
    if count % 2 == 0:
        result = lines[::2] + lines[1::2]
        result *= np.float32(0.5)
    else:
        at = np.arange(half, dtype=np.float32).reshape(-1, *(1,) * (lines.ndim - 1))
        result = ((half - at) * lines[:-1:2] + half * lines[1::2] + (at + 1) * lines[2::2]) / np.float32(count)
    return np.moveaxis(result, 0, axis)


def short_slopes(sources: Sequence[Any]) -> np.ndarray:
    """(3,) mean squares (dh/dx)^2, (dh/dz)^2, dh/dx dh/dz of the waves that are too short for the grids of sources."""
    given = [getattr(source, "short_slopes", (0.0, 0.0, 0.0)) for source in sources]
    xx, xz, zz = (sum(one[n] for one in given) for n in range(3))
    return np.array([xx, zz, xz], np.float32)
