"""Fresnel's formulae against energy, Stokes' reversal, and the numbers of the textbooks."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics import (
    brewster_angle,
    critical_angle,
    fresnel_dielectric,
    fresnel_polarised,
    fresnel_schlick,
    normal_reflectance,
    schlick,
)

COSINES = np.linspace(1e-6, 1.0, 2001)


@pytest.mark.parametrize(("n_i", "n_t"), [(1.0, 1.5), (1.5, 1.0), (1.0, 2.417), (1.333, 1.5)])
def test_reflected_and_transmitted_flux_add_up_to_one(n_i: float, n_t: float) -> None:
    # The transmitted flux from the amplitude coefficients t_s, t_p [born1999, 1.5.2], which the code never forms.
    c = COSINES[n_i**2 * (1 - COSINES**2) < n_t**2]
    c_t = np.sqrt(1 - (n_i / n_t) ** 2 * (1 - c**2))
    t_s, t_p = 2 * n_i * c / (n_i * c + n_t * c_t), 2 * n_i * c / (n_t * c + n_i * c_t)
    flux = n_t * c_t / (n_i * c)
    reflectance = fresnel_polarised(c, n_i, n_t)
    np.testing.assert_allclose(reflectance.s + flux * t_s**2, 1.0, atol=1e-12)
    np.testing.assert_allclose(reflectance.p + flux * t_p**2, 1.0, atol=1e-12)
    np.testing.assert_allclose(fresnel_dielectric(c, n_i, n_t), 1 - flux * (t_s**2 + t_p**2) / 2, atol=1e-12)


@pytest.mark.parametrize(("n", "expected"), [(1.333, 0.02037), (1.5, 0.04), (2.42, 0.17239)])
def test_normal_reflectance(n: float, expected: float) -> None:
    for value in (fresnel_dielectric(1.0, 1.0, n), fresnel_schlick(1.0, n, 1.0), normal_reflectance(1.0, n)):
        assert value == pytest.approx(expected, abs=5e-6)


def test_brewster() -> None:
    angle = brewster_angle(1.0, 1.5)
    assert np.degrees(angle) == pytest.approx(56.310, abs=5e-4)
    assert fresnel_polarised(np.cos(angle), 1.0, 1.5).p == pytest.approx(0.0, abs=1e-30)


def test_total_reflection_reflects_everything() -> None:
    limit = critical_angle(1.5, 1.0)
    beyond = np.cos(np.linspace(limit + 1e-12, np.pi / 2, 100))
    np.testing.assert_array_equal(fresnel_dielectric(beyond, 1.5, 1.0), 1.0)
    np.testing.assert_allclose(fresnel_schlick(beyond, 1.5, 1.0), 1.0, atol=1e-12)
    assert fresnel_dielectric(np.cos(limit - 1e-3), 1.5, 1.0) < 0.9


def test_both_sides_reflect_the_same_share_along_one_path() -> None:
    # Stokes' reversal: the angle of incidence on one side is the angle of refraction on the other.
    c_t = np.sqrt(1 - (1 - COSINES**2) / 1.5**2)
    np.testing.assert_allclose(fresnel_dielectric(COSINES, 1, 1.5), fresnel_dielectric(c_t, 1.5, 1), atol=1e-9)
    np.testing.assert_allclose(fresnel_schlick(COSINES, 1, 1.5), fresnel_schlick(c_t, 1.5, 1), atol=1e-9)


def test_equal_indices_reflect_nothing_at_any_angle() -> None:
    cosines = np.array([0.0, 1e-300, 1e-16, 1e-12, 0.5, 1.0])
    # The square of a rounding error is what may be left.
    np.testing.assert_allclose(fresnel_dielectric(cosines, 1.5, 1.5), 0.0, atol=1e-31)


@pytest.mark.parametrize(("n_i", "n_t"), [(1.0, 1.5), (1.0, 1.0 + 1e-9), (1.5, 1.0)])
def test_grazing_light_is_reflected(n_i: float, n_t: float) -> None:
    assert fresnel_dielectric(0.0, n_i, n_t) == 1.0


@pytest.mark.parametrize(("n", "error"), [(1.333, 0.059), (1.5, 0.036), (2.42, 0.076)])
def test_schlick_errs_by_what_its_docstring_says(n: float, error: float) -> None:
    for n_i, n_t in ((1.0, n), (n, 1.0)):
        difference = fresnel_schlick(COSINES, n_i, n_t) - fresnel_dielectric(COSINES, n_i, n_t)
        assert difference[np.argmax(np.abs(difference))] == pytest.approx(error, abs=5e-4)


def test_schlick_curve_spans_its_range() -> None:
    np.testing.assert_allclose(schlick(0.04, [1.0, 0.0], 5.0), [0.04, 1.0])
    assert schlick(0.02, 0.5, 3.0) == pytest.approx(0.02 + 0.98 / 8)
