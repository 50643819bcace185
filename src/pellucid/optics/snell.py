"""Directions at an interface: reflection, refraction and the angle where refraction ends.

A unit ``direction`` travels; a unit ``normal`` faces the side it comes from, so that
``direction . normal < 0``. Twin of ``snell.wgsl``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.optics.normal_momentum import normal_momentum_squared


class RefractResult(NamedTuple):
    """Refracted direction and whether there is one.

    Attributes
    ----------
    direction : (..., 3), unit; the unchanged incident direction where ``valid`` is false.
    valid : (...), bool; false under total internal reflection.
    """

    direction: NDArray[np.float64]
    valid: NDArray[np.bool_]


def reflect(direction: ArrayLike, normal: ArrayLike) -> NDArray[np.float64]:
    """Mirror a direction, d - 2 (d.n) n [timonen2006, eq. 14, sign corrected; born1999, 1.5.1].

    Parameters
    ----------
    direction, normal : (..., 3), unit.

    Returns
    -------
    (..., 3), unit. The sign of the normal does not matter.
    """
    d, n = np.asarray(direction, float), np.asarray(normal, float)
    return d - 2.0 * np.sum(d * n, axis=-1, keepdims=True) * n


def refract(direction: ArrayLike, normal: ArrayLike, n_i: ArrayLike, n_t: ArrayLike) -> RefractResult:
    """Refract a direction by Snell's law in vector form [timonen2006, eq. 17; born1999, 1.5.1].

    With c = -d.n and q = n_t cos_t = sqrt(n_t^2 - n_i^2 + (n_i c)^2), the law
    ``eta d + (eta c - cos_t) n``, eta = n_i/n_t, reads ``(n_i (d + c n) - q n) / n_t``.
    In this form nothing cancels when the two indices are close, or equal at grazing incidence.

    Parameters
    ----------
    direction, normal : (..., 3), unit, ``direction . normal < 0``.
    n_i, n_t : (...), index on the side the ray comes from, and on the side it goes to; > 0.

    Returns
    -------
    RefractResult; valid iff q^2 >= 0, otherwise total reflection and the incident direction.
    """
    d, n = np.asarray(direction, float), np.asarray(normal, float)
    n_i, n_t = np.asarray(n_i, float)[..., None], np.asarray(n_t, float)[..., None]
    c = -np.sum(d * n, axis=-1, keepdims=True)
    q_squared = normal_momentum_squared(c, n_i, n_t)
    q = np.sqrt(np.maximum(q_squared, 0.0))
    refracted = (n_i * (d + c * n) - q * n) / n_t
    valid = q_squared >= 0.0
    return RefractResult(np.where(valid, refracted, d), valid[..., 0])


def critical_angle(n_i: ArrayLike, n_t: ArrayLike) -> NDArray[np.float64]:
    """Angle of incidence beyond which reflection is total, sin = n_t/n_i [born1999, 1.5.4].

    Parameters
    ----------
    n_i, n_t : (...), indices of the incident and the transmitting side, > 0.

    Returns
    -------
    (...), rad, in (0, pi/2]; pi/2 (never reached from inside) where n_i <= n_t.
    """
    return np.arcsin(np.minimum(np.asarray(n_t, float) / np.asarray(n_i, float), 1.0))
