"""Blurred levels send the power of the original, and nine coefficients hold its irradiance."""

import numpy as np
import pytest

from pellucid.surroundings import environment, maps
from pellucid.surroundings.resample import area_resample


def directions(height: int, width: int) -> np.ndarray:
    theta = np.pi * (np.arange(height) + 0.5)[:, None] / height
    phi = 2 * np.pi * ((np.arange(width) + 0.5)[None, :] / width - 0.5)
    return np.stack([np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.cos(phi)], axis=-1)


def power(level: np.ndarray) -> np.ndarray:
    rows = environment.row_solid_angles(level.shape[0]) / level.shape[1]
    return np.einsum("h,hwc->c", rows, level.astype(np.float64))


@pytest.mark.parametrize("size", [(64, 128), (50, 100), (37, 81), (2, 4)])
def test_every_level_sends_the_same_power(size: tuple[int, int]) -> None:
    pixels = np.random.default_rng(0).gamma(0.3, size=(*size, 3)).astype(np.float32)
    levels = environment.mip_levels(pixels)
    assert min(levels[-1].shape[:2]) == 1
    for level in levels:
        np.testing.assert_allclose(power(level), power(pixels), rtol=2e-6)


def test_irradiance_of_a_uniform_environment_is_pi_even_from_few_texels() -> None:
    coefficients = environment.irradiance_sh(np.ones((4, 8, 3)))
    np.testing.assert_allclose(coefficients[0], np.pi, rtol=1e-12)
    np.testing.assert_allclose(coefficients[1:], 0.0, atol=1e-12)


def test_irradiance_of_a_band_limited_environment_is_the_integral() -> None:
    """An environment of order 2 loses nothing: compare with direct integration over the sphere."""
    d = directions(400, 800)
    x, y, z = np.moveaxis(d, -1, 0)
    radiance = np.stack([1 + 0.5 * x + 0.3 * y * z, 1 + 0.4 * z - 0.2 * x * y, 1 + 0.3 * (x * x - z * z)], -1)
    solid = (environment.row_solid_angles(400) / 800)[:, None, None]
    normals = np.random.default_rng(3).normal(size=(20, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    direct = np.array([(np.maximum(d @ n, 0)[..., None] * radiance * solid).sum((0, 1)) for n in normals])
    by_sh = environment.irradiance_basis(normals) @ environment.irradiance_sh(radiance)
    np.testing.assert_allclose(by_sh, direct, rtol=2e-4)


def test_glossy_levels_are_the_means_under_their_lobes() -> None:
    """By plain summation over all texels, at the poles and elsewhere."""
    pixels = np.random.default_rng(5).gamma(0.5, size=(256, 512, 3)).astype(np.float32)
    pixels[20:60, 100:300] += 20.0
    levels = environment.mip_levels(pixels)
    toward = directions(128, 256).reshape(-1, 3)
    source = levels[1].reshape(-1, 3)
    solid = np.repeat(environment.row_solid_angles(128) / 256, 256)
    for k, level in enumerate(environment.glossy_levels(levels)[:3]):
        alpha = environment.GLOSSY_ALPHA * 2**k
        height, width = level.shape[:2]
        for row, column in ((0, 0), (0, width // 2), (height // 3, 5), (height - 1, 7)):
            cosine = toward @ directions(height, width)[row, column]
            lobe = solid * np.maximum(cosine, 0) / ((1 + cosine) / 2 * (alpha**2 - 1) + 1) ** 2
            np.testing.assert_allclose(level[row, column], lobe @ source / lobe.sum(), rtol=0.02)


def test_a_uniform_environment_stays_uniform_in_every_glossy_level() -> None:
    for level in environment.glossy_levels(environment.mip_levels(np.full((4, 8, 3), 0.7, np.float32))):
        np.testing.assert_allclose(level, 0.7, rtol=1e-6)


def test_resampling_up_and_back_returns_the_image() -> None:
    image = np.random.default_rng(4).random((7, 5, 3))
    np.testing.assert_allclose(area_resample(area_resample(image, (28, 20)), (7, 5)), image, rtol=1e-12)


def test_maps_share_layers_and_keep_hard_edges() -> None:
    checker = np.kron((np.indices((8, 8)).sum(0) % 2).astype(np.float32), np.ones((2, 2)))[..., None].repeat(3, 2)
    small = np.full((3, 3, 3), 0.25, np.float32)
    levels, layers = maps.stack_maps([checker, None, small, checker])
    assert layers == [0, -1, 1, 0]
    assert levels[0].shape == (2, 16, 16, 4) and len(levels) == 5
    np.testing.assert_array_equal(levels[0][0, ..., :3], checker)
    np.testing.assert_allclose(levels[-1][:, 0, 0, 0], [0.5, 0.25], rtol=1e-3)
