"""Drops that merged and ran, and what they left behind."""

from __future__ import annotations

import numpy as np

from pellucid.fields.drops import Drops
from pellucid.scene import Camera, DirectionalLight, Environment, ReliefLayer, ReliefQuality, ReliefSurface, Scene

from .picture import Picture


def rain(after_s: float = 3.0) -> Scene:
    """Red lacquer with a white stripe, upright and wet all over; of four drops that fell on it three still run."""
    water = Drops((384, 512), 0.00015, 11, initial=5000, rain_m_per_s=4e-6, dew_m_per_s=4e-6, volumes_ul=(0.004, 0.25))
    for x, volume, ago_s in ((-0.017, 10.0, 0.23), (-0.004, 12.0, 0.16), (0.007, 12.0, 1.2), (0.02, 10.0, 0.2)):
        water.drop(x, -0.027, volume, after_s - ago_s)
    stripe = np.abs((np.arange(512) + 0.5) / 512 - 0.72) < 0.07
    paint = np.where(stripe[None, :, None], (0.85, 0.83, 0.78), (0.42, 0.015, 0.01)) * np.ones((4, 1, 1))
    pane = ReliefSurface.plane(
        water.tile_m, ReliefLayer(0.0, colors=paint, roughness=0.3), ReliefLayer(water.advance(after_s)), tiling=False,
        rotation=(90.0, 0.0, 0.0), quality=ReliefQuality(environment="map", caustics=True),
    )  # fmt: skip
    lamp = DirectionalLight((0.55, -0.6, -0.55), (1.0, 0.95, 0.88), 2.5, angular_radius_deg=0.5)
    return Scene(
        Camera((0.014, -0.035, 0.115), (0.0, -0.001, 0.0), fov_deg=22.0), Environment.studio(intensity=0.6), [lamp],
        [pane], tone_mapping="khronos",
    )  # fmt: skip


PICTURES = (
    Picture(
        "relief-rain",
        "Rain on red lacquer",
        "Small drops of water cover red lacquer with a white stripe. Three big ones are running down and "
        "merge with what they meet; behind them, and where a fourth has run off beside the stripe, there are lanes "
        "with few drops.",
        rain,
        3,
    ),
)
