"""How much of the sea swings how fast, and in which directions: spectra of wind waves.

A frequency spectrum S(omega), m^2 s, integrates to the variance of the heights. With the spreading D(omega, theta),
which integrates to 1 over all directions, waves of the wave vector k have psi(k) = S D / k d omega / d k, m^4.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.waves import arguments
from pellucid.fields.waves.dispersion import GRAVITY_M_S2, angular_frequency, group_speed

Array = npt.NDArray[np.float64]
SPECTRA = ("phillips", "pierson-moskowitz", "jonswap", "tma")
SPREADINGS = ("cosine", "hasselmann", "donelan")
#: Energy of the shortest waves that gravity makes [phillips1958]; what [tessendorf2001, eq. 23] leaves open as A.
PHILLIPS = 0.0081
#: Wind at 19.5 m, where [pierson1964] measured, over wind at 10 m.
AT_19_5_M = 1.026
#: Fetch over wind^2 / g beyond which a sea grows no more: its peak is then at 0.855 g / wind.
GROWN_OUT = 1.7e4


def frequency_spectrum(
    omega: npt.ArrayLike, wind_m_s: float, name: str = "jonswap", fetch_m: float = 100e3, depth_m: float = np.inf
) -> Array:
    """S(omega), m^2 s, of frequencies > 0.

    Parameters
    ----------
    omega : rad/s. wind_m_s : at 10 m over the water, > 0.
    name : ``"pierson-moskowitz"``, a sea that has grown out [pierson1964]; ``"jonswap"``, one that has grown over
        `fetch_m` [hasselmann1973]; ``"tma"``, that over water of `depth_m` [bouws1985]; ``"phillips"``, the spectrum
        of [tessendorf2001, eq. 23] over deep water.
    """
    w = np.asarray(omega, np.float64)
    if name == "phillips":
        # psi = A/2 exp(-1/(k L)^2) / k^4, L = V^2/g; S = k psi dk/domega, k = omega^2/g
        swell = (GRAVITY_M_S2 / (wind_m_s * w)) ** 4
        return np.asarray(PHILLIPS * GRAVITY_M_S2**2 / w**5 * np.exp(-swell))
    if name == "pierson-moskowitz":
        cut = 0.74 * (GRAVITY_M_S2 / (AT_19_5_M * wind_m_s * w)) ** 4
        return np.asarray(PHILLIPS * GRAVITY_M_S2**2 / w**5 * np.exp(-cut))
    peak = peak_frequency(wind_m_s, name, fetch_m)
    fetch_m = min(fetch_m, GROWN_OUT * wind_m_s**2 / GRAVITY_M_S2)
    energy = 0.076 * (wind_m_s**2 / (fetch_m * GRAVITY_M_S2)) ** 0.22
    width = np.where(w <= peak, 0.07, 0.09)
    sharper = 3.3 ** np.exp(-((w - peak) ** 2) / (2.0 * (width * peak) ** 2))
    spectrum = energy * GRAVITY_M_S2**2 / w**5 * np.exp(-1.25 * (peak / w) ** 4) * sharper
    return np.asarray(spectrum * (depth_factor(w, depth_m) if name == "tma" else 1.0))


def peak_frequency(wind_m_s: float, name: str = "jonswap", fetch_m: float = 100e3) -> float:
    """Frequency with most energy, rad/s."""
    if name == "phillips":
        return float((0.8) ** 0.25 * GRAVITY_M_S2 / wind_m_s)
    if name == "pierson-moskowitz":
        return float((0.8 * 0.74) ** 0.25 * GRAVITY_M_S2 / (AT_19_5_M * wind_m_s))
    fetch_m = min(fetch_m, GROWN_OUT * wind_m_s**2 / GRAVITY_M_S2)
    return float(22.0 * (GRAVITY_M_S2**2 / (wind_m_s * fetch_m)) ** (1.0 / 3.0))


def depth_factor(omega: npt.ArrayLike, depth_m: float) -> Array:
    """Share of a spectrum that shallow water leaves, tanh^2(k d) / (1 + 2 k d / sinh(2 k d)) [bouws1985, eq. 2]."""
    w = np.asarray(omega, np.float64)
    if np.isinf(depth_m):
        return np.ones_like(w)
    kd = np.minimum(wave_number(w, depth_m) * depth_m, 50.0)
    return np.asarray(np.tanh(kd) ** 2 / (1.0 + 2.0 * kd / np.sinh(2.0 * kd)))


def wave_number(omega: npt.ArrayLike, depth_m: float = np.inf) -> Array:
    """k, 1/m, of frequencies > 0: the dispersion relation turned round by Newton's steps in log k."""
    w = np.asarray(omega, np.float64)
    k = np.maximum(w * w / GRAVITY_M_S2, w / np.sqrt(GRAVITY_M_S2 * min(depth_m, 1e9)))
    for _ in range(40):
        found = angular_frequency(k, depth_m)
        k = k * np.exp((w - found) / (k * group_speed(k, depth_m)))
    return np.asarray(k)


