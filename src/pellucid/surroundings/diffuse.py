"""Light from everywhere through a smooth interface over a matt base [saunderson1942], with absorption between."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from pellucid.optics import fresnel_dielectric
from pellucid.surroundings.layouts import DIFFUSE_ENTRIES

POINTS = 256


@lru_cache(maxsize=16)
def diffuse_tables(n_outside: float, n_layer: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """`diffuse_shares` at `DIFFUSE_ENTRIES` values of exp(-absorption depth) from 0 to 1, by channel.

    Parameters
    ----------
    n_outside, n_layer : indices; that of the layer for red, green, blue.

    Returns
    -------
    down, back : (DIFFUSE_ENTRIES, 4) float32, the last column unused.
    """
    y = np.linspace(0.0, 1.0, DIFFUSE_ENTRIES)
    down, back = np.zeros((DIFFUSE_ENTRIES, 4)), np.zeros((DIFFUSE_ENTRIES, 4))
    for channel, n in enumerate(np.asarray(n_layer, float) / n_outside):
        down[:, channel], back[:, channel] = diffuse_shares(float(n), y)
    return down.astype(np.float32), back.astype(np.float32)


def diffuse_shares(n: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shares of diffuse light that come down to the base, and back to it.

    With m the cosine in the layer, F its Fresnel reflectance from inside:

        down(y) = n^2 int (1 - F) y^(1/m) 2 m dm,        back(y) = int F y^(2/m) 2 m dm     over m from 0 to 1,

    the share of a uniform environment's irradiance that reaches the base, and of the light of a matt base the share
    that comes back. A layer without absorption has down(1) = n^2 (1 - back(1)): under it a white base sends out
    just what comes in.

    Parameters
    ----------
    n : index of the layer by that around it. y : (N,) exp(-absorption depth), 0 to 1.

    Returns
    -------
    down, back : (N,) float64.
    """
    m, weight = _cosines(n)
    f = fresnel_dielectric(m, n, 1.0)
    down = n * n * (weight * (1.0 - f) * y[:, None] ** (1.0 / m)).sum(axis=1)
    return down, (weight * f * y[:, None] ** (2.0 / m)).sum(axis=1)


def _cosines(n: float) -> tuple[np.ndarray, np.ndarray]:
    """Cosines in the layer and the weights 2 m dm, which add up to 1, divided where total reflection begins."""
    x, w = np.polynomial.legendre.leggauss(POINTS)
    critical = np.sqrt(max(1.0 - 1.0 / n**2, 0.0)) if n > 1.0 else 0.0
    m, dm = [], []
    for low, high in ((0.0, critical), (critical, 1.0)):
        if high > low:
            s = 0.5 * (x + 1.0)  # m = low + (high - low) s^2 resolves the root at the critical angle
            m.append(low + (high - low) * s**2)
            dm.append((high - low) * s * w)
    cosines = np.concatenate(m)
    return cosines, 2.0 * cosines * np.concatenate(dm)
