"""Lamps near water and over it: what sends photons through its waves, and parts of those that are rectangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.scene import AreaLight, DirectionalLight, PointLight
from pellucid.techniques.water.photons import LAMP

if TYPE_CHECKING:
    from pellucid.surroundings.submersion import WaterRegion

MOST_PARTS = 3  # along an edge
FEWEST_CELLS = 32  # along a side of the surface


def is_over(lamp: Any, level_m: float) -> bool:
    """Whether a lamp nearby is wholly over a height and shines down on it."""
    if isinstance(lamp, PointLight):
        return bool(lamp.position[1] > level_m)
    if not isinstance(lamp, AreaLight):
        return False
    u, v = np.asarray(lamp.edge_u), np.asarray(lamp.edge_v)
    upright = np.hypot(*np.cross(u, v)[[0, 2]])
    lowest = lamp.position[1] - 0.5 * (abs(u[1]) + abs(v[1]))
    # One that faces up lights the water as far as it leans.
    return bool(lowest > level_m and (np.cross(u, v)[1] < 0.0 or upright > 0.0))


def near_lamp_parts(params: np.ndarray, lamp: PointLight | AreaLight, region: WaterRegion) -> list[np.ndarray]:
    """Records of `layouts.CausticParams` for a lamp nearby, one for each part; `params` gets what they share.

    The picture that water makes of a lamp on what lies in it is as large as the lamp times depth / (n height + depth).
    It is divided into parts that cover some cells each; where it covers more cells than that allows, there are fewer
    cells, and photons.

    Parameters
    ----------
    params : () record that knows the water. lamp : of `is_over`.
    """
    middle = np.asarray(lamp.position, np.float64)
    params["near"], params["places"], params["share"], params["divided"] = 1.0, 1, 1.0, 1.0
    params["middle"] = params["place"] = middle
    if isinstance(lamp, PointLight):
        return [params]
    u, v = np.asarray(lamp.edge_u, np.float64), np.asarray(lamp.edge_v, np.float64)
    params["edge_u"], params["edge_v"], params["is_area"], params["places"] = u, v, 1.0, 5
    params["facing"] = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    depth_m, height_m = float(params["reach_m"]), middle[1] - region.level_m
    seen = depth_m / (region.n[1] * height_m + depth_m)
    cell_m = float(min(np.asarray(region.high_m) - region.low_m)) / int(params["cells"])
    lengths = np.array([np.linalg.norm(u), np.linalg.norm(v)]) * seen
    while lengths.max() > MOST_PARTS * LAMP * cell_m and params["cells"] >= 2 * FEWEST_CELLS:
        params["cells"] //= 2
        cell_m *= 2.0
    counts = np.clip(np.ceil(lengths / (LAMP * cell_m)), 1, MOST_PARTS)
    params["divided"], params["share"] = counts, 1.0 / counts.prod()
    return [_part(params, middle + a * u + b * v) for a in _middles(counts[0]) for b in _middles(counts[1])]


def near_lamps(lights: Sequence[Any]) -> list[PointLight | AreaLight]:
    """All lamps that are not far away."""
    return [lamp for lamp in lights if not isinstance(lamp, DirectionalLight)]


def _middles(count: float) -> np.ndarray:
    return np.asarray((np.arange(int(count)) + 0.5) / count - 0.5)


def _part(params: np.ndarray, place: np.ndarray) -> np.ndarray:
    part = params.copy()
    part["place"] = place
    return part
