"""The sheet in float64: rays, hits, places in the picture, colours. The shaders are held to it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.optics import RefractResult, reflect, refract, refract_by_factor

LEAST_FALL = 1e-4  # of a direction, so that level and rising rays see the border, far away
GRAZING = 1e-3  # least cosine between normal and view

Array = NDArray[np.float64]


class Hit(NamedTuple):
    """Where a ray meets the plane of the picture.

    Attributes
    ----------
    xz : (..., 2), and path : (...), the way there, metres of the sheet's own.
    """

    xz: Array
    path: Array


def facing(normal: ArrayLike, direction: ArrayLike) -> Array:
    """The normal (..., 3), turned until it just faces the viewer where it leans away."""
    n, d = np.asarray(normal, float), np.asarray(direction, float)
    cosine = -np.sum(n * d, axis=-1, keepdims=True)
    turned = n - (GRAZING - cosine) * d
    turned = turned / np.linalg.norm(turned, axis=-1, keepdims=True)
    return np.where(cosine < GRAZING, turned, n)


def refracted(
    direction: ArrayLike, normal: ArrayLike, n_i: float, n_t: float, factor: float | None = None
) -> RefractResult:
    """The refracted ray by Snell's law, or by a factor [oliveira2000b, eq. 7, 8].

    Parameters
    ----------
    direction, normal : (..., 3), unit, the normal on the side of the viewer. factor : None for Snell's law.
    """
    n = facing(normal, direction)
    return refract(direction, n, n_i, n_t) if factor is None else refract_by_factor(direction, n, factor)


def inward(
    direction: ArrayLike, normal: ArrayLike, n_outside: float, n_inside: float, factor: float | None = None
) -> Array:
    """The ray (..., 3) that sees the picture: the refracted one from above, the mirrored one from below.

    Parameters
    ----------
    direction, normal : (..., 3), unit, the normal upwards.
    """
    d, n = np.asarray(direction, float), np.asarray(normal, float)
    below = np.sum(d * n, axis=-1, keepdims=True) > 0.0
    from_above = refracted(d, np.where(below, -n, n), n_outside, n_inside, factor).direction
    return np.where(below, reflect(d, facing(-n, d)), from_above)


def picture_hit(position: ArrayLike, direction: ArrayLike, depth: float) -> Hit:
    """Follow a ray to the depth p = p_i + (y_i - y_0) [oliveira2000b, eq. 9-11], here -(depth + y).

    Parameters
    ----------
    position, direction : (..., 3), of the sheet's own: level at y = 0, picture at y = -depth.
    """
    p, d = np.asarray(position, float), np.asarray(direction, float)
    t = -(depth + p[..., 1]) / np.minimum(d[..., 1], -LEAST_FALL)
    return Hit(p[..., (0, 2)] + t[..., None] * d[..., (0, 2)], t)


def picture_uv(xz: ArrayLike, low: ArrayLike, size: ArrayLike) -> Array:
    """Place (..., 2) in the picture, from the left and from the top, clamped [oliveira2000b, eq. 12, 13]."""
    return np.clip((np.asarray(xz, float) - np.asarray(low, float)) / np.asarray(size, float), 0.0, 1.0)


def shrunk_limits(xz: ArrayLike, low: ArrayLike, high: ArrayLike) -> tuple[Array, Array]:
    """Limits (2,), (2,) of x and z between which all hits lie [oliveira2000b, second rule for borders].

    Parameters
    ----------
    xz : (..., 2) hits. low, high : (2,) extents of the mesh.
    """
    hits = np.asarray(xz, float).reshape(-1, 2)
    return np.minimum(hits.min(axis=0), low), np.maximum(hits.max(axis=0), high)


def false_colour(value: ArrayLike) -> Array:
    """Colours (..., 3) for numbers: black, blue, green, yellow, red, white at 0, 1/5 .. 1, linear between."""
    x = 5.0 * np.clip(np.asarray(value, float), 0.0, 1.0)
    red = np.clip(x - 2.0, 0.0, 1.0)
    green = np.clip(x - 1.0, 0.0, 1.0) - np.clip(x - 3.0, 0.0, 1.0) + np.clip(x - 4.0, 0.0, 1.0)
    blue = np.clip(x, 0.0, 1.0) - np.clip(x - 1.0, 0.0, 1.0) + np.clip(x - 4.0, 0.0, 1.0)
    return np.stack([red, green, blue], axis=-1)