def spreading(omega: Array, theta: Array, peak: float, wind_m_s: float, name: str = "hasselmann") -> Array:
    """D(omega, theta), 1/rad, theta from the direction of the wind, -pi to pi.

    ``"cosine"``: 2/pi cos^2 theta, nothing against the wind [tessendorf2001, eq. 23]; ``"hasselmann"``: cos^2s(theta/2)
    with a measured s [hasselmann1980]; ``"donelan"``: sech^2(b theta) with a measured b [donelan1985].
    """
    share = omega / peak
    if name == "cosine":
        return np.asarray(np.where(np.abs(theta) < 0.5 * np.pi, 2.0 / np.pi * np.cos(theta) ** 2, 0.0))
    if name == "donelan":
        broad = 10.0 ** (-0.4 + 0.8393 * np.exp(-0.567 * np.log(np.maximum(share, 1.6) ** 2)))
        middle = np.where(share < 0.95, 2.61 * np.maximum(share, 0.56) ** 1.3, 2.28 * share**-1.3)
        b = np.where(share > 1.6, broad, middle)
        return np.asarray(b / (2.0 * np.tanh(b * np.pi)) / np.cosh(b * theta) ** 2)
    from scipy.special import gammaln

    age = wind_m_s * peak / GRAVITY_M_S2
    s = np.where(share <= 1.0, 6.97 * share**4.06, 9.77 * share ** (-2.33 - 1.45 * (age - 1.17)))
    s = np.clip(s, 0.0, 200.0)
    norm = (2.0 * s - 1.0) * np.log(2.0) - np.log(np.pi) + 2.0 * gammaln(s + 1.0) - gammaln(2.0 * s + 1.0)
    return np.asarray(np.exp(norm) * np.abs(np.cos(0.5 * theta)) ** (2.0 * s))


def vector_spectrum(
    k_x: npt.ArrayLike,
    k_z: npt.ArrayLike,
    wind_m_s: float,
    wind_deg: float = 0.0,
    name: str = "jonswap",
    fetch_m: float = 100e3,
    depth_m: float = np.inf,
    spread: str = "hasselmann",
) -> Array:
    """psi(k), m^4, of wave vectors k in 1/m, zero at k = 0: integrates over all of them to the variance in m^2."""
    k: Array = np.hypot(k_x, k_z)
    if wind_m_s == 0.0:
        return np.zeros_like(k)
    own_depth = depth_m if name == "tma" else np.inf
    k_safe = np.where(k > 0.0, k, 1.0)
    omega = angular_frequency(k_safe, own_depth)
    theta = np.remainder(np.arctan2(k_z, k_x) - np.radians(wind_deg) + np.pi, 2.0 * np.pi) - np.pi
    around = spreading(omega, theta, peak_frequency(wind_m_s, name, fetch_m), wind_m_s, spread)
    along = frequency_spectrum(omega, wind_m_s, name, fetch_m, depth_m)
    return np.where(k > 0.0, along * around * group_speed(k_safe, own_depth) / k_safe, 0.0)


def variance(wind_m_s: float, name: str = "jonswap", fetch_m: float = 100e3, depth_m: float = np.inf) -> float:
    """Integral of S, m^2: four times its root is the significant height. By the trapezoidal rule in log omega."""
    if wind_m_s == 0.0:
        return 0.0
    logs = np.linspace(-2.0, 4.0, 4001) + np.log(peak_frequency(wind_m_s, name, fetch_m))
    omega = np.exp(logs)
    density: Any = frequency_spectrum(omega, wind_m_s, name, fetch_m, depth_m) * omega
    return float(((density[1:] + density[:-1]) * 0.5 * np.diff(logs)).sum())


def slope_variance(wind_m_s: float) -> tuple[float, float]:
    """Mean squares of slopes along and across the wind, waves of all lengths of a clean sea [cox1954, eq. 8].

    Ripples across the wind fade below 1 m/s, where nothing was measured.
    """
    return 3.16e-3 * wind_m_s, 0.003 * min(wind_m_s, 1.0) + 1.92e-3 * wind_m_s


def checked(wind_m_s: float, name: str, spread: str, fetch_m: float, depth_m: float) -> None:
    """Raise a SceneError for what these spectra do not hold for."""
    arguments.number("wind_m_s", wind_m_s, low=0.0, high=80.0)
    arguments.choice("spectrum", name, SPECTRA)
    arguments.choice("spreading", spread, SPREADINGS)
    arguments.number("fetch_m", fetch_m, low=1.0, high=1e8)
    if np.isfinite(arguments.depth("depth_m", depth_m)) and name != "tma":
        raise SceneError("depth_m", f"is {depth_m:g} with the spectrum {name!r}", 'use "tma" over water of a depth')
