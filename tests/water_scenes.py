"""Cameras, rays and waves that tests of water share."""

from __future__ import annotations

import numpy as np

import pellucid as pl

TILE = (4.0, 4.0)


class Still:
    """Waves that do not move."""

    def __init__(self, heights: np.ndarray, tile_m: tuple[float, float] = TILE, periodic: bool = True) -> None:
        self.heights, self.tile_m, self.periodic = heights.astype(np.float32), tile_m, periodic
        self.shape = heights.shape
        self.limits_m = float(heights.min()), float(heights.max())

    def advance(self, time_s: float) -> np.ndarray:
        return self.heights


def sines(amplitude_m: float, seed: int = 1) -> Still:
    """Some sines of random directions that fit into the tile."""
    rng = np.random.default_rng(seed)
    x, z = np.meshgrid((np.arange(48) + 0.5) / 48, (np.arange(48) + 0.5) / 48)
    total = sum(
        np.sin(2.0 * np.pi * (a * x + b * z) + phase)
        for a, b, phase in zip(*rng.integers(-4, 5, (2, 6)), rng.uniform(0, 6, 6), strict=True)
    )
    return Still(amplitude_m * np.asarray(total) / np.abs(total).max())


def rays(camera: pl.Camera, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, 3) origins and directions of the pixels, row by row, and what turns way into depth."""
    width, height = size
    view = np.linalg.inv(np.asarray(camera.view_matrix(), np.float64))
    projection = np.asarray(camera.projection_matrix(size), np.float64)
    i, j = np.meshgrid(2.0 * (np.arange(width) + 0.5) / width - 1.0, 1.0 - 2.0 * (np.arange(height) + 0.5) / height)
    across = np.stack([i / projection[0, 0], j / projection[1, 1], np.zeros_like(i)], axis=-1).reshape(-1, 3)
    forward = np.array([0.0, 0.0, -1.0])
    if camera.is_orthographic:
        origins, ways = across @ view[:3, :3].T + view[:3, 3], np.broadcast_to(forward, across.shape) @ view[:3, :3].T
    else:
        origins, ways = np.broadcast_to(view[:3, 3], across.shape), (across + forward) @ view[:3, :3].T
    ways = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    return origins, ways, ways @ (view[:3, :3] @ forward)
