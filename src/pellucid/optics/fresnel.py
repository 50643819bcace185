"""How much light a smooth interface between two dielectrics reflects. Twin of ``fresnel.wgsl``."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.optics.normal_momentum import normal_momentum_squared

# Smallest denominator: turns 0/0 (equal indices at grazing incidence) into the limit, 0. Larger than
# cosines whose square underflows, also in the single precision of the twin
_TINY = 1e-15


class PolarisedReflectance(NamedTuple):
    """Reflected share of the flux of each polarisation.

    Attributes
    ----------
    s : (...), in [0, 1]; electric field perpendicular to the plane of incidence, rs^2.
    p : (...), in [0, 1]; electric field in the plane of incidence, rp^2.
    """

    s: NDArray[np.float64]
    p: NDArray[np.float64]


def fresnel_polarised(cos_i: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> PolarisedReflectance:
    """Fresnel's formulae for both polarisations, rs^2 and rp^2 [born1999, 1.5.2 and 1.5.3].

    Written with q = n_t cos_t, as in :func:`pellucid.optics.snell.refract`, so that equal indices
    reflect nothing at any angle.

    Parameters
    ----------
    cos_i : (...), cosine of the angle of incidence, clipped to [0, 1].
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    PolarisedReflectance; both 1 under total internal reflection.
    """
    c = np.clip(np.asarray(cos_i, float), 0.0, 1.0)
    n_i, n_t = np.asarray(n_i, float), np.asarray(n_t, float)
    q_squared = normal_momentum_squared(c, n_i, n_t)
    q = np.sqrt(np.maximum(q_squared, 0.0))
    r_s = (n_i * c - q) / np.maximum(n_i * c + q, _TINY)
    r_p = (n_t * n_t * c - n_i * q) / np.maximum(n_t * n_t * c + n_i * q, _TINY)
    total = q_squared < 0.0
    return PolarisedReflectance(np.where(total, 1.0, r_s**2), np.where(total, 1.0, r_p**2))


def fresnel_dielectric(cos_i: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Exact reflectance for unpolarised light, (rs^2 + rp^2)/2 [timonen2006, eq. 9-12; born1999, 1.5.3].

    Parameters
    ----------
    cos_i : (...), cosine of the angle of incidence, clipped to [0, 1].
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...), in [0, 1]; 1 under total internal reflection. The transmitted share is the rest.
    """
    reflectance = fresnel_polarised(cos_i, n_i, n_t)
    return 0.5 * (reflectance.s + reflectance.p)


def normal_reflectance(n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Reflectance at normal incidence, ((n_i - n_t)/(n_i + n_t))^2 [born1999, 1.5.3].

    Parameters
    ----------
    n_i, n_t : (...), indices of the two sides, > 0; their order does not matter.

    Returns
    -------
    (...), in [0, 1).
    """
    n_i, n_t = np.asarray(n_i, float), np.asarray(n_t, float)
    return np.square((n_i - n_t) / (n_i + n_t))


def schlick(f0: ArrayLike, cosine: ArrayLike, exponent: ArrayLike) -> NDArray[np.float64]:
    """Schlick's curve, f0 + (1 - f0)(1 - cos)^q [mihalik2008, eq. 7-8; schlick1994, eq. 15].

    Parameters
    ----------
    f0 : (...), reflectance at normal incidence, in [0, 1].
    cosine : (...), cosine of the angle on the side of the lower index, clipped to [0, 1].
    exponent : (...), q > 0; 5 in [schlick1994].

    Returns
    -------
    (...), in [f0, 1].
    """
    f0 = np.asarray(f0, float)
    return f0 + (1.0 - f0) * (1.0 - np.clip(np.asarray(cosine, float), 0.0, 1.0)) ** np.asarray(exponent)


def fresnel_schlick(cos_i: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Schlick's approximation of :func:`fresnel_dielectric` [schlick1994, eq. 15], exponent 5.

    From the denser side the cosine is that of the transmitted angle, as the curve is a fit on
    the side of the lower index; seen so it is 1 under total reflection, as it must be.
    The largest error over all angles is +0.059 for n = 1.333, +0.036 for 1.5 and +0.076 for 2.42. Equal
    indices reflect nothing, but the curve says (1 - cos)^5: nearly matched media need the exact form.

    Parameters
    ----------
    cos_i : (...), cosine of the angle of incidence, clipped to [0, 1].
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...), in [0, 1].
    """
    c = np.clip(np.asarray(cos_i, float), 0.0, 1.0)
    n_i, n_t = np.asarray(n_i, float), np.asarray(n_t, float)
    q_squared = normal_momentum_squared(c, n_i, n_t)
    cosine = np.where(n_i > n_t, np.sqrt(np.maximum(q_squared, 0.0)) / n_t, c)
    return schlick(normal_reflectance(n_i, n_t), cosine, 5.0)


def brewster_angle(n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Angle of incidence at which rp vanishes, tan = n_t/n_i [born1999, 1.5.3].

    Parameters
    ----------
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...), rad, in (0, pi/2).
    """
    return np.arctan2(np.asarray(n_t, float), np.asarray(n_i, float))
