"""The map of all directions: row 0 is +Y, the centre column looks along -Z, +X lies to its right."""

from __future__ import annotations

import numpy as np


def pixel_directions(height: int, width: int) -> np.ndarray:
    """(H, W, 3) float64 unit directions of the pixel centres."""
    theta = np.pi * (np.arange(height) + 0.5)[:, None] / height
    phi = 2.0 * np.pi * ((np.arange(width) + 0.5)[None, :] / width - 0.5)
    sine = np.sin(theta)
    return np.stack([sine * np.sin(phi), np.broadcast_to(np.cos(theta), (height, width)), -sine * np.cos(phi)], -1)


def pixel_solid_angles(height: int, width: int) -> np.ndarray:
    """(H, 1) float64 exact solid angle in steradian of one pixel of each row; H * W of them make 4 pi."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    return ((edges[:-1] - edges[1:]) * 2.0 * np.pi / width)[:, None]


def direction_at(azimuth_deg: float, elevation_deg: float) -> np.ndarray:
    """(3,) unit direction; azimuth 0 is -Z and grows towards +X, elevation grows towards +Y."""
    a, e = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.array([np.cos(e) * np.sin(a), np.sin(e), -np.cos(e) * np.cos(a)])


def look_up(pixels: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Bilinear look-up of `pixels` (H, W, C) in `directions` (..., 3): (..., C) float64.

    Columns wrap round; rows end at the poles.
    """
    height, width = pixels.shape[:2]
    d = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    x = (0.5 + np.arctan2(d[..., 0], -d[..., 2]) / (2.0 * np.pi)) * width - 0.5
    y = np.clip(np.arccos(np.clip(d[..., 1], -1.0, 1.0)) / np.pi * height - 0.5, 0.0, height - 1.0)
    left, top = np.floor(x).astype(int), np.minimum(np.floor(y).astype(int), max(height - 2, 0))
    fx, fy = (x - left)[..., None], (y - top)[..., None]
    below = np.minimum(top + 1, height - 1)
    columns = left % width, (left + 1) % width
    rows = [pixels[row, columns[0]] * (1.0 - fx) + pixels[row, columns[1]] * fx for row in (top, below)]
    return np.asarray(rows[0] * (1.0 - fy) + rows[1] * fy)
