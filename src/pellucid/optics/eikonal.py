"""One step of a ray in a field of refractive index. Twin of ``eikonal.wgsl``.

The state is a position ``x`` and the optical momentum ``p = n d``, |p| = n. In the parameter
sigma, dsigma = ds/n, the ray equations separate, dx/dsigma = p and dp/dsigma = n grad n
[sharma1982], so that leapfrog is explicit, of second order, and reversible. The Euler
form in the arc length s is kept for comparison. Two functions take the field as a callback and
therefore exist in Python only: :func:`leapfrog_step` and :func:`euler_step` spell out how the
primitives, which both languages share, are composed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vectors = NDArray[np.float64]
Field = Callable[[Vectors], tuple[NDArray[np.float64], Vectors]]
"""Maps positions (..., 3), m, to the index (...) and its gradient (..., 3), 1/m."""


def drift(x: ArrayLike, p: ArrayLike, dsigma: ArrayLike) -> Vectors:
    """Move along the momentum, dx/dsigma = p [sharma1982].

    Parameters
    ----------
    x : (..., 3), position, m.
    p : (..., 3), optical momentum.
    dsigma : (...), step, m; the arc length is n dsigma.

    Returns
    -------
    (..., 3), new position, m.
    """
    return np.asarray(x, float) + np.asarray(dsigma, float)[..., None] * np.asarray(p, float)


def kick(p: ArrayLike, n: ArrayLike, grad_n: ArrayLike, dsigma: ArrayLike) -> Vectors:
    """Bend the momentum, dp/dsigma = n grad n = grad(n^2)/2 [sharma1982].

    Parameters
    ----------
    p : (..., 3), optical momentum.
    n : (...), index where the ray is.
    grad_n : (..., 3), its gradient, 1/m.
    dsigma : (...), step, m.

    Returns
    -------
    (..., 3), new momentum.
    """
    weight = np.asarray(dsigma, float) * np.asarray(n, float)
    return np.asarray(p, float) + weight[..., None] * np.asarray(grad_n, float)


def leapfrog_step(x: ArrayLike, p: ArrayLike, dsigma: ArrayLike, field: Field) -> tuple[Vectors, Vectors]:
    """Half drift, kick, half drift: the Stoermer-Verlet step [hairer2003, section 1].

    One look-up of the field a step; second order; undone by the same step with p reversed.

    Parameters
    ----------
    x, p : (..., 3), position, m, and optical momentum.
    dsigma : (...), step, m.
    field : index and gradient at given positions.

    Returns
    -------
    New position and momentum, (..., 3) each.
    """
    half = 0.5 * np.asarray(dsigma, float)
    middle = drift(x, p, half)
    n, grad_n = field(middle)
    p = kick(p, n, grad_n, dsigma)
    return drift(middle, p, half), p


def euler_position(x: ArrayLike, p: ArrayLike, n: ArrayLike, ds: ArrayLike) -> Vectors:
    """Euler step of dx/ds = p/n [tevs2007, eq. 4.8].

    Parameters
    ----------
    x, p : (..., 3), position, m, and optical momentum.
    n : (...), index where the ray is.
    ds : (...), arc length, m.

    Returns
    -------
    (..., 3), new position, m.
    """
    return drift(x, p, np.asarray(ds, float) / np.asarray(n, float))


def euler_momentum(p: ArrayLike, grad_n: ArrayLike, ds: ArrayLike) -> Vectors:
    """Euler step of dp/ds = grad n [tevs2007, eq. 4.9].

    Parameters
    ----------
    p : (..., 3), optical momentum.
    grad_n : (..., 3), gradient of the index, 1/m.
    ds : (...), arc length, m.

    Returns
    -------
    (..., 3), new momentum.
    """
    return np.asarray(p, float) + np.asarray(ds, float)[..., None] * np.asarray(grad_n, float)


def euler_step(x: ArrayLike, p: ArrayLike, ds: ArrayLike, field: Field) -> tuple[Vectors, Vectors]:
    """Explicit Euler step in the arc length [tevs2007, eq. 5.11-5.12], first order.

    Parameters
    ----------
    x, p : (..., 3), position, m, and optical momentum.
    ds : (...), arc length, m.
    field : index and gradient at given positions.

    Returns
    -------
    New position and momentum, (..., 3) each, both from the values at the start of the step.
    """
    n, grad_n = field(np.asarray(x, float))
    return euler_position(x, p, n, ds), euler_momentum(p, grad_n, ds)
