"""Shape of a drop of water that lies on a plane: contact angle, volume, gravity, and drops that touch."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]

#: Water at 20 degrees: density, kg/m^3; surface tension, N/m; and of free fall, m/s^2.
DENSITY = 998.2
SURFACE_TENSION = 0.0728
GRAVITY = 9.81
#: Slope of the surface beyond the apron of a drop.
PLUNGE = 12.0
#: sqrt(surface tension / (density g)), metres [degennes2004, 2.2].
CAPILLARY_LENGTH_M = float(np.sqrt(SURFACE_TENSION / (DENSITY * GRAVITY)))


def cap_volume(rim_m: Values | float, contact_angle: float) -> Values:
    """Volume of a spherical cap on a plane, cubic metres [degennes2004, 1.1].

    pi r^3 (2 - 3 cos + cos^3) / (3 sin^3), r the radius of its rim.
    """
    cos, sin = np.cos(contact_angle), np.sin(contact_angle)
    return np.asarray(np.pi * np.asarray(rim_m) ** 3 * (2.0 - 3.0 * cos + cos**3) / (3.0 * sin**3))


def highest_m(contact_angle: float) -> float:
    """Height of a wide puddle, 2 a sin(theta / 2), a the capillary length [degennes2004, 2.2]; no drop is higher."""
    return float(2.0 * CAPILLARY_LENGTH_M * np.sin(0.5 * contact_angle))


def meniscus(within: Values, rim_m: Values | float, contact_angle: float, apron_m: float = np.inf) -> Values:
    """Height of a drop over the plane that it lies on, metres; outside of its rim the tangent goes on downwards.

    With R = r / sin(theta) a spherical cap is h = sqrt(R^2 - rho^2) - R cos(theta). Written with
    F = (r^2 - rho^2) / (2 r), which falls by one metre a metre at the rim, it is

        h = sqrt((r / tan(theta))^2 + 2 r F) - r / tan(theta)

    and F may come from several drops that merge: dh/dF = tan(theta) wherever F = 0. Gravity keeps drops lower than
    `highest_m`, and leaves the rim as it is: (1 / h^3 + 1 / highest^3)^(-1/3).

    Parameters
    ----------
    within : F, metres, negative outside. rim_m : r, metres. contact_angle : theta, radians, below a right angle.
    apron_m : so far outside of the rim the tangent goes on; then the surface plunges, `PLUNGE` metres a metre. A texel
        or two let interpolation between texels find the rim and its slope; more would fill joints of the ground nearby.
    """
    flat = np.asarray(rim_m) / np.tan(contact_angle)
    cap = np.sqrt(flat * flat + 2.0 * rim_m * np.maximum(within, 0.0)) - flat
    cap = cap / np.cbrt(1.0 + (cap / highest_m(contact_angle)) ** 3)
    outside = within * np.tan(contact_angle) + PLUNGE * np.minimum(within + apron_m, 0.0)
    return np.where(within > 0.0, cap, outside)


def rims_of(volumes_m3: npt.ArrayLike, contact_angle: float) -> Values:
    """Radius of the rim of round drops of given volumes, metres: the inverse of the integral of `meniscus`."""
    return looked_up(volumes_m3, *rim_table(contact_angle))


def rim_table(contact_angle: float) -> tuple[Values, Values]:
    """Logarithms of volumes and of the rims that belong to them, for `looked_up`: made once, asked often."""
    rims = np.geomspace(1e-6, 0.1, 200)
    share = (np.arange(400) + 0.5) / 400
    rho = rims[:, None] * share
    heights = meniscus((rims[:, None] ** 2 - rho**2) / (2.0 * rims[:, None]), rims[:, None], contact_angle)
    volumes = (2.0 * np.pi * rho * heights).sum(axis=1) * rims / 400
    return np.log(volumes), np.log(rims)


def looked_up(volumes_m3: npt.ArrayLike, log_volumes: Values, log_rims: Values) -> Values:
    """Rims of volumes from a `rim_table`, metres."""
    logs = np.log(np.maximum(np.asarray(volumes_m3, dtype=np.float64), 1e-30))
    return np.asarray(np.exp(np.interp(logs, log_volumes, log_rims)))


def merge(within: Values, rim: Values, rho: Values, radius: float, width: float) -> None:
    """Add a round drop to F and to the radii of rims, in place, by a maximum that is smooth over `width` radii.

    The maximum has a continuous second derivative [quilez2013], or a mirrored lamp would show where drops have met.

    Parameters
    ----------
    within, rim : F and r of `meniscus` so far. rho : distance from the middle of the new drop, metres.
    """
    # Outside the distance itself: it falls by a metre a metre everywhere, so that merged rims keep their slope.
    new = np.where(rho < radius, (radius * radius - rho * rho) / (2.0 * radius), radius - rho)
    over = width * np.minimum(rim, radius)
    apart = (new - within) / over
    t = np.clip(0.5 + 0.5 * apart, 0.0, 1.0)
    within[:] = np.maximum(within, new) + over * np.clip(1.0 - np.abs(apart), 0.0, 1.0) ** 3 / 6.0
    rim[:] = rim + t * t * (3.0 - 2.0 * t) * (radius - rim)


def check_angle(name: str, degrees: Any) -> float:
    """Radians of a contact angle from 5 to 85 degrees, or SceneError."""
    from pellucid.errors import SceneError

    if isinstance(degrees, bool) or not isinstance(degrees, int | float | np.integer | np.floating):
        raise SceneError(name, f"is {degrees!r}", "use 5 to 85 degrees")
    if not 5.0 <= degrees <= 85.0:
        raise SceneError(name, f"is {float(degrees):g}", "use 5 to 85 degrees")
    return float(np.radians(degrees))
