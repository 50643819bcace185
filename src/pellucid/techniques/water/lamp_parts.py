"""A far lamp that is seen as a disc: in the water its picture is as wide as the depth times a slope.

A photon is spread over that picture as long as it covers a few texels of the map. A wider lamp is divided, and each
part sends photons of its own through the waves.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from pellucid.techniques.water.photons import LAMP

if TYPE_CHECKING:
    from pellucid.scene import DirectionalLight

MOST_PARTS = 64
EVEN = np.sqrt(12.0)  # side of an even box over its standard deviation
LOWEST_SUN = 1e-3  # sine of the least elevation
FINE = 256  # places of a disc whose mean stands for it


def towards(lamp: DirectionalLight) -> np.ndarray:
    """(3,) unit, to the lamp."""
    way = -np.asarray(lamp.direction, np.float64)
    return np.asarray(way / np.linalg.norm(way))


def lifted(to_light: np.ndarray) -> np.ndarray:
    """(..., 3) directions to a lamp that are at least a little over the horizon."""
    raised = np.array(to_light, np.float64)
    raised[..., 1] = np.maximum(raised[..., 1], LOWEST_SUN)
    return raised


def lamp_in_parts(params: np.ndarray, lamp: DirectionalLight, texel_m: np.ndarray) -> list[np.ndarray]:
    """Records of `layouts.CausticParams` for each part of a lamp; gives `params` the width of the whole.

    Positions have the variance of the disc less that of the box over which each part is spread, so that together they
    have the disc's, by axis and at every depth.

    Parameters
    ----------
    params : () record for the middle of the lamp. texel_m : (2,) of the map, along x and z.
    """
    radius = float(np.tan(np.radians(lamp.angular_radius_deg)))
    middle, index = towards(lamp), float(params["index"][1])
    breadth = _slopes(_directions(middle, radius * _spiral(FINE)), index).std(axis=0)
    texels = float((2.0 * breadth * float(params["reach_m"]) / texel_m).max())  # half the picture of a round one
    params["lamp_side"], params["share"] = EVEN * breadth, 1.0
    if texels * EVEN / 2.0 <= LAMP:
        return [params]
    count = int(np.clip(np.ceil(np.pi * (texels / LAMP) ** 2), 4, MOST_PARTS))
    boxes = np.pi / (3.0 * count)  # share of the variance, for boxes as large as the disc's part
    ways = _directions(middle, radius * np.sqrt(1.0 - boxes) * _spiral(count))
    shares = np.maximum(ways[:, 1], 0.0) / (max(middle[1], LOWEST_SUN) * (ways @ middle).sum())
    records = []
    for way, share in zip(lifted(ways), shares, strict=True):
        part = params.copy()
        part["to_light"], part["share"], part["lamp_side"] = way, share, EVEN * np.sqrt(boxes) * breadth
        records.append(part)
    return records


@cache
def _spiral(count: int) -> np.ndarray:
    """(count, 2) places in the unit disc by the golden angle, moved so that mean and variances are exactly its own."""
    k = np.arange(count) + 0.5
    turn = k * np.pi * (3.0 - np.sqrt(5.0))
    places = np.sqrt(k / count)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    places -= places.mean(axis=0)
    skew = np.linalg.cholesky(places.T @ places / count)
    return np.asarray(0.5 * np.linalg.solve(skew, places.T).T)


def _directions(middle: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(N, 3) unit, of places in the plane across a direction at unit distance."""
    aside = np.cross(middle, (0.0, 0.0, 1.0) if abs(middle[2]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    ways = middle + places[:, :1] * aside + places[:, 1:] * np.cross(middle, aside)
    return np.asarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))


def _slopes(ways: np.ndarray, index: float) -> np.ndarray:
    """(N, 2) horizontal way over depth below a level surface."""
    inside = lifted(ways)[:, [0, 2]] / index
    return np.asarray(inside / np.sqrt(np.maximum(1.0 - (inside**2).sum(axis=1, keepdims=True), 1e-6)))
