"""How steeply a refracted ray leaves an interface: what Snell, Fresnel and the factor of refraction have in common.

Twin of ``normal_momentum.wgsl``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def normal_momentum_squared(cos_i: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Square of n_t cos_t, the part along the normal of the refracted n_t d: n_t^2 - n_i^2 + (n_i cos_i)^2.

    The part along the surface, n_i sin_i, is kept [born1999, 1.5.1]. Written with (n_t - n_i) (n_t + n_i) nothing
    cancels when the two indices are close, and no n_i/n_t is rounded away from 1.

    Parameters
    ----------
    cos_i : (...), cosine of the angle of incidence, in [0, 1].
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...); negative under total internal reflection.
    """
    c, n_i, n_t = (np.asarray(a, float) for a in (cos_i, n_i, n_t))
    return np.asarray((n_t - n_i) * (n_t + n_i) + (n_i * c) ** 2)
