"""Steps through n(x), on the Luneburg lens, whose rays are ellipses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from pellucid.optics import drift, euler_step, leapfrog_step

START = np.array([[-0.8, 0.5, 0.2], [-0.6, -0.1, 0.3], [-0.7, 0.0, 0.0]])
DIRECTION = np.array([[1.0, 0.0, 0.0], [0.8, 0.6, 0.0], [1.0, 0.0, 0.0]])
SPAN = 1.1  # in sigma, m; the rays stay within the lens


def luneburg(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """n^2 = 2 - r^2, continued outside: index and gradient."""
    n = np.sqrt(2.0 - np.sum(x * x, axis=-1))
    return n, -x / n[..., None]


def exact(x: np.ndarray, p: np.ndarray, sigma: float) -> np.ndarray:
    """d2x/dsigma2 = grad(n^2)/2 = -x: harmonic."""
    return x * np.cos(sigma) + p * np.sin(sigma)


def momentum() -> np.ndarray:
    return luneburg(START)[0][:, None] * DIRECTION


def leapfrog(steps: int) -> tuple[np.ndarray, np.ndarray]:
    x, p = START, momentum()
    for _ in range(steps):
        x, p = leapfrog_step(x, p, SPAN / steps, luneburg)
    return x, p


def euler_error(steps: int) -> float:
    # In the arc length: the distance from the exact curve, found by following it to the nearest sigma.
    x, p, ds = START, momentum(), 1.0 / steps
    for _ in range(steps):
        x, p = euler_step(x, p, ds, luneburg)
    sigmas = np.linspace(0.0, 1.5, 200001)[:, None]
    nearest = [
        np.min(np.linalg.norm(a * np.cos(sigmas) + b * np.sin(sigmas) - end, axis=-1))
        for a, b, end in zip(START, momentum(), x, strict=True)
    ]
    return float(np.max(nearest))


def leapfrog_error(steps: int) -> float:
    return float(np.max(np.abs(leapfrog(steps)[0] - exact(START, momentum(), SPAN))))


@pytest.mark.parametrize(("error", "factor"), [(leapfrog_error, 4.0), (euler_error, 2.0)])
def test_half_the_step_divides_the_error_by_two_to_the_order(error: Callable[[int], float], factor: float) -> None:
    assert error(64) / error(128) == pytest.approx(factor, rel=0.02)


def test_leapfrog_is_undone_by_turning_round() -> None:
    x, p = leapfrog(40)
    p = -p
    for _ in range(40):
        x, p = leapfrog_step(x, p, SPAN / 40, luneburg)
    np.testing.assert_allclose(x, START, atol=1e-14)
    np.testing.assert_allclose(p, -momentum(), atol=1e-14)


def test_the_momentum_keeps_the_length_of_the_index_to_second_order() -> None:
    def defect(steps: int) -> float:
        x, p = leapfrog(steps)
        return float(np.max(np.abs(np.linalg.norm(p, axis=-1) - luneburg(x)[0])))

    assert defect(64) < 1e-4
    assert defect(64) / defect(128) == pytest.approx(4.0, rel=0.05)


def test_bouguer_holds_exactly_in_a_spherical_field() -> None:
    # x cross p is kept by every drift (along p) and every kick (along x), not only in the limit.
    x, p = leapfrog(16)
    np.testing.assert_allclose(np.cross(x, p), np.cross(START, momentum()), atol=1e-14)


def test_parallel_rays_meet_at_the_far_rim_point() -> None:
    heights = np.linspace(-0.9, 0.9, 7)
    x = np.stack([-np.sqrt(1 - heights**2), heights, 0 * heights], -1)
    p = luneburg(x)[0][:, None] * np.array([1.0, 0.0, 0.0])
    for _ in range(2000):
        x, p = leapfrog_step(x, p, np.pi / 2 / 2000, luneburg)
    # After a quarter period x = p(0) = (n, 0, 0) with n = 1 on the rim: the point (1, 0, 0), for every ray.
    np.testing.assert_allclose(x, np.tile([1.0, 0.0, 0.0], (7, 1)), atol=2e-6)


def test_a_constant_field_is_crossed_in_one_step_of_any_length() -> None:
    def uniform(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.full(x.shape[:-1], 1.5), np.zeros_like(x)

    x, p = leapfrog_step(START, 1.5 * DIRECTION, 10.0 / 1.5, uniform)
    np.testing.assert_allclose(x, drift(START, DIRECTION, 10.0), atol=1e-14)
    np.testing.assert_array_equal(p, 1.5 * DIRECTION)
