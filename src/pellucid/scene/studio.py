"""A photographer's studio made for glass: a dark room, soft panels, bright edges left and right.

Glass shows only what stands around it. Dark surroundings with bright cards at the sides draw its outline
("dark field" and "bright field" lighting), one large panel gives the main reflection.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from pellucid.scene.equirect import direction_at, pixel_directions


@dataclass(frozen=True)
class Panel:
    """A flat rectangle at distance 1, facing the middle of the room.

    Parameters
    ----------
    azimuth_deg, elevation_deg : direction of its centre; azimuth 0 is -Z, 90 is +X.
    half_width, half_height : in units of its distance. soft : width of its faded edge, same unit.
    radiance : (r, g, b) at its middle. roll_deg : turn about the line of sight.
    """

    azimuth_deg: float
    elevation_deg: float
    half_width: float
    half_height: float
    soft: float
    radiance: tuple[float, float, float]
    roll_deg: float = 0.0


PANELS = (
    Panel(180.0, 68.0, 0.60, 0.26, 0.22, (0.9, 0.9, 0.9)),  # overhead, above the viewer
    Panel(76.0, 14.0, 0.50, 0.46, 0.28, (1.10, 1.18, 1.30)),  # fill, right, weak and wide
    Panel(-52.0, 44.0, 0.31, 0.25, 0.09, (14.6, 14.2, 13.6), roll_deg=-8.0),  # key, left and above the back
    Panel(140.0, 14.0, 0.07, 0.62, 0.06, (18.4, 19.0, 20.0), roll_deg=5.0),  # rim strip, behind on the right
    Panel(-100.0, 3.0, 0.12, 0.50, 0.08, (4.6, 4.5, 4.4)),  # card at the horizon, left
    Panel(36.0, 3.0, 0.06, 0.36, 0.06, (3.0, 3.05, 3.1)),  # card at the horizon, right of the back
)


@cache
def studio_map(width: int = 1024) -> np.ndarray:
    """(width / 2, width, 3) float32 linear radiance, at most about 20; the same array at every call."""
    directions = pixel_directions(width // 2, width)
    result = _room(directions)
    for panel in PANELS:
        cover, glow = _mask(panel, directions)
        result += cover[..., None] * (glow[..., None] * panel.radiance - result)
    pixels = result.astype(np.float32)
    pixels.setflags(write=False)
    return pixels


def _room(directions: np.ndarray) -> np.ndarray:
    """Backdrop that glows a little at the horizon, ceiling and floor darker, floor warmer."""
    y = directions[..., 1:2]
    ceiling = 0.05 + 0.20 * np.exp(-np.maximum(y, 0.0) * 3.2)
    floor = 0.035 + 0.215 * np.exp(-np.maximum(-y, 0.0) * 9.0)
    backdrop = 1.0 + 0.8 * np.exp(4.0 * (-directions[..., 2:3] - 1.0))
    tint = np.where(y > 0.0, (0.97, 1.0, 1.05), (1.03, 1.0, 0.96))
    blend = np.exp(-np.abs(y) * 6.0)
    return np.asarray(np.where(y > 0.0, ceiling, floor) * backdrop * (tint * (1.0 - blend) + blend))


def _mask(panel: Panel, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(H, W) cover: 1 on the panel, 0 off it, smooth between; (H, W) glow: 1 at its centre, 0.7 at the corners."""
    centre = direction_at(panel.azimuth_deg, panel.elevation_deg)
    across = np.cross(centre, (0.0, 1.0, 0.0))
    across /= np.linalg.norm(across)
    along = np.cross(across, centre)
    c, s = np.cos(np.radians(panel.roll_deg)), np.sin(np.radians(panel.roll_deg))
    across, along = c * across + s * along, c * along - s * across
    facing = directions @ centre
    safe = np.maximum(facing, 1e-3)
    x, y = np.abs(directions @ across) / safe, np.abs(directions @ along) / safe
    edge = _smooth((panel.half_width - x) / panel.soft + 0.5) * _smooth((panel.half_height - y) / panel.soft + 0.5)
    glow = 1.0 - 0.3 * np.clip((x / panel.half_width) ** 2 + (y / panel.half_height) ** 2, 0.0, 2.0) / 2.0
    return np.where(facing > 0.0, edge, 0.0), glow


def _smooth(t: np.ndarray) -> np.ndarray:
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))
