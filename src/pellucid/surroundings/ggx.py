"""Twin of `shaders/ggx.wgsl`, and what its lobe reflects in all directions together."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def ggx_distribution(n_dot_h: npt.ArrayLike, alpha: npt.ArrayLike) -> np.ndarray:
    """Normal distribution [walter2007, eq. 33], 1/sr."""
    a2 = np.square(alpha)
    d = np.square(n_dot_h) * (a2 - 1.0) + 1.0
    return np.asarray(a2 / (np.pi * d * d))


def ggx_visibility(n_dot_l: npt.ArrayLike, n_dot_v: npt.ArrayLike, alpha: npt.ArrayLike) -> np.ndarray:
    """Height-correlated Smith shadowing over 4 (n.l)(n.v) [heitz2014, eq. 99]."""
    to, fro, a2 = np.asarray(n_dot_l), np.asarray(n_dot_v), np.square(alpha)
    return np.asarray(0.5 / (fro * np.sqrt(to * to * (1 - a2) + a2) + to * np.sqrt(fro * fro * (1 - a2) + a2)))


def ggx_directional_albedo(n_dot_v: npt.ArrayLike, alpha: npt.ArrayLike) -> np.ndarray:
    """Share of light that facets which reflect everything send back after one reflection, by quadrature.

    n_dot_v, alpha : (N,) each, above 0. Over half vectors: dl = 4 (v.h) dh, sampled in proportion to D cos.
    """
    mu, a = np.broadcast_arrays(np.atleast_1d(np.asarray(n_dot_v, float)), np.atleast_1d(np.asarray(alpha, float)))
    mu, a = mu[:, None, None], a[:, None, None]
    u = (np.arange(96) + 0.5) / 96
    theta = np.arctan(a * np.sqrt(u / (1 - u))[:, None])
    turn = (np.arange(48) + 0.5) / 48 * np.pi
    v_dot_h = np.sqrt(np.maximum(1 - mu**2, 0)) * np.sin(theta) * np.cos(turn) + mu * np.cos(theta)
    n_dot_l = 2 * v_dot_h * np.cos(theta) - mu
    seen = (v_dot_h > 0) & (n_dot_l > 0)
    sent = ggx_visibility(np.where(seen, n_dot_l, 1.0), mu, a) * 4 * n_dot_l * v_dot_h / np.cos(theta)
    return np.asarray(np.where(seen, sent, 0.0).mean(axis=(1, 2)))
