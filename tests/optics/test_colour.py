"""sRGB, luminance and tone curves."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics import (
    into_gamut,
    luminance,
    srgb_decode,
    srgb_encode,
    tone_aces,
    tone_agx,
    tone_khronos_neutral,
    tone_reinhard,
)

CURVES = [tone_reinhard, tone_aces, tone_agx, tone_khronos_neutral]


def test_srgb_round_trip_of_every_byte() -> None:
    bytes_ = np.arange(256)
    back = np.rint(255 * srgb_encode(srgb_decode(bytes_ / 255)))
    np.testing.assert_array_equal(back, bytes_)
    # The two published thresholds do not meet exactly: up to 3e-8 just above the straight part.
    values = np.linspace(-0.5, 4.0, 9001)
    np.testing.assert_allclose(srgb_decode(srgb_encode(values)), values, atol=5e-8)


def test_srgb_middle_grey() -> None:
    # 18 % grey is the byte 118; 50 % of the encoded range is 21.4 % of the light [iec61966]
    assert 255 * srgb_encode(0.18) == pytest.approx(117.6, abs=0.1)
    assert srgb_decode(0.5) == pytest.approx(0.21404, abs=1e-5)


def test_luminance_of_white_and_of_the_primaries() -> None:
    np.testing.assert_allclose(luminance(np.vstack([np.ones(3), np.eye(3)])), [1.0, 0.2126, 0.7152, 0.0722], atol=1e-15)


def test_colours_of_no_screen_keep_their_luminance_and_the_line_to_white() -> None:
    rgb = np.random.default_rng(2).normal(size=(300, 3)) + 0.3
    rgb = rgb[luminance(rgb) > 0.0]
    out = into_gamut(rgb)
    assert out.min() >= 0.0
    np.testing.assert_allclose(luminance(out), luminance(rgb), atol=1e-14)
    within = rgb.min(axis=1) >= 0.0
    np.testing.assert_array_equal(out[within], rgb[within])
    np.testing.assert_allclose(out[~within].min(axis=1), 0.0, atol=1e-14)
    away, kept = rgb - luminance(rgb)[:, None], out - luminance(out)[:, None]
    np.testing.assert_allclose(np.cross(away, kept), 0.0, atol=1e-13)
    np.testing.assert_array_equal(into_gamut([-1.0, 0.0, 0.0]), 0.0)


@pytest.mark.parametrize("curve", CURVES)
def test_tone_curves_rise_from_black_to_white_on_grey(curve) -> None:  # type: ignore[no-untyped-def]
    greys = np.concatenate([[-0.5, 0.0], np.geomspace(1e-4, 1e4, 400)])
    out = curve(np.repeat(greys[:, None], 3, axis=1))
    assert np.all((out >= 0.0) & (out <= 1.0))
    assert np.all(np.diff(out[:, 1]) >= -1e-4)  # the fits ripple by less than a byte's step
    np.testing.assert_allclose(out[:2], 0.0, atol=1e-6)
    assert out[-1].min() > 0.97
    assert np.max(np.ptp(out, axis=-1)) < 2e-3  # grey stays grey


@pytest.mark.parametrize("curve", CURVES)
def test_tone_curves_keep_saturated_light_in_the_gamut(curve) -> None:  # type: ignore[no-untyped-def]
    light = np.random.default_rng(1).uniform(-1, 1, (500, 3)) * 10.0 ** np.linspace(-3, 4, 500)[:, None]
    out = curve(light)
    assert np.isfinite(out).all() and out.min() >= 0.0 and out.max() <= 1.0


def test_reinhard_of_one_is_a_half() -> None:
    np.testing.assert_allclose(tone_reinhard(np.ones(3)), 0.5)


def test_khronos_neutral_reproduces_base_colours_and_its_specification() -> None:
    # Diffuse base colours, lit to radiance base + 0.04 (the specular floor), come out as they are [khronos2024].
    base = np.array([[0.7, 0.2, 0.1], [0.3, 0.3, 0.3], [0.05, 0.6, 0.4]])
    np.testing.assert_allclose(tone_khronos_neutral(base + 0.04), base, atol=1e-15)
    # By hand from the specification for (2, 1, 1): f = 0.04, p = 1.96, p_n = 1 - 0.0576/1.44 = 0.96, g = 1/1.15.
    g = 1 / 1.15
    expected = np.array([1.96, 0.96, 0.96]) * (0.96 / 1.96) * g + 0.96 * (1 - g)
    np.testing.assert_allclose(tone_khronos_neutral([2.0, 1.0, 1.0]), expected, rtol=1e-14)


def test_agx_puts_middle_grey_near_middle() -> None:
    # The default contrast takes 0.18 to encoded 0.5, as sobotka2022 sets its pivot, here through a polynomial fit.
    encoded = tone_agx(np.full(3, 0.18)) ** (1 / 2.2)
    np.testing.assert_allclose(encoded, 0.5, atol=0.005)


def test_aces_of_middle_grey() -> None:
    # The original transforms show 0.18 as 10 nit of a 100 nit display.
    np.testing.assert_allclose(tone_aces(np.full(3, 0.18)), 0.10, atol=0.01)
