"""Closed-form answers that ray tracing must reproduce. Nothing here uses the code under test."""

from __future__ import annotations

import numpy as np


def slab_shift(thickness: float, theta: np.ndarray, n: float) -> np.ndarray:
    """Parallel shift of a ray through a slab in air: t sin(th)(1 - cos th / sqrt(n^2 - sin^2 th))."""
    s, c = np.sin(theta), np.cos(theta)
    return thickness * s * (1.0 - c / np.sqrt(n * n - s * s))


def soft_slab_shift(thickness: float, theta: np.ndarray, n: float, sigma: float, voxel: float) -> np.ndarray:
    """The same for faces blurred by a Gaussian: in layers n sin(theta) is kept, so dx/dz = s / sqrt(n(z)^2 - s^2).

    What bends rays is the difference over two voxels, interpolated linearly: n^2 is seen through a kernel of variance
    (1/3 + 1/6) voxel^2 on top of the blur of n.
    """
    from scipy.ndimage import gaussian_filter1d
    from scipy.special import erf

    z, dz = np.linspace(-thickness, thickness, 200001, retstep=True)
    edge = lambda t: 0.5 * (1.0 + erf(t / (np.sqrt(2.0) * sigma)))  # noqa: E731
    index = 1.0 + (n - 1.0) * (edge(z + thickness / 2) - edge(z - thickness / 2))
    squared = gaussian_filter1d(index**2, np.sqrt(0.5) * voxel / dz)
    s = np.sin(theta)[:, None]
    across = np.trapezoid(s / np.sqrt(squared - s * s), z, axis=1)
    return (2 * thickness * np.tan(theta) - across) * np.cos(theta)


def fresnel(theta: np.ndarray, n_i: float, n_t: float) -> np.ndarray:
    """Unpolarised reflectance from the textbook's sines and tangents (not at normal incidence)."""
    refracted = np.arcsin(n_i / n_t * np.sin(theta))
    s = (np.sin(theta - refracted) / np.sin(theta + refracted)) ** 2
    p = (np.tan(theta - refracted) / np.tan(theta + refracted)) ** 2
    return 0.5 * (s + p)


def ball_lens_focus(radius: float, n: float) -> float:
    """Paraxial focal length of a ball lens from its centre: n R / (2 (n - 1))."""
    return n * radius / (2.0 * (n - 1.0))


def through_ball(o: np.ndarray, d: np.ndarray, radius: float, n: float) -> tuple[np.ndarray, np.ndarray]:
    """Exit point and direction of rays refracted in and out of a ball at the origin. (N, 3) each."""

    def meet(x: np.ndarray, d: np.ndarray, far: bool) -> np.ndarray:
        b = (x * d).sum(1)
        root = np.sqrt(b * b - (x * x).sum(1) + radius**2)
        return x + (-b + (root if far else -root))[:, None] * d

    def bend(d: np.ndarray, normal: np.ndarray, eta: float) -> np.ndarray:
        c = -(d * normal).sum(1, keepdims=True)
        return eta * d + (eta * c - np.sqrt(1.0 - eta**2 * (1.0 - c**2))) * normal

    entry = meet(o, d, far=False)
    inside = bend(d, entry / radius, 1.0 / n)
    leave = meet(entry, inside, far=True)
    return leave, bend(inside, -leave / radius, n)


def rod_ray(x0: np.ndarray, z: float, n0: float, g: float, p_z: np.ndarray) -> np.ndarray:
    """Height after z of a ray that starts parallel to the axis at height x0 in n^2 = n0^2 (1 - (g r)^2)."""
    return x0 * np.cos(n0 * g * z / p_z)


def parabola(y0: float, p_y: np.ndarray, p_z: np.ndarray, slope: float, z: float) -> np.ndarray:
    """Height after z in n^2 = a + slope y: the trajectory of a stone."""
    sigma = z / p_z
    return y0 + p_y * sigma + 0.25 * slope * sigma**2


def prism_deviation(apex: float, theta: float, n: float) -> float:
    """Deviation of a ray through a prism at angle of incidence theta (radians)."""
    inside = apex - np.arcsin(np.sin(theta) / n)
    return float(theta + np.arcsin(n * np.sin(inside)) - apex)


def line_distance(points: np.ndarray, directions: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Distance of a point from each line; directions are unit."""
    return np.linalg.norm(np.cross(np.asarray(target) - points, directions), axis=1)
