"""Graded-index media as functions `n(x, y, z)` of metres, for `Volume.from_function`."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.errors import SceneError

from .primitives import Shape, positive


def luneburg(radius_m: float) -> Shape:
    """Luneburg's lens, n^2 = 2 - (r/R)^2 inside, 1 outside [luneburg1944].

    Parallel rays meet at the far point of the rim. The index is continuous at the surface.
    """
    radius = positive("radius_m", radius_m)
    return lambda x, y, z: np.sqrt(2.0 - np.minimum((x * x + y * y + z * z) / radius**2, 1.0))


def maxwell_fish_eye(radius_m: float) -> Shape:
    """Maxwell's fish-eye, n = 2 / (1 + (r/R)^2) inside, 1 outside [maxwell1854].

    Every ray is an arc of a circle; a point of the surface is imaged to the opposite one.
    """
    radius = positive("radius_m", radius_m)
    return lambda x, y, z: 2.0 / (1.0 + np.minimum((x * x + y * y + z * z) / radius**2, 1.0))


def grin_rod(n0: float, g_per_m: float, radius_m: float) -> Shape:
    """Graded-index rod along z, n^2 = n0^2 (1 - (g r)^2), r the distance from the axis [born1999].

    Rays are sinusoids of pitch 2 pi p_z / (n0 g) along z. Beyond the radius the rim's index goes on.

    Parameters
    ----------
    n0 : index on the axis.
    g_per_m : gradient constant, 1/m.
    radius_m : of the rod; g times radius must be less than 1.
    """
    radius, g = positive("radius_m", radius_m), positive("g_per_m", g_per_m)
    if n0 <= 0.0 or g * radius >= 1.0:
        raise SceneError("n0, g_per_m, radius_m", "make the index vanish within the rod", "use g r < 1")
    return lambda x, y, z: n0 * np.sqrt(1.0 - g * g * np.minimum(x * x + y * y, radius * radius) + 0.0 * z)


def hot_air(
    width_m: float,
    height_m: float,
    warmer_k: float = 60.0,
    ambient_k: float = 293.15,
    refractivity: float = 2.72e-4,
    sway: float = 0.35,
) -> Shape:
    """Warm air rising along y from the bottom of a box of some height, centred on the origin.

    n - 1 is proportional to density [gladstone1863], and at constant pressure density to 1/T:
    n = 1 + refractivity * ambient / T. The plume's excess of temperature is a Gaussian that widens linearly
    and cools as its width grows (the heat it carries stays the same), and sways.

    Parameters
    ----------
    width_m : standard deviation of the temperature at the bottom.
    height_m : of the box.
    warmer_k : how much warmer than ambient the axis is at the bottom.
    ambient_k : temperature far away.
    refractivity : n - 1 of the ambient air; 2.72e-4 is dry air at 20 C, 1013 hPa, 589 nm [ciddor1996].
    sway : how far the axis wanders at the top, in widths.
    """
    width, height = positive("width_m", width_m), positive("height_m", height_m)
    ambient = positive("ambient_k", ambient_k)
    if warmer_k <= -ambient:
        raise SceneError("warmer_k", f"is {warmer_k}", "the plume would be below absolute zero")

    def index(x: Any, y: Any, z: Any) -> Any:
        up = np.clip(y / height + 0.5, 0.0, 1.0)
        spread = width * (1.0 + up)
        ax = sway * width * up * np.sin(2.0 * np.pi * 1.3 * up)
        az = sway * width * up * np.sin(2.0 * np.pi * 0.9 * up + 1.0)
        across = ((x - ax) ** 2 + (z - az) ** 2) / (2.0 * spread**2)
        excess = warmer_k * (width / spread) ** 2 * np.exp(-across)
        return 1.0 + refractivity * ambient / (ambient + excess)

    return index
