"""How fast water waves swing and travel: omega^2 = (g k + gamma k^3 / rho) tanh(k d) [landau1987, 12, 62]."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GRAVITY_M_S2 = 9.81
#: Surface tension over density of clean water at 20 degrees, m^3/s^2.
TENSION_M3_S2 = 7.28e-5


def angular_frequency(k_per_m: npt.ArrayLike, depth_m: float = np.inf) -> Array:
    """omega, rad/s, of waves of wave number k over water of a depth."""
    k = np.abs(np.asarray(k_per_m, np.float64))
    return np.asarray(np.sqrt(_restoring(k) * np.tanh(_depths(k, depth_m))))


def group_speed(k_per_m: npt.ArrayLike, depth_m: float = np.inf) -> Array:
    """d omega / d k, m/s, at wave numbers > 0."""
    k = np.abs(np.asarray(k_per_m, np.float64))
    kd = _depths(k, depth_m)
    slope = (GRAVITY_M_S2 + 3.0 * TENSION_M3_S2 * k * k) * np.tanh(kd)
    if np.isfinite(depth_m):
        slope = slope + _restoring(k) * depth_m / np.cosh(kd) ** 2
    return np.asarray(slope / (2.0 * angular_frequency(k, depth_m)))


def phase_speed(k_per_m: npt.ArrayLike, depth_m: float = np.inf) -> Array:
    """omega / k, m/s, at wave numbers > 0: sqrt(g d) for long waves, least at 1.7 cm."""
    k = np.abs(np.asarray(k_per_m, np.float64))
    return np.asarray(angular_frequency(k, depth_m) / k)


def _restoring(k: Any) -> Any:
    return GRAVITY_M_S2 * k + TENSION_M3_S2 * k**3


def _depths(k: Any, depth_m: float) -> Any:
    """k d, no more than where tanh is 1 and cosh does not overflow yet."""
    return np.full_like(k, 50.0) if np.isinf(depth_m) else np.minimum(k * depth_m, 50.0)
