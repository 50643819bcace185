"""A small sitting animal: an organic closed mesh that needs no download."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.surface_nets import surface_nets

from .primitives import Shape, Values, ellipsoid, moved, rotated, smooth_union

#: Parts of the animal (centre, half axes, turn about x and about z in degrees), for a height of about 1.
_PARTS: tuple[tuple[tuple[float, float, float], tuple[float, float, float], float, float], ...] = (
    ((0.0, -0.20, -0.06), (0.225, 0.245, 0.27), -12.0, 0.0),
    ((0.0, -0.04, 0.07), (0.165, 0.20, 0.16), 10.0, 0.0),
    ((0.0, 0.155, 0.17), (0.125, 0.115, 0.15), 12.0, 0.0),
    ((0.0, 0.115, 0.275), (0.07, 0.06, 0.07), 0.0, 0.0),
    ((0.075, 0.335, 0.09), (0.048, 0.165, 0.034), -14.0, -13.0),
    ((-0.075, 0.335, 0.09), (0.048, 0.165, 0.034), -14.0, 13.0),
    ((0.165, -0.30, 0.02), (0.095, 0.145, 0.17), 0.0, -6.0),
    ((-0.165, -0.30, 0.02), (0.095, 0.145, 0.17), 0.0, 6.0),
    ((0.155, -0.415, 0.14), (0.062, 0.045, 0.13), 0.0, 0.0),
    ((-0.155, -0.415, 0.14), (0.062, 0.045, 0.13), 0.0, 0.0),
    ((0.075, -0.27, 0.20), (0.05, 0.17, 0.055), 6.0, 0.0),
    ((-0.075, -0.27, 0.20), (0.05, 0.17, 0.055), 6.0, 0.0),
    ((0.0, -0.33, -0.335), (0.085, 0.085, 0.08), 0.0, 0.0),
)


def creature(height_m: float = 1.0) -> Shape:
    """Signed distance of the animal, facing +z, about the origin; right near its surface."""
    if not (np.isfinite(height_m) and height_m > 0.0):
        raise SceneError("height_m", f"is {height_m}", "give a positive length in metres")
    body = smooth_union(0.06, *(_part(*part) for part in _PARTS))
    scale = float(height_m)
    return lambda x, y, z: body(x / scale, y / scale, z / scale) * scale


def creature_mesh(height_m: float = 1.0, resolution: int = 72) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Closed mesh of the animal: surface nets, then every vertex moved on to the surface by Newton steps.

    Parameters
    ----------
    height_m : about the height of the result.
    resolution : voxels along the height of the grid; triangles grow with its square.

    Returns
    -------
    vertices (V, 3) in metres, faces (F, 3).
    """
    if resolution < 16:
        raise SceneError("resolution", f"is {resolution}", "use 16 or more")
    shape = creature(height_m)
    extent = np.array([0.72, 1.12, 0.96]) * height_m
    count = np.ceil(extent / extent.max() * resolution).astype(int)
    axes = [(np.arange(n) + 0.5) * e / n - 0.5 * e for n, e in zip(count, extent, strict=True)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    vertices, faces = surface_nets(shape(x, y, z), (extent[0], extent[1], extent[2]))
    return _projected(vertices, shape, 1e-4 * height_m), faces


def _part(centre: Sequence[float], radii: Sequence[float], about_x_deg: float, about_z_deg: float) -> Shape:
    a, b = np.radians([about_x_deg, about_z_deg])
    turn_x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    turn_z = np.array([[np.cos(b), -np.sin(b), 0], [np.sin(b), np.cos(b), 0], [0, 0, 1]])
    return moved(rotated(ellipsoid(radii), turn_z @ turn_x), centre)


def _projected(points: Values, shape: Shape, step: float) -> Values:
    for _ in range(3):
        gradient = np.empty_like(points)
        for axis in range(3):
            offset = np.eye(3)[axis] * step
            gradient[:, axis] = (shape(*(points + offset).T) - shape(*(points - offset).T)) / (2.0 * step)
        value = shape(*points.T)
        points = points - gradient * (value / np.maximum(np.sum(gradient**2, axis=1), 1e-12))[:, None]
    return points
