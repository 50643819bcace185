"""Whether the borders of a body of water can be seen: where land or walls stand round it they never are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.scene.water_outline import PART
from pellucid.techniques.water.reference_pictures import first_triangle

if TYPE_CHECKING:
    from pellucid.scene.water import Water
    from pellucid.surroundings import Surroundings
    from pellucid.surroundings.camera import View
    from pellucid.surroundings.geometry import Geometry

PLACES = 24  # on each side of the rectangle that are asked
BESIDE = 2e-3  # of the rectangle: walls stand this near to the border, land begins there
BELOW = 1e-3  # of the rectangle: places lie this far below the lowest wave
SIDES = np.array([(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)])


class OpenBorder:
    """Knows of one body of water whether its border is open, until it or the meshes change."""

    def __init__(self) -> None:
        self._asked: tuple[Any, ...] = ()
        self._open = True

    def shows(self, item: Water, lowest_m: float, surroundings: Surroundings) -> bool:
        """Whether the camera of the surroundings may see a border; `lowest_m` is the lowest wave over the level."""
        if item.shape.kind != PART:
            return True  # from within too
        if not is_aside(item, surroundings.view):
            return False
        geometry = surroundings.geometry
        asked = (item.bounds_m, item.level, lowest_m, geometry)
        if len(self._asked) != len(asked) or self._asked[:3] != asked[:3] or self._asked[3] is not geometry:
            self._asked = asked
            self._open = has_open_border(item, lowest_m, geometry)
        return self._open


def is_aside(item: Water, view: View) -> bool:
    """Whether a camera may look at borders from outside: it stands beyond them, or its rays are parallel."""
    (x0, z0), (x1, z1) = item.bounds_m
    x, _, z = view.position
    return view.is_orthographic or not (x0 < x < x1 and z0 < z < z1)


def has_open_border(item: Water, lowest_m: float, geometry: Geometry) -> bool:
    """Whether somewhere on the border there is neither a wall nor land that is higher than the water.

    Parameters
    ----------
    lowest_m : lowest wave over the level. geometry : of the opaque meshes.
    """
    if geometry.count == 0:
        return True
    corners = np.stack([geometry.triangles[f"corner_{k}"] for k in range(3)], axis=1).astype(np.float64)
    (x0, z0), (x1, z1) = item.bounds_m
    side = min(x1 - x0, z1 - z0)
    height, margin = item.level + lowest_m - BELOW * side, BESIDE * side
    near = corners[_reaches_over((x0, z0), (x1, z1), height, 2.0 * margin, corners)]
    middle = np.array([0.5 * (x0 + x1), height, 0.5 * (z0 + z1)])
    half = 0.5 * np.array([x1 - x0, 0.0, z1 - z0])
    s = 2.0 * (np.arange(PLACES) + 0.5) / PLACES - 1.0
    for out in SIDES:
        along = s[:, None] * np.abs(out[[2, 1, 0]])
        places = middle + (out + along) * half
        across = np.broadcast_to(2.0 * margin * out, places.shape)
        wall = first_triangle(places - margin * out, across, near) <= 1.0
        land = np.isfinite(first_triangle(places + margin * out, np.broadcast_to((0.0, 1.0, 0.0), places.shape), near))
        if not (wall | land).all():
            return True
    return False


def _reaches_over(
    low: tuple[float, float], high: tuple[float, float], height_m: float, margin_m: float, corners: np.ndarray
) -> np.ndarray:
    """Which triangles (T, 3, 3) have to do with the border of a rectangle, and are not all below a height."""
    least, most = corners.min(axis=1), corners.max(axis=1)
    one, other = np.array(low), np.array(high)
    reaches = (least[:, [0, 2]] < other + margin_m).all(axis=1) & (most[:, [0, 2]] > one - margin_m).all(axis=1)
    within = (least[:, [0, 2]] > one + margin_m).all(axis=1) & (most[:, [0, 2]] < other - margin_m).all(axis=1)
    return np.asarray(reaches & ~within & (most[:, 1] > height_m - margin_m))
