"""Presmoothing of voxel fields, so that a boundary is wide enough to have a gradient."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError


def gaussian(field: npt.ArrayLike, sigma_voxels: float) -> npt.NDArray[np.float32]:
    """Gaussian blur of a voxel field (smooth boundaries, [tevs2007, 3.1]).

    The border is continued with its own value, so a constant field stays constant and the mean
    of a field that is constant near its border is kept.

    Parameters
    ----------
    field : (Z, Y, X) or (Z, Y, X, C); every channel is blurred by itself.
    sigma_voxels : standard deviation in voxels, >= 0; 0 returns a copy.

    Returns
    -------
    float32 array of the same shape.

    Raises
    ------
    SceneError
        The width is negative or not finite, or the field is not a voxel field.
    """
    from scipy.ndimage import gaussian_filter

    values = np.asarray(field)
    if values.ndim not in (3, 4):
        raise SceneError("field", f"has {values.ndim} axes", "give (Z, Y, X) or (Z, Y, X, C)")
    if not (np.isfinite(sigma_voxels) and sigma_voxels >= 0.0):
        raise SceneError("sigma_voxels", f"is {sigma_voxels}", "use 0 or more")
    if sigma_voxels == 0.0:
        return np.array(values, dtype=np.float32)
    sigma = (sigma_voxels,) * 3 + (0.0,) * (values.ndim - 3)
    blurred = gaussian_filter(values.astype(np.float64), sigma, mode="nearest", truncate=3.0)
    return blurred.astype(np.float32)
