"""Sheets that several tests look at, and what rays do at a level one."""

from __future__ import annotations

from typing import Any

import numpy as np

import pellucid as pl
from pellucid.optics import fresnel_dielectric, refract

N = 1.333
SIZE = (48, 40)
ONE = pl.Environment.constant(1.0)
GREY = np.full((4, 4, 3), 0.5, np.float32)
CAMERA = pl.Camera((0.5, 1.1, 1.3), (0.05, 0.0, 0.1), fov_deg=38)


def waves(height_m: float = 0.02) -> np.ndarray:
    z, x = np.mgrid[0:48, 0:48] / 48 * 2 * np.pi
    return height_m * np.sin(2 * x + 0.5) * np.cos(z)


def drawn(renderer: pl.Renderer, camera: pl.Camera = CAMERA, size: tuple[int, int] = SIZE, **look: Any) -> pl.Frame:
    """A picture of a sheet in a uniform environment."""
    given = {"picture": GREY, "depth_m": 0.4, "size_m": 2.0, "medium": N} | look
    scene = pl.Scene(camera, ONE, objects=[pl.RefractiveSheet(**given)], tone_mapping="linear")
    return renderer.render(scene, size)


def shown(renderer: pl.Renderer, show: str, **look: Any) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of the pixels that show the sheet, and which do."""
    frame = drawn(renderer, show=show, **look)
    return frame.radiance.astype(np.float64), np.isfinite(frame.depth)


def rays(camera: pl.Camera, size: tuple[int, int] = SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Origins and unit directions (H, W, 3) through pixel centres."""
    world = np.linalg.inv(np.asarray(camera.view_matrix(), float))
    projection = np.asarray(camera.projection_matrix(size), float)
    x = (2 * (np.arange(size[0]) + 0.5) / size[0] - 1) / projection[0, 0]
    y = (1 - 2 * (np.arange(size[1]) + 0.5) / size[1]) / projection[1, 1]
    d = np.stack([*np.meshgrid(x, y), -np.ones((size[1], size[0]))], -1) @ world[:3, :3].T
    return np.broadcast_to(world[:3, 3], d.shape), d / np.linalg.norm(d, axis=-1, keepdims=True)


def level_hits(camera: pl.Camera, depth: float = 0.4, n: float = N) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where rays enter a level sheet, x and z of where they end by Snell's law, and their reflectance."""
    origin, d = rays(camera)
    p = origin - d * (origin[..., 1:2] / d[..., 1:2])
    up = np.broadcast_to((0.0, 1.0, 0.0), d.shape)
    down = refract(d, up, np.ones(d.shape[:2]), np.full(d.shape[:2], n)).direction
    return p, (p + down * (depth / -down[..., 1:2]))[..., (0, 2)], fresnel_dielectric(-d[..., 1], 1.0, n)
