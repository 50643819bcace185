"""Horizons of height fields, against a wall's, which has a formula, and against traced rays."""

from __future__ import annotations

import numpy as np

from pellucid.fields.horizon import horizon_map
from pellucid.techniques.relief.reference import HeightField, ReliefRays, first_below

CELL = 0.01


def hills(size: int = 48) -> np.ndarray:
    noise = np.random.default_rng(3).random((size, size))
    f = np.fft.fftfreq(size)
    smooth = np.fft.ifft2(np.fft.fft2(noise) * np.exp(-600.0 * (f[:, None] ** 2 + f**2))).real
    return 0.06 * (smooth - smooth.min()) / np.ptp(smooth)


def test_the_horizon_behind_a_wall_sinks_with_distance() -> None:
    wall = np.zeros((4, 32))
    wall[:, 20] = 0.05
    towards_u = horizon_map(wall, (CELL, CELL), tiling=False, directions=4)[0, 1]
    distance = (20 - np.arange(19)) * CELL
    np.testing.assert_allclose(towards_u[:19], 0.05 / distance, rtol=1e-5)
    np.testing.assert_allclose(towards_u[21:], 0.0, atol=1e-7)


def test_up_is_towards_growing_v() -> None:
    wall = np.zeros((32, 4))
    wall[2] = 0.05  # near the top of the array, where v is near 1
    north, south = horizon_map(wall, (CELL, CELL), tiling=False, directions=4)[[1, 3]]
    assert north[20, 1] > 0.2 and south[20, 1] == 0.0


def test_only_rays_over_the_horizon_are_free() -> None:
    """Rays a degree over the horizon pass, and a degree under it they are stopped."""
    heights = hills()
    field = HeightField(heights)
    horizon = horizon_map(heights, (CELL, CELL), directions=8)
    tile = heights.shape[0] * CELL
    rows, columns = np.mgrid[0:48:5, 0:48:5].reshape(2, -1)
    uv = np.stack([(columns + 0.5) / 48, 1.0 - (rows + 0.5) / 48], axis=1)
    for k in range(8):
        azimuth = 2 * np.pi * k / 8
        for off, free in ((1.0, 1.0), (-1.0, 0.0)):
            elevation = np.arctan(horizon[k, rows, columns]) + np.radians(off)
            flat = np.cos(elevation)
            way = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)], axis=1)
            rays = ReliefRays.of(uv, heights[rows, columns] + 1e-9, way, (tile, tile))
            passes = np.isinf(first_below(field, rays, 2 * tile))
            assert abs(passes.mean() - free) <= 0.04
