"""The standard observer, and colours as sums over wavelengths."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.spectra import colour_matching, daylight, rgb_of_light, stratified, weights

EVERY_NM = np.arange(380.0, 780.5, 1.0)
# Linear Rec.709 to XYZ as IEC 61966-2-1 prints it
XYZ_FROM_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def chromaticity(xyz: np.ndarray) -> np.ndarray:
    return xyz[..., :2] / xyz.sum(axis=-1, keepdims=True)


def test_the_observer_has_the_values_of_the_standard() -> None:
    # Rows of the table of every nanometre [cie2019a] between those that are stored
    known = {
        436: (0.3343513, 0.01800736, 1.6564048),
        546: (0.3740839, 0.9840924, 0.01230723),
        589: (1.0180064, 0.7691547, 0.001146667),
        633: (0.5811052, 0.2353344, 0.00003572),
    }
    for lambda_nm, xyz in known.items():
        np.testing.assert_allclose(colour_matching(lambda_nm), xyz, rtol=2e-3, atol=1e-4)
    np.testing.assert_array_equal(colour_matching(555.0)[1], 1.0)
    assert daylight(560.0) == 100.0 and daylight(900.0) == 0.0


def test_equal_energy_is_white_in_the_middle_of_the_diagram() -> None:
    xyz = colour_matching(EVERY_NM).sum(axis=0)
    np.testing.assert_allclose(chromaticity(xyz), 1.0 / 3.0, atol=1e-4)


def test_daylight_is_the_white_of_the_screen() -> None:
    np.testing.assert_allclose(np.trapezoid(rgb_of_light(EVERY_NM), EVERY_NM, axis=0), 1.0, atol=2e-3)


@pytest.mark.parametrize("count", [4, 5, 8, 13, 16, 64])
@pytest.mark.parametrize("sample", [0, 1, 7])
def test_the_weights_of_all_wavelengths_sum_to_the_identity(count: int, sample: int) -> None:
    np.testing.assert_allclose(weights(stratified(count, sample)).sum(axis=0), np.eye(3), atol=1e-14)


@pytest.mark.parametrize("count", [8, 16, 64])
def test_light_of_one_wavelength_has_its_place_on_the_spectral_locus(count: int) -> None:
    """Whatever the colour of the light was: what is seen of one wavelength has the chromaticity of the observer's."""
    lambda_nm = stratified(count)
    seen = weights(lambda_nm) @ np.array([0.9, 1.0, 0.8])
    found = chromaticity(seen @ XYZ_FROM_RGB.T)
    # 2e-3: IEC prints its matrix to four digits, and its white is the rounded one.
    np.testing.assert_allclose(found, chromaticity(colour_matching(lambda_nm)), atol=2e-3)


@pytest.mark.parametrize("count", [8, 16, 64])
def test_the_spectra_of_colours_are_nowhere_below_zero(count: int) -> None:
    for sample in range(20):
        lambda_nm = stratified(count, sample)
        light = rgb_of_light(lambda_nm)
        power = np.einsum("kic,ki->kc", weights(lambda_nm), light) / np.einsum("ki,ki->k", light, light)[:, None]
        assert power.min() > -0.03 * power.max()


def test_the_sum_over_few_wavelengths_is_near_the_integral() -> None:
    """Half of the range: what a filter at 550 nm lets pass of white. 16 wavelengths against 2000."""
    colours = []
    for count in (16, 2000):
        lambda_nm = stratified(count)
        colours.append((weights(lambda_nm) * (lambda_nm > 550.0)[:, None, None]).sum(axis=0) @ np.ones(3))
    np.testing.assert_allclose(colours[0], colours[1], atol=0.03)


def test_samples_fill_the_intervals_evenly() -> None:
    offsets = np.sort([(stratified(4, sample)[0] - 400.0) / 75.0 for sample in range(32)])
    assert offsets[0] >= 0.0 and offsets[-1] < 1.0
    assert np.diff(np.concatenate([offsets, [1.0 + offsets[0]]])).max() < 2.0 / 32
    np.testing.assert_array_equal(stratified(4), [437.5, 512.5, 587.5, 662.5])
