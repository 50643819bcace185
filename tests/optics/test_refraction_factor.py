"""Refraction by a factor: what it does, when it is Snell's law, and how good the best fixed one is."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid import optics

UP = np.array([0.0, 1.0, 0.0])


def incident(angles: np.ndarray) -> np.ndarray:
    return np.stack([np.sin(angles), -np.cos(angles), 0.0 * angles], axis=-1)


def errors_deg(factor: float, n: float, angles: np.ndarray) -> np.ndarray:
    """Angle by a factor less angle by Snell's law."""
    bent = optics.refract_by_factor(incident(angles), UP, factor).direction
    return np.asarray(np.degrees(np.arctan2(bent[:, 0], -bent[:, 1]) - np.arcsin(np.sin(angles) / n)))


def test_factor_zero_bends_nothing_and_a_great_one_follows_the_inverted_normal() -> None:
    d = incident(np.linspace(0.0, 1.5, 40))
    np.testing.assert_allclose(optics.refract_by_factor(d, UP, 0.0).direction, d, atol=1e-15)
    np.testing.assert_allclose(optics.refract_by_factor(d, UP, 1e9).direction, np.tile(-UP, (40, 1)), atol=1e-8)


@pytest.mark.parametrize("n", [1.0003, 1.333, 1.5, 2.42, 1 / 1.333])
def test_the_exact_factor_is_snells_law(n: float) -> None:
    angles = np.linspace(0.0, min(1.5, np.arcsin(min(n, 1.0)) - 1e-6), 200)
    d = incident(angles)
    found = optics.refract_by_factor(d, UP, optics.exact_factor(np.cos(angles), 1.0, n))
    expected = optics.refract(d, UP, np.ones(200), np.full(200, n))
    assert found.valid.all()
    np.testing.assert_allclose(found.direction, expected.direction, atol=1e-13)


def test_the_exact_factor_goes_from_small_angles_to_grazing() -> None:
    np.testing.assert_allclose(optics.exact_factor(1.0, 1.0, 1.333), 0.333, atol=1e-15)
    np.testing.assert_allclose(optics.exact_factor(0.0, 1.0, 1.333), np.sqrt(1.333**2 - 1.0), atol=1e-15)
    # Total reflection: nothing passes.
    total = incident(np.array([1.0]))
    k = optics.exact_factor(np.cos(1.0), 1.333, 1.0)
    assert not optics.refract_by_factor(total, UP, k).valid.any()


# Index, largest angle; largest error of the fitted factor, of the best one found by trying, of that of small angles.
# The table of docs/sheet.md.
TABLE = [
    (1.333, 20, 0.046, 0.044, 0.175),
    (1.333, 30, 0.168, 0.153, 0.606),
    (1.333, 45, 0.684, 0.551, 2.173),
    (1.333, 60, 2.120, 1.427, 5.596),
    (1.333, 75, 5.782, 3.069, 12.067),
    (1.5, 30, 0.173, 0.158, 0.633),
    (1.5, 60, 2.017, 1.379, 5.629),
]


@pytest.mark.parametrize(("n", "largest_deg", "fitted", "best", "small"), TABLE)
def test_how_far_a_fixed_factor_errs(n: float, largest_deg: float, fitted: float, best: float, small: float) -> None:
    angles = np.linspace(0.0, np.radians(largest_deg), 2001)
    factor = float(optics.fitted_factor(1.0, n, np.radians(largest_deg)))
    assert np.abs(errors_deg(factor, n, angles)).max() == pytest.approx(fitted, abs=1e-3)
    assert np.abs(errors_deg(n - 1.0, n, angles)).max() == pytest.approx(small, abs=1e-3)
    tried = np.linspace(n - 1.0, np.sqrt(n * n - 1.0), 1200)
    least = min(np.abs(errors_deg(k, n, angles[::20])).max() for k in tried)
    assert least == pytest.approx(best, abs=1e-2)


def test_the_fitted_factor_is_chebyshevs_for_small_ranges() -> None:
    # Over a small range the error is a multiple of T3: its extrema inside and at the end are equal and opposite.
    largest = np.radians(5.0)
    found = errors_deg(float(optics.fitted_factor(1.0, 1.5, largest)), 1.5, np.linspace(0.0, largest, 4001))
    assert found.max() == pytest.approx(-found.min(), rel=0.02)
    assert optics.fitted_factor(1.0, 1.5, 0.0) == pytest.approx(0.5)


def test_the_opposite_factor_undoes_it_at_small_angles() -> None:
    there = optics.refract_by_factor(incident(np.array([0.01])), UP, 0.4).direction
    back = optics.refract_by_factor(there, UP, optics.opposite_factor(0.4)).direction
    np.testing.assert_allclose(back, incident(np.array([0.01])), atol=1e-6)
