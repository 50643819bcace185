"""Snell's law and reflection, as identities."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics import critical_angle, reflect, refract

RNG = np.random.default_rng(7)


def incident(count: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Random unit directions and unit normals that face them."""
    d, n = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in RNG.normal(size=(2, count, 3)))
    return d, np.where(np.sum(d * n, axis=-1, keepdims=True) > 0, -n, n)


def test_reflection_keeps_the_tangent_and_turns_the_normal_component() -> None:
    d, n = incident()
    r = reflect(d, n)
    np.testing.assert_allclose(np.cross(r, n), np.cross(d, n), atol=1e-14)
    np.testing.assert_allclose(np.sum(r * n, -1), -np.sum(d * n, -1), atol=1e-14)
    np.testing.assert_allclose(reflect(d, -n), r, atol=1e-14)


@pytest.mark.parametrize(("n_i", "n_t"), [(1.0, 1.5), (1.333, 2.417), (1.5, 1.0), (1.0003, 1.0)])
def test_refraction_keeps_the_tangential_momentum(n_i: float, n_t: float) -> None:
    # n d x normal is the same on both sides: the vector form of Snell's law. It fixes t up to its sign along n.
    d, n = incident()
    t, valid = refract(d, n, n_i, n_t)
    np.testing.assert_allclose((n_t * np.cross(t, n))[valid], (n_i * np.cross(d, n))[valid], atol=1e-13)
    np.testing.assert_allclose(np.linalg.norm(t, axis=-1), 1.0, atol=1e-13)
    assert np.all(np.sum(t * n, -1)[valid] <= 0.0)


def test_refraction_is_reversible() -> None:
    d, n = incident()
    t, valid = refract(d, n, 1.0, 1.5)
    back, back_valid = refract(-t, -n, 1.5, 1.0)
    assert valid.all() and back_valid.all()
    np.testing.assert_allclose(back, -d, atol=1e-7)  # sqrt of a rounding error at grazing exit


def test_total_reflection_begins_at_the_critical_angle_and_invents_no_ray() -> None:
    limit = critical_angle(1.5, 1.0)
    angles = limit + np.array([-1e-9, 1e-9, 0.3])
    d = np.stack([np.sin(angles), -np.cos(angles), np.zeros(3)], -1)
    t, valid = refract(d, [0.0, 1.0, 0.0], 1.5, 1.0)
    np.testing.assert_array_equal(valid, [True, False, False])
    np.testing.assert_array_equal(t[1:], d[1:])
    np.testing.assert_allclose(t[0], [1.0, 0.0, 0.0], atol=1e-4)


def test_critical_angle() -> None:
    assert np.degrees(critical_angle(1.5, 1.0)) == pytest.approx(41.810, abs=5e-4)
    assert np.degrees(critical_angle(1.333, 1.0)) == pytest.approx(48.61, abs=0.005)  # Snell's window
    assert critical_angle(1.0, 1.5) == pytest.approx(np.pi / 2)


def test_equal_indices_do_not_bend_even_at_grazing_incidence() -> None:
    cosines = np.array([1.0, 0.3, 1e-9, 0.0])
    d = np.stack([np.sqrt(1 - cosines**2), -cosines, np.zeros(4)], -1)
    t, valid = refract(d, [0.0, 1.0, 0.0], 1.5, 1.5)
    assert valid.all()
    np.testing.assert_allclose(t, d, atol=1e-15)


def test_leading_axes_broadcast() -> None:
    d, n = incident(12)
    t, valid = refract(d.reshape(3, 4, 3), n.reshape(3, 4, 3), np.ones((3, 1)), np.full(4, 1.5))
    assert t.shape == (3, 4, 3) and valid.shape == (3, 4)
    np.testing.assert_array_equal(t.reshape(12, 3), refract(d, n, 1.0, 1.5).direction)
