"""A wine glass and the wine in it."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.errors import SceneError

from .outlines import lathe, smooth_curve
from .primitives import Shape, Values, positive

#: Outline of a glass of height 1 (radius, height): foot from the axis out, and the outside up to the rim.
FOOT = [(0.0, 0.0), (0.155, 0.0), (0.163, 0.004), (0.16, 0.009)]
OUTSIDE = [
    (0.16, 0.009), (0.11, 0.018), (0.055, 0.034), (0.027, 0.065), (0.0205, 0.12), (0.0195, 0.22),
    (0.0205, 0.33), (0.027, 0.385), (0.06, 0.43), (0.115, 0.485), (0.158, 0.56), (0.177, 0.65), (0.176, 0.75),
    (0.163, 0.87), (0.147, 1.0),
]  # fmt: skip
#: Height on the outside at which the bowl begins.
BOWL_FROM = 0.43


def wine_glass(
    height_m: float = 0.22, wall_m: float | None = None, filled: float = 0.45, overlap_m: float | None = None
) -> tuple[Shape, Shape]:
    """A stemmed glass standing on y = -height/2, and its wine; both turned on the y axis.

    The wine reaches a hair into the wall. Given to `Volume.from_regions` glass first, the glass
    has priority there and no film of air is left between them. The distance of the glass is exact; that of
    the wine is a lower bound outside.

    Parameters
    ----------
    height_m : from foot to rim.
    wall_m : thickness of the bowl, 1/90 of the height if not given.
    filled : height of the wine in the bowl, share of the bowl's depth, 0 to 1.
    overlap_m : how far the wine reaches into the wall, a quarter of the wall if not given.

    Returns
    -------
    (glass, wine).
    """
    height = positive("height_m", height_m)
    wall = height / 90.0 if wall_m is None else positive("wall_m", wall_m)
    overlap = 0.25 * wall if overlap_m is None else overlap_m
    if not 0.0 < filled < 1.0:
        raise SceneError("filled", f"is {filled}", "use a share between 0 and 1")
    if not 0.0 <= overlap < wall:
        raise SceneError("overlap_m", f"is {overlap}", "use less than the wall")
    base = np.array([0.0, -0.5 * height])
    outside = smooth_curve(OUTSIDE) * height + base
    inside = _offset_bowl(outside, wall, 0.5 * height)
    rim = _rim(outside[-1], inside[0])
    foot = np.array(FOOT[:-1]) * height + base
    glass = lathe(np.concatenate([foot, outside, rim, inside]))
    level = inside[-1, 1] + filled * (inside[0, 1] - inside[-1, 1])
    cavity = lathe(np.concatenate([inside, [(0.0, inside[0, 1])]]))

    def wine(x: Any, y: Any, z: Any) -> Values:
        return np.maximum(cavity(x, y, z) - overlap, y - level)

    return glass, wine


def _offset_bowl(outside: Values, wall: float, top: float) -> Values:
    """The inside of the bowl, rim first, bottom on the axis last: the outside moved inward by the wall."""
    height = 2.0 * top
    bowl = outside[outside[:, 1] >= BOWL_FROM * height - top]
    along = np.gradient(bowl, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    inner = bowl + wall * np.column_stack([-along[:, 1], along[:, 0]])
    inner = inner[inner[:, 0] > 0.0][::-1]
    # A round bottom: from the lowest point of the wall a parabola that meets the axis level.
    r0, y0 = inner[-1]
    slope = (inner[-2, 1] - y0) / (inner[-2, 0] - r0)
    r = np.linspace(r0, 0.0, 24)[1:]
    bottom = np.column_stack([r, y0 - 0.5 * slope * (r0 - r * r / r0)])
    inner[:, 1] = np.minimum(inner[:, 1], outside[-1, 1])
    return np.concatenate([inner, bottom])


def _rim(outer: Values, inner: Values) -> Values:
    """Half circle over the wall's end."""
    middle, arm = 0.5 * (outer + inner), 0.5 * (outer - inner)
    turn = np.linspace(0.0, np.pi, 9)[1:-1, None]
    return middle + np.cos(turn) * arm + np.sin(turn) * np.array([-arm[1], arm[0]])
