"""What absorption leaves of the light along a path. Twin of ``attenuation.wgsl``."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def transmittance(sigma_per_m: ArrayLike, distance_m: ArrayLike) -> NDArray[np.float64]:
    """Bouguer's law, exp(-sigma d) per channel [bouguer1729; timonen2006, eq. 13].

    Paths compose: the product over pieces is the transmittance of the whole.

    Parameters
    ----------
    sigma_per_m : (..., C), extinction, 1/m, >= 0.
    distance_m : (...), length of the path, m, >= 0.

    Returns
    -------
    (..., C), in [0, 1].
    """
    return np.exp(-np.asarray(sigma_per_m, float) * np.asarray(distance_m, float)[..., None])


def extinction_from_half_distance(strength: ArrayLike, half_distance_m: ArrayLike) -> NDArray[np.float64]:
    """Extinction a ln 2 / d0 of a colour halved every d0 [timonen2006, eq. 13].

    Parameters
    ----------
    strength : (..., C), a; 1 halves the channel over ``half_distance_m``, 0 leaves it alone.
    half_distance_m : (...), d0, m, > 0.

    Returns
    -------
    (..., C), 1/m.
    """
    return np.asarray(strength, float) * np.log(2.0) / np.asarray(half_distance_m, float)[..., None]


def water_colour(
    colour: ArrayLike, deep_colour: ArrayLike, sigma_per_m: ArrayLike, distance_m: ArrayLike
) -> NDArray[np.float64]:
    """Colour seen through water, C_w + exp(-k d)(C - C_w) [mihalik2008, eq. 4-5].

    Parameters
    ----------
    colour : (..., C), radiance of what lies behind the water.
    deep_colour : (..., C), radiance of water of unlimited depth.
    sigma_per_m : (..., C), extinction, 1/m, >= 0.
    distance_m : (...), length of the path in the water, m, >= 0.

    Returns
    -------
    (..., C), radiance.
    """
    behind, deep = np.asarray(colour, float), np.asarray(deep_colour, float)
    return deep + transmittance(sigma_per_m, distance_m) * (behind - deep)
