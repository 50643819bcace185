"""Absorption along paths."""

from __future__ import annotations

import numpy as np

from pellucid.optics import extinction_from_half_distance, transmittance, water_colour

SIGMA = np.array([0.27, 0.056, 0.010])


def test_pieces_of_a_path_multiply() -> None:
    whole = transmittance(SIGMA, 7.0)
    np.testing.assert_allclose(transmittance(SIGMA, 2.5) * transmittance(SIGMA, 4.5), whole, rtol=1e-14)
    np.testing.assert_allclose(-np.log(whole) / 7.0, SIGMA, rtol=1e-14)


def test_half_distance_halves() -> None:
    sigma = extinction_from_half_distance([1.0, 2.0, 0.0], 0.3)
    np.testing.assert_allclose(transmittance(sigma, 0.3), [0.5, 0.25, 1.0], rtol=1e-14)


def test_water_colour_runs_from_what_lies_behind_to_the_colour_of_the_deep() -> None:
    behind, deep = np.array([1.0, 0.8, 0.6]), np.array([0.01, 0.05, 0.2])
    np.testing.assert_allclose(water_colour(behind, deep, SIGMA, 0.0), behind)
    np.testing.assert_allclose(water_colour(behind, deep, SIGMA, 1e5), deep)
    half_way = water_colour(behind, deep, SIGMA, 3.0)
    np.testing.assert_allclose(water_colour(half_way, deep, SIGMA, 4.0), water_colour(behind, deep, SIGMA, 7.0))


def test_channels_come_last_and_leading_axes_broadcast() -> None:
    assert transmittance(SIGMA, np.ones((4, 5))).shape == (4, 5, 3)
    assert transmittance(np.ones((4, 5, 3)), 1.0).shape == (4, 5, 3)
