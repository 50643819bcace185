"""Smoothing, gradients and the distance to inhomogeneity."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.distance import homogeneous_distance
from pellucid.fields.gradient import central, sobel
from pellucid.fields.smoothing import gaussian

VOXEL = (0.1, 0.2, 0.4)


def coordinates(shape, voxel):
    k, j, i = np.meshgrid(*(np.arange(n) for n in shape), indexing="ij")
    return i * voxel[0], j * voxel[1], k * voxel[2]


@pytest.mark.parametrize("gradient", [central, sobel])
def test_gradients_are_exact_on_linear_fields_borders_included(gradient):
    x, y, z = coordinates((5, 6, 7), VOXEL)
    got = gradient(1.0 + 2 * x - 3 * y + 5 * z, VOXEL)
    np.testing.assert_allclose(got, np.broadcast_to([2, -3, 5], got.shape), rtol=1e-6)


@pytest.mark.parametrize("gradient", [central, sobel])
def test_gradients_are_of_second_order_inside(gradient):
    errors = []
    for n in (16, 32):
        h = 1.0 / n
        x, y, z = coordinates((n,) * 3, (h,) * 3)
        got = gradient(np.sin(3 * x) * np.cos(2 * y) + z * z, (h,) * 3)[2:-2, 2:-2, 2:-2, 0]
        errors.append(np.abs(got - (3 * np.cos(3 * x) * np.cos(2 * y))[2:-2, 2:-2, 2:-2]).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


def test_gradient_along_an_axis_of_one_voxel_is_zero():
    assert (central(np.ones((1, 3, 3)), VOXEL)[..., 2] == 0).all()


def test_gradients_refuse_channels_and_bad_voxels():
    with pytest.raises(SceneError, match="field"):
        central(np.ones((3, 3, 3, 3)), VOXEL)
    with pytest.raises(SceneError, match="voxel_m"):
        sobel(np.ones((3, 3, 3)), (1.0, 0.0, 1.0))


def test_gaussian_spreads_an_impulse_by_its_variance():
    field = np.zeros((33, 33, 33))
    field[16, 16, 16] = 1.0
    blurred = gaussian(field, 1.5).astype(float)
    offset = np.arange(33) - 16.0
    assert blurred.sum() == pytest.approx(1.0, abs=1e-6)
    assert (blurred.sum(axis=(1, 2)) * offset**2).sum() == pytest.approx(1.5**2, rel=5e-3)


def test_gaussian_keeps_constants_channels_and_zero_width():
    field = np.random.default_rng(0).normal(size=(5, 6, 7, 3)).astype(np.float32)
    np.testing.assert_array_equal(gaussian(field, 0), field)
    np.testing.assert_allclose(gaussian(np.full((4, 4, 4), 3.0), 2.0), 3.0)
    np.testing.assert_allclose(gaussian(field, 0.8)[..., 1], gaussian(field[..., 1], 0.8), atol=1e-7)
    with pytest.raises(SceneError, match="sigma"):
        gaussian(field, -1)


def true_radius(points, changing, voxel):
    """Distance of points (x, y, z from the first centre) to the nearest inhomogeneous cell, one by one."""
    low = np.argwhere(changing)[:, ::-1] * np.asarray(voxel)
    high = low + np.asarray(voxel)
    gap = np.maximum(np.maximum(low[None] - points[:, None], points[:, None] - high[None]), 0.0)
    return np.linalg.norm(gap, axis=2).min(axis=1)


@pytest.mark.parametrize("seed", range(4))
def test_distance_is_conservative_at_any_point_by_brute_force(seed):
    from scipy.ndimage import map_coordinates

    rng = np.random.default_rng(seed)
    shape = (14, 17, 20)
    one, two = np.ones(shape), np.zeros((*shape, 3))
    for _ in range(3):
        one[tuple(rng.integers(0, n) for n in shape)] = 1.5
        two[(*(rng.integers(0, n) for n in shape), 1)] = 7.0
    changing = np.zeros(tuple(n - 1 for n in shape), bool)
    for odd in np.argwhere((one != 1.0) | (two != 0.0).any(axis=3)):
        low = np.maximum(odd - 1, 0)
        changing[tuple(slice(a, c + 1) for a, c in zip(low, odd, strict=True))] = True
    radius = homogeneous_distance([one, two], VOXEL)
    points = rng.uniform(0, 1, size=(4000, 3)) * (np.array(shape[::-1]) - 1)
    looked_up = map_coordinates(radius.astype(float), points[:, ::-1].T, order=1)
    true = true_radius(points * VOXEL, changing, VOXEL)
    assert (looked_up <= true + 1e-9).all()
    # Not much too small either: a voxel on each side is given away, and what interpolation adds.
    assert (true - looked_up).max() <= 2.0 * np.linalg.norm(VOXEL)


def test_distance_in_the_homogeneous_is_the_diagonal_and_in_a_ramp_zero():
    assert homogeneous_distance([np.ones((4, 5, 6))], (1.0, 1.0, 1.0)).max() == pytest.approx(np.sqrt(77))
    ramp = np.arange(6.0) * np.ones((4, 5, 6))
    assert (homogeneous_distance([ramp], (1.0, 1.0, 1.0)) == 0).all()
    assert (homogeneous_distance([ramp], (1.0, 1.0, 1.0), tolerance=1.0) > 0).all()


def test_distance_refuses_bad_fields():
    with pytest.raises(SceneError, match="fields"):
        homogeneous_distance([], VOXEL)
    with pytest.raises(SceneError, match=r"fields\[1\]"):
        homogeneous_distance([np.ones((2, 2, 2)), np.ones((2, 2, 3))], VOXEL)
    with pytest.raises(SceneError, match="finite"):
        homogeneous_distance([np.full((2, 2, 2), np.nan)], VOXEL)
    with pytest.raises(SceneError, match="tolerance"):
        homogeneous_distance([np.ones((2, 2, 2))], VOXEL, -1.0)
