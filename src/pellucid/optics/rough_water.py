"""Light of a surface whose slopes are normally distributed, such as the sea. Twin of ``rough_water.wgsl``.

Directions are unit vectors away from the surface, y up, towards the viewer and towards the light. Slopes (dh/dx, dh/dz)
have a mean and the covariance `variance`: xx, zz, xz.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_TINY = 1e-24
# Least cosine of the normal of a facet of water with y, about 80 degrees: where it is upright a lamp fills all slopes.
_STEEPEST = 0.2


def slope_density(offset: ArrayLike, variance: ArrayLike) -> Array:
    """Normal density of slopes `offset` (..., 2) from their mean, per unit of slope squared [cox1954, eq. 7]."""
    x, z = np.moveaxis(np.asarray(offset, float), -1, 0)
    xx, zz, xz = np.moveaxis(np.asarray(variance, float), -1, 0)
    determinant = np.maximum(xx * zz - xz * xz, _TINY)
    square = (zz * x * x - 2.0 * xz * x * z + xx * z * z) / determinant
    return np.asarray(np.exp(-0.5 * square) / (2.0 * np.pi * np.sqrt(determinant)))


def gaussian_below(a: ArrayLike) -> Array:
    """Share of a normal distribution below `a` standard deviations, to 1.5e-7 [abramowitz1964, 7.1.26]."""
    a = np.asarray(a, float)
    x = np.abs(a) * np.sqrt(0.5)
    t = 1.0 / (1.0 + 0.3275911 * x)
    series = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t
    tail = 0.5 * series * np.exp(-x * x)
    return np.where(a < 0.0, tail, 1.0 - tail)


def slope_spread(direction: ArrayLike, variance: ArrayLike) -> Array:
    """Standard deviation of d.y - slope . d.xz, the area of facets that is seen: sqrt(d_xz variance d_xz)."""
    d, v = np.asarray(direction, float), np.asarray(variance, float)
    x, z = d[..., 0], d[..., 2]
    return np.asarray(np.sqrt(np.maximum(v[..., 0] * x * x + v[..., 1] * z * z + 2.0 * v[..., 2] * x * z, 0.0)))


def visible_area(direction: ArrayLike, slope: ArrayLike, variance: ArrayLike) -> Array:
    """Area of facets that face a direction, seen from there, for each area of ground: E[max(d.y - s . d.xz, 0)].

    With a = mean / spread it is spread (phi(a) + a Phi(a)), [smith1967] in closed form; the mean cosine where all
    facets face it.
    """
    d, s = np.asarray(direction, float), np.asarray(slope, float)
    mean = d[..., 1] - s[..., 0] * d[..., 0] - s[..., 1] * d[..., 2]
    spread = np.maximum(slope_spread(d, variance), 1e-6)
    a = np.clip(mean / spread, -10.0, 10.0)
    bell = np.exp(-0.5 * a * a) / np.sqrt(2.0 * np.pi)
    return np.asarray(np.where(mean > 10.0 * spread, mean, spread * (bell + a * gaussian_below(a))))


def visible_slope(direction: ArrayLike, slope: ArrayLike, variance: ArrayLike) -> Array:
    """(..., 2) mean slope of what is seen from a direction: slope - variance d_xz Phi(a) / visible_area.

    From Stein's lemma, E[(s - mean) w(s)] = variance E[grad w], of the areas w that are seen.
    """
    d, s, v = (np.asarray(one, float) for one in (direction, slope, variance))
    mean = d[..., 1] - s[..., 0] * d[..., 0] - s[..., 1] * d[..., 2]
    a = np.clip(mean / np.maximum(slope_spread(d, v), 1e-6), -10.0, 10.0)
    share = gaussian_below(a) / np.maximum(visible_area(d, s, v), 1e-6)
    moved = np.stack([v[..., 0] * d[..., 0] + v[..., 2] * d[..., 2], v[..., 2] * d[..., 0] + v[..., 1] * d[..., 2]], -1)
    return np.asarray(s - share[..., None] * moved)


def facet_normal(view: ArrayLike, light: ArrayLike, n_view: ArrayLike, n_light: ArrayLike) -> Array:
    """(..., 3) vector, not unit, along the normal of facets that send light to the viewer; y > 0 where there are any.

    On one side of the surface (y of one sign) v + l: they mirror. Else -(n_view v + n_light l), towards the smaller
    index: they refract [walter2007, eq. 16].
    """
    v, light = np.asarray(view, float), np.asarray(light, float)
    mirrors = (v[..., 1] * light[..., 1] > 0.0)[..., None]
    refracts = -(np.asarray(n_view, float)[..., None] * v + np.asarray(n_light, float)[..., None] * light)
    return np.where(mirrors, v + light, refracts)


def disc_variance(light: ArrayLike, facet: ArrayLike, radius: ArrayLike, n_light: ArrayLike) -> Array:
    """(..., 3) covariance xx, zz, xz of the facets that show the points of a disc about a light.

    Parameters
    ----------
    facet : (..., 3) of `facet_normal`. radius : tangent of the disc's half angle; the mean square along any axis is
        radius^2 / 4, of a normal distribution in its place. n_light : index on the side of the light; 1 if mirrored.
    """
    towards, m = np.asarray(light, float), np.asarray(facet, float)
    up = np.where(np.abs(m[..., 1]) < _STEEPEST * np.linalg.norm(m, axis=-1), _STEEPEST, m[..., 1])
    zeta_x, zeta_z = -m[..., 0] / up, -m[..., 2] / up
    # A change of the light by q moves the facet's slopes by -(q_xz + zeta q_y) n / m_y.
    one = np.stack([np.ones_like(zeta_x), zeta_x, np.zeros_like(zeta_x)], -1)
    two = np.stack([np.zeros_like(zeta_z), zeta_z, np.ones_like(zeta_z)], -1)
    c_1, c_2 = (one * towards).sum(-1), (two * towards).sum(-1)
    scale = (0.5 * np.asarray(radius, float) * np.asarray(n_light, float) / up) ** 2
    products = (one * one).sum(-1) - c_1 * c_1, (two * two).sum(-1) - c_2 * c_2, (one * two).sum(-1) - c_1 * c_2
    return np.stack([scale * one for one in products], -1)


def glint(
    view: ArrayLike,
    light: ArrayLike,
    slope: ArrayLike,
    variance: ArrayLike,
    n_view: ArrayLike,
    n_light: ArrayLike,
) -> Array:
    """Radiance over the light's irradiance, 1/sr, without Fresnel's share: how often facets send it to the viewer.

    A facet of slope zeta has the area 1 / cos of the ground below it. Mirrored light fills 4 (l.h) of the solid angle
    of normals, refracted light that of [walter2007, eq. 17]; over the area seen [ross2005; bruneton2010, sec. 5].

    Parameters
    ----------
    view, light : (..., 3) on the same side, y of one sign, for mirrored light, else for refracted light.
    n_view, n_light : indices on their sides.
    """
    v, towards = np.asarray(view, float), np.asarray(light, float)
    m = facet_normal(v, towards, n_view, n_light)
    length = np.maximum(np.linalg.norm(m, axis=-1), 1e-12)
    h = m / length[..., None]
    h = np.where(h[..., 1:2] < 0.0, -h, h)
    up = np.maximum(h[..., 1], _STEEPEST)
    v_h, l_h = (v * h).sum(-1), (towards * h).sum(-1)
    refracted = np.abs(l_h * v_h) * (np.asarray(n_view, float) / length) ** 2
    share = np.where(v[..., 1] * towards[..., 1] > 0.0, 0.25, refracted)
    density = slope_density(-h[..., ::2] / up[..., None] - np.asarray(slope, float), variance)
    # Facets turn each side to its medium: those count that viewer and light see from the side that they are on.
    faced = (v_h * v[..., 1] > 0.0) & (l_h * towards[..., 1] > 0.0) & (h[..., 1] > _STEEPEST)
    area = np.maximum(visible_area(np.where(v[..., 1:2] < 0.0, -v, v), slope, variance), 1e-6)
    return np.where(faced, share * density / (up**4 * area), 0.0)
