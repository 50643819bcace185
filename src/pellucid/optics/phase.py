"""Where scattered light goes. Twin of ``phase.wgsl``."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def henyey_greenstein(cos_theta: ArrayLike, g: ArrayLike) -> NDArray[np.float64]:
    """Henyey-Greenstein phase function [henyey1941, eq. 2], (1-g^2)/(4 pi (1+g^2-2g cos)^1.5).

    Its integral over the sphere is 1 and its mean cosine is g. The bracket is evaluated as
    (1-|g|)^2 + 2|g|(1 -+ cos), which cancels at neither the forward nor the backward peak.

    Parameters
    ----------
    cos_theta : (...), cosine between the directions of travel before and after, in [-1, 1].
    g : (...), mean cosine, in (-1, 1); 0 is isotropic, positive is forward.

    Returns
    -------
    (...), 1/sr.
    """
    cos_theta, g = np.asarray(cos_theta, float), np.asarray(g, float)
    bracket = (1.0 - np.abs(g)) ** 2 + 2.0 * np.abs(g) * (1.0 - np.sign(g) * cos_theta)
    return (1.0 - g) * (1.0 + g) / (4.0 * np.pi * bracket * np.sqrt(bracket))
