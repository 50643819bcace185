"""Daylight after Preetham, Shirley & Smits [preetham1999]: sky, sun, and a plain ground.

Radiance is stated in multiples of ``LUMINANCE_UNIT_CD_M2``, so that a white matt surface in full sun is
about 1 and needs no change of exposure.
"""

from __future__ import annotations

import numpy as np

from pellucid.scene import checks
from pellucid.scene.equirect import direction_at, pixel_directions, pixel_solid_angles

LUMINANCE_UNIT_CD_M2 = 25_000.0
SUN_TEMPERATURE_K = 5772.0
"""Nominal effective temperature of the sun, IAU 2015 resolution B3 [prsa2016]."""
SUN_SOLID_ANGLE_SR = np.pi * (6.957e8 / 1.495978707e11) ** 2
"""Nominal solar radius over the astronomical unit [prsa2016]."""
LUMINOUS_EFFICACY_LM_W = 683.0
RGB_FROM_XYZ = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
"""CIE 1931 XYZ to linear Rec.709 [iec61966]."""
HORIZON_BLUR_DEG = 0.6

# slope in turbidity, intercept: rows A to E of Perez's formula; [preetham1999, appendix A.2]
_PEREZ_Y = np.array([[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]])
_PEREZ_SMALL_X = np.array(
    [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]]
)
_PEREZ_SMALL_Y = np.array(
    [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]]
)
# rows T^2, T, 1; columns theta^3, theta^2, theta, 1
_ZENITH_X = np.array(
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]]
)
_ZENITH_Y = np.array(
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]]
)
# ozone absorption per centimetre at 450, 460 ... 770 nm; [preetham1999, table 2]
_OZONE_PER_CM = 0.001 * np.array(
    [
        *(3, 6, 9, 14, 21, 30, 40, 48, 63, 75, 85, 103, 120, 120, 115, 125, 120),
        *(105, 90, 79, 67, 57, 48, 36, 28, 23, 18, 14, 11, 10, 9, 7, 4),
    ]
)
_OZONE_CM = 0.35


def check_sky(elevation_deg: float, azimuth_deg: float, turbidity: float) -> None:
    """Raises SceneError unless the model holds for these values."""
    checks.number("environment.sun_elevation_deg", elevation_deg, low=0.0, high=90.0, unit="degrees")
    checks.number("environment.sun_azimuth_deg", azimuth_deg, low=-360.0, high=360.0, unit="degrees")
    checks.number(
        "environment.turbidity",
        turbidity,
        low=2.0,
        high=10.0,
        remedy="2 is mountain air, 3 a clear day, 6 haze; the model holds nowhere else",
    )


def sun_direction(elevation_deg: float, azimuth_deg: float) -> np.ndarray:
    """(3,) unit vector towards the sun; azimuth 0 is -Z, 90 is +X."""
    return direction_at(azimuth_deg, elevation_deg)


def sky_radiance(directions: np.ndarray, elevation_deg: float, azimuth_deg: float, turbidity: float) -> np.ndarray:
    """Radiance of the clear sky without the sun [preetham1999, section 4 and appendix A.2].

    Parameters
    ----------
    directions : (..., 3) unit vectors; those below the horizon are taken at it.
    elevation_deg, azimuth_deg : of the sun. turbidity : 2 to 10.

    Returns
    -------
    (..., 3) float64 linear Rec.709, in ``LUMINANCE_UNIT_CD_M2``.
    """
    theta_s = np.radians(90.0 - elevation_deg)
    cos_theta = np.maximum(directions[..., 1], 1e-3)
    cos_gamma = np.clip(directions @ sun_direction(elevation_deg, azimuth_deg), -1.0, 1.0)
    powers_t = np.array([turbidity**2, turbidity, 1.0])
    powers_theta = np.array([theta_s**3, theta_s**2, theta_s, 1.0])
    small_x, small_y, luminance = (
        zenith * _perez(table, turbidity, cos_theta, cos_gamma) / _perez(table, turbidity, 1.0, np.cos(theta_s))
        for table, zenith in (
            (_PEREZ_SMALL_X, powers_t @ _ZENITH_X @ powers_theta),
            (_PEREZ_SMALL_Y, powers_t @ _ZENITH_Y @ powers_theta),
            (_PEREZ_Y, _zenith_luminance(theta_s, turbidity)),
        )
    )
    xyz = np.stack([small_x / small_y, np.ones_like(small_x), (1.0 - small_x - small_y) / small_y], -1)
    return _rgb(xyz * (luminance / LUMINANCE_UNIT_CD_M2)[..., None])


def sun_irradiance(elevation_deg: float, turbidity: float) -> np.ndarray:
    """Irradiance of the sun on a surface that faces it [preetham1999, appendix A.1].

    Extinction by air, haze and ozone; water vapour and mixed gases, which hardly act on visible light,
    are left out.

    Returns
    -------
    (3,) float64 linear Rec.709, in ``LUMINANCE_UNIT_CD_M2`` steradian.
    """
    lambda_nm = np.arange(380.0, 781.0, 5.0)
    arriving = _planck(lambda_nm) * SUN_SOLID_ANGLE_SR * _transmittance(lambda_nm, elevation_deg, turbidity)
    xyz = LUMINOUS_EFFICACY_LM_W * 5e-9 * (_matching_functions(lambda_nm) @ arriving)
    return _rgb(xyz / LUMINANCE_UNIT_CD_M2)


