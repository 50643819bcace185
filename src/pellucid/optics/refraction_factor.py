"""Refraction by a factor instead of an angle: incident direction + factor * inverted normal [oliveira2000b, eq. 8].

Snell's law has that very form, with a factor that depends on the angle of incidence (`exact_factor`). A fixed one
is right at one angle. Directions travel and normals face the side they come from, as in :mod:`pellucid.optics.snell`.
Twin of ``refraction_factor.wgsl``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.optics.normal_momentum import normal_momentum_squared
from pellucid.optics.snell import RefractResult


def refract_by_factor(direction: ArrayLike, normal: ArrayLike, factor: ArrayLike) -> RefractResult:
    """Bend a direction towards the inverted normal, d - k n of unit length [oliveira2000b, eq. 8].

    Parameters
    ----------
    direction, normal : (..., 3), unit, ``direction . normal < 0``.
    factor : (...), k: 0 leaves the direction as it is, more turns it towards the inverted normal, less than 0 away.

    Returns
    -------
    RefractResult; not valid, with the incident direction, where the sum does not pass the surface (-k >= cos_i).
    """
    d, n = np.asarray(direction, float), np.asarray(normal, float)
    k = np.asarray(factor, float)[..., None]
    bent = d - k * n
    valid = np.sum(bent * n, axis=-1, keepdims=True) < 0.0
    length = np.linalg.norm(bent, axis=-1, keepdims=True)
    return RefractResult(np.where(valid, bent / np.where(valid, length, 1.0), d), valid[..., 0])


def exact_factor(cos_i: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """The factor at which :func:`refract_by_factor` is Snell's law, (n_t cos_t - n_i cos_i) / n_i.

    Snell's law as a vector, n_t t = n_i d - (n_t cos_t - n_i cos_i) n [born1999, 1.5.1], is n_i (d - k n).

    Parameters
    ----------
    cos_i : (...), cosine of the angle of incidence, clipped to [0, 1].
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...); n_t/n_i - 1 at normal incidence, growing to sqrt((n_t/n_i)^2 - 1) at grazing; -cos_i, at which nothing
    passes, under total reflection.
    """
    c = np.clip(np.asarray(cos_i, float), 0.0, 1.0)
    n_i, n_t = np.asarray(n_i, float), np.asarray(n_t, float)
    q_squared = normal_momentum_squared(c, n_i, n_t)
    return np.asarray(np.sqrt(np.maximum(q_squared, 0.0)) / n_i - c)


def fitted_factor(n_i: ArrayLike, n_t: ArrayLike, largest_angle: ArrayLike) -> NDArray[np.float64]:
    """The fixed factor with the least largest error over all angles of incidence up to one, to leading order.

    With s the sine of the angle, `exact_factor` is (n - 1)(1 + s^2 / 2n) + O(s^4), n = n_t/n_i, so a factor that is
    exact at s = a errs by a multiple of s (s^2 - a^2). That is least over [0, S] for Chebyshev's polynomial of
    degree 3, a^2 = 3/4 S^2: the factor is the exact one where the sine is sqrt(3)/2 of the largest.

    Parameters
    ----------
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.
    largest_angle : (...), rad, 0 to pi/2; 0 gives n_t/n_i - 1, the limit of small angles.

    Returns
    -------
    (...), the factor.
    """
    sine = np.sin(np.asarray(largest_angle, float))
    return exact_factor(np.sqrt(np.maximum(1.0 - 0.75 * sine * sine, 0.0)), n_i, n_t)


def opposite_factor(factor: ArrayLike) -> NDArray[np.float64]:
    """The factor that undoes another from the other side at small angles, 1 / (1 + k) - 1.

    There the index is 1 + k; what comes back sees its reciprocal.

    Parameters
    ----------
    factor : (...), > -1.
    """
    return np.asarray(1.0 / (1.0 + np.asarray(factor, float)) - 1.0)
