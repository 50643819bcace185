"""Sines and Gerstner's waves against their formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.waves import Gerstner, Sine


def test_a_sine_is_one() -> None:
    sine = Sine(2.5, 0.1, 0.0, 30.0, tile_m=10.0, shape=(8, 64), level_m=1.0)
    assert isinstance(sine, DynamicHeights)
    x, _ = sine.centres()
    k = 2.0 * np.pi / 2.5
    phase = k * x - np.sqrt(9.81 * k + 7.28e-5 * k**3) * 3.0 + np.radians(30.0)
    found = sine.surface(3.0)
    np.testing.assert_allclose(found.heights, np.tile(1.0 + 0.1 * np.cos(phase), (8, 1)), atol=2e-6)
    np.testing.assert_allclose(found.slopes[..., 0], np.tile(-0.1 * k * np.sin(phase), (8, 1)), atol=2e-6)
    assert sine.steepest == pytest.approx(0.1 * k)
    assert not found.slopes[..., 1].any() and sine.limits_m == pytest.approx((0.9, 1.1))


def test_crests_travel_where_and_as_fast_as_they_are_told() -> None:
    sine = Sine(2.0, 0.1, 90.0, speed_m_s=1.5, tile_m=8.0, shape=(64, 8))
    np.testing.assert_allclose(np.roll(sine.advance(0.0), 12, 0), sine.advance(1.0), atol=1e-5)


def test_trains_are_moved_onto_the_tile_unless_it_ends() -> None:
    given: dict[str, Any] = {"wavelength_m": (2.1, 0.9), "amplitude_m": (0.1, 0.03), "direction_deg": (10.0, 130.0)}
    whole = Sine(**given, tile_m=10.0, shape=(128, 128))
    turns = whole.k * 10.0 / (2.0 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
    heights = whole.advance(1.0).astype(float)
    spectrum = np.abs(np.fft.fft2(heights)) / heights.size
    assert spectrum[spectrum > 1e-5].sum() == pytest.approx(0.13, rel=1e-3)  # four coefficients, nothing leaks
    exact = Sine(**given, tile_m=10.0, periodic=False)
    np.testing.assert_allclose(2.0 * np.pi / np.hypot(*exact.k.T), (2.1, 0.9))


@pytest.mark.parametrize("steepness", [0.3, 0.8, 0.98])
def test_a_trochoid_has_its_shape(steepness: float) -> None:
    """x = x0 - a sin(k x0), h = a cos(k x0): from many x0 the height at each place, to 1e-3 of the amplitude."""
    k = 2.0 * np.pi / 5.0
    wave = Gerstner(5.0, steepness / k, tile_m=10.0, shape=(4, 256))
    assert wave.steepness == pytest.approx(steepness)
    x, _ = wave.centres()
    rest = np.linspace(-8.0, 8.0, 200_001)
    wanted = np.interp(x, rest - steepness / k * np.sin(k * rest), steepness / k * np.cos(k * rest))
    found = wave.surface(0.0)
    np.testing.assert_allclose(found.heights[0], wanted, atol=1e-3 * steepness / k)
    # dh/dx = -e sin / (1 - e cos); the Jacobian is the divisor, least at crests.
    origin = np.interp(x, rest - steepness / k * np.sin(k * rest), rest)
    jacobian = 1.0 - steepness * np.cos(k * origin)
    assert found.fold is not None
    np.testing.assert_allclose(found.fold[0], jacobian, atol=0.01)
    slope = -steepness * np.sin(k * origin) / jacobian
    assert wave.steepest == pytest.approx(
        np.abs(-steepness * np.sin(k * rest) / (1.0 - steepness * np.cos(k * rest))).max()
    )
    shallow = jacobian > 0.3
    np.testing.assert_allclose(found.slopes[0, shallow, 0], slope[shallow], atol=0.02)


def test_several_trains_together_meet_their_definition() -> None:
    given: dict[str, Any] = {"wavelength_m": (4.0, 2.0, 1.3), "amplitude_m": (0.15, 0.06, 0.03)}
    waves = Gerstner(**given, direction_deg=(0.0, 60.0, 200.0), sharpness=(1.0, 0.9, 0.7), tile_m=8.0, shape=(64, 64))
    found = waves.surface(2.0)
    x0, z0 = (a.astype(np.float32) for a in np.meshgrid(*2 * [np.linspace(-1.5, 1.5, 9)]))
    d_x, d_z, *_, heights, _, _ = waves.displaced(x0, z0, 2.0)
    at, _ = waves.at(x0 + d_x, z0 + d_z, 2.0)
    np.testing.assert_allclose(at, heights, atol=0.006)  # bilinear between cells of 12 cm
    difference = (np.roll(found.heights, -1, 0) - np.roll(found.heights, 1, 0)) / (2.0 * waves.cell[1])
    assert np.sqrt(np.square(difference - found.slopes[..., 1]).mean()) < 0.1 * found.slopes[..., 1].std()
    np.testing.assert_allclose(np.linalg.norm(found.normals, axis=2), 1.0, rtol=1e-6)
    np.testing.assert_allclose(-found.normals[..., ::2] / found.normals[..., 1:2], found.slopes, rtol=1e-5)
    waves.advance(9.0)
    np.testing.assert_array_equal(waves.advance(2.0), found.heights)


def test_no_sharpness_is_a_sine() -> None:
    given: dict[str, Any] = {"wavelength_m": 2.0, "amplitude_m": 0.1, "tile_m": 4.0, "shape": (8, 32)}
    np.testing.assert_allclose(Gerstner(sharpness=0.0, **given).advance(1.0), Sine(**given).advance(1.0), atol=1e-6)


@pytest.mark.parametrize(
    ("options", "field"),
    [({"wavelength_m": 0.0}, "wavelength_m"), ({"wavelength_m": 100.0}, "wavelength_m"),
     ({"wavelength_m": 0.05}, "wavelength_m"), ({"wavelength_m": (1, 2), "amplitude_m": (0.1,) * 3}, "wavelength_m"),
     ({"amplitude_m": np.nan}, "amplitude_m"), ({"amplitude_m": -1.0}, "amplitude_m"), ({"tile_m": -1.0}, "tile_m"),
     ({"depth_m": -1.0}, "depth_m"), ({"speed_m_s": np.inf}, "speed_m_s"), ({"direction_deg": "up"}, "direction_deg"),
     ({"shape": (9999, 9)}, "shape"), ({"periodic": 1}, "periodic"), ({"sharpness": 1.5}, "sharpness"),
     ({"amplitude_m": 0.5}, "amplitude_m"), ({"amplitude_m": (0.2, 0.2)}, "amplitude_m")],
)  # fmt: skip
def test_parameters_are_checked(options: dict[str, Any], field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        Gerstner(**({"shape": (32, 32)} | options))


def test_loops_are_refused_with_what_to_do() -> None:
    with pytest.raises(SceneError, match=r"steepness of 1\.57; above 1 they run in loops.*0\.637"):
        Gerstner(2.0, 0.5)