def sky_map(
    elevation_deg: float,
    azimuth_deg: float,
    turbidity: float,
    *,
    sun_disc: bool,
    sun_diameter_deg: float,
    ground_albedo: tuple[float, float, float],
    width: int,
) -> np.ndarray:
    """(width / 2, width, 3) float64 equirectangular map of sky, sun and ground.

    The disc is as bright as needed for the irradiance to be that of the true sun, whatever its diameter
    and the size of a pixel. The ground reflects what sky and sun send down, as a matt surface.
    """
    height = width // 2
    directions, omega = pixel_directions(height, width), pixel_solid_angles(height, width)[..., None]
    sky = sky_radiance(directions, elevation_deg, azimuth_deg, turbidity)
    sun = sun_irradiance(elevation_deg, turbidity)
    up = np.maximum(directions[..., 1:2], 0.0)
    horizontal = (sky * up * omega).sum((0, 1)) + sun * np.sin(np.radians(elevation_deg))
    ground = np.asarray(ground_albedo) * horizontal / np.pi
    blur = max(np.radians(HORIZON_BLUR_DEG), np.pi / height)
    above = _smooth(0.5 + directions[..., 1:2] / (2.0 * blur))
    result = ground + (sky - ground) * above
    if sun_disc:
        result += _disc(directions, omega, sun_direction(elevation_deg, azimuth_deg), sun_diameter_deg) * sun
    return result


def _disc(directions: np.ndarray, omega: np.ndarray, towards: np.ndarray, diameter_deg: float) -> np.ndarray:
    """(H, W, 1) a disc one pixel soft at its edge, zero below the horizon, whose integral is 1."""
    pixel = np.pi / len(directions)
    radius = max(np.radians(diameter_deg) / 2.0, pixel)
    angle = 2.0 * np.arcsin(np.clip(np.linalg.norm(directions - towards, axis=-1, keepdims=True) / 2.0, 0.0, 1.0))
    weight = np.clip(0.5 + (radius - angle) / pixel, 0.0, 1.0) * (directions[..., 1:2] > 0.0)
    return np.asarray(weight / (weight * omega).sum())


def _perez(table: np.ndarray, turbidity: float, cos_theta: np.ndarray | float, cos_gamma: np.ndarray) -> np.ndarray:
    """Relative luminance of the sky [perez1993; preetham1999, eq. 3]."""
    a, b, c, d, e = table @ np.array([turbidity, 1.0])
    gamma = np.arccos(cos_gamma)
    return np.asarray((1.0 + a * np.exp(b / cos_theta)) * (1.0 + c * np.exp(d * gamma) + e * cos_gamma**2))


def _zenith_luminance(theta_s: float, turbidity: float) -> float:
    """Luminance of the zenith in cd/m^2 [preetham1999, appendix A.2]."""
    chi = (4.0 / 9.0 - turbidity / 120.0) * (np.pi - 2.0 * theta_s)
    return float(1000.0 * ((4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192))


def _transmittance(lambda_nm: np.ndarray, elevation_deg: float, turbidity: float) -> np.ndarray:
    """Share of sunlight that comes through the air [preetham1999, appendix A.1]."""
    lambda_um = lambda_nm / 1000.0
    zenith_deg = 90.0 - elevation_deg
    air_mass = 1.0 / (np.cos(np.radians(zenith_deg)) + 0.15 * (93.885 - zenith_deg) ** -1.253)
    rayleigh = 0.008735 * lambda_um**-4.08
    haze = (0.04608 * turbidity - 0.04586) * lambda_um**-1.3
    ozone = _OZONE_CM * np.interp(lambda_nm, np.arange(450.0, 771.0, 10.0), _OZONE_PER_CM, left=0.0, right=0.0)
    return np.asarray(np.exp(-(rayleigh + haze + ozone) * air_mass))


def _planck(lambda_nm: np.ndarray) -> np.ndarray:
    """Radiance of a black body as hot as the sun, W / (m^2 sr m) [planck1901]."""
    lambda_m = lambda_nm * 1e-9
    h, c, k = 6.62607015e-34, 2.99792458e8, 1.380649e-23
    return np.asarray(2.0 * h * c**2 / lambda_m**5 / np.expm1(h * c / (lambda_m * k * SUN_TEMPERATURE_K)))


def _matching_functions(lambda_nm: np.ndarray) -> np.ndarray:
    """CIE 1931 colour matching curves x, y, z, (3, N) [wyman2013, eq. 4]."""

    def lobe(height: float, peak: float, below: float, above: float) -> np.ndarray:
        width = np.where(lambda_nm < peak, below, above)
        return height * np.exp(-0.5 * ((lambda_nm - peak) / width) ** 2)

    return np.stack(
        [
            lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
            lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
            lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
        ]
    )


def _rgb(xyz: np.ndarray) -> np.ndarray:
    """Linear Rec.709 of XYZ; what lies outside the gamut is brought to its edge."""
    return np.asarray(np.maximum(xyz @ RGB_FROM_XYZ.T, 0.0))


def _smooth(t: np.ndarray) -> np.ndarray:
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
