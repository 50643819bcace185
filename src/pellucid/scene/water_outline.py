"""What a body of water is bounded by besides its surface: an outline seen from above, and a floor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene import checks

OUTLINES = ("rectangle", "ellipse")
FLOORS = ("flat", "round")
MOST_CORNERS = 16
ENDLESS_M = 1e30  # depth of water without a floor of its own
FLATTEST = 1e-9  # sine of the angle at a corner that lies on a straight edge
PART, ELLIPSE, POLYGON = 0, 1, 2

Corners = tuple[tuple[float, float], ...]


@dataclass(frozen=True, eq=False)
class WaterShape:
    """The space that is bounded by an outline, that may narrow with the depth, and a floor.

    Attributes
    ----------
    kind : ``PART`` of a larger water, cut out by a rectangle; or what has borders of its own: ``ELLIPSE``, ``POLYGON``.
    middle : (x, z) that it narrows towards. half : halves of its size along x and z, metres.
    bend : (b, c) of ellipses: (x/a)^2 + (z/b)^2 <= 1 + b h + c h^2 at the depth h; 1/m and 1/m^2.
    depth_m : of a flat floor; ``ENDLESS_M`` where there is none.
    edges : (N, 4) of polygons: x n_x + z n_z + s h <= d from the middle, as n_x, n_z, s, d.
    """

    kind: int
    middle: tuple[float, float]
    half: tuple[float, float]
    bend: tuple[float, float]
    depth_m: float
    edges: np.ndarray

    @property
    def widest(self) -> float:
        """How much wider it is anywhere below its surface than there."""
        b, c = self.bend
        return float(np.sqrt(1.0 - b * b / (4.0 * c))) if b > 0.0 > c else 1.0

    def holds(self, offset: Any) -> np.ndarray:
        """Whether points are within, its borders too.

        Parameters
        ----------
        offset : (..., 3) from the middle of the surface at rest, metres.
        """
        x, y, z = np.moveaxis(np.asarray(offset, np.float64), -1, 0)
        inside = -y <= self.depth_m
        if self.kind == ELLIPSE:
            b, c = self.bend
            return np.asarray(inside & ((x / self.half[0]) ** 2 + (z / self.half[1]) ** 2 <= 1.0 - b * y + c * y * y))
        for n_x, n_z, s, d in self.edges:
            inside &= n_x * x + n_z * z - s * y <= d
        return np.asarray(inside)


def shape_of(
    outline: str | Corners,
    center: tuple[float, float],
    size_m: tuple[float, float],
    floor: tuple[float | None, str, float],
) -> WaterShape:
    """The space of a body of water whose fields were checked.

    Parameters
    ----------
    floor : depth_m, floor and floor_scale of a ``Water``.
    """
    depth_m, kind, scale = floor
    half = 0.5 * size_m[0], 0.5 * size_m[1]
    deep = ENDLESS_M if depth_m is None else depth_m
    if outline == "ellipse":
        # A ball's part has D^2 / r^2 of the square in it, the rest along the depth; a cone the square of 1 - t h / D.
        square, narrows = deep * deep / (half[0] * half[1]), 1.0 - scale
        first, second = (square - 1.0, -square) if kind == "round" else (-2.0 * narrows, narrows * narrows)
        bend = first / deep, second / deep**2
        # A round floor ends where its bend does.
        return WaterShape(ELLIPSE, center, half, bend, ENDLESS_M if kind == "round" else deep, np.zeros((0, 4)))
    if outline == "rectangle":
        corners = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) * half
        edges = np.zeros((0, 4)) if depth_m is None else _edges(corners, (1.0 - scale) / deep)
        return WaterShape(PART if depth_m is None else POLYGON, center, half, (0.0, 0.0), deep, edges)
    corners = np.asarray(outline)
    middle = _middle(corners)
    place = center[0] + middle[0], center[1] + middle[1]
    return WaterShape(POLYGON, place, half, (0.0, 0.0), deep, _edges(corners - middle, (1.0 - scale) / deep))


def checked_outline(value: Any) -> str | Corners:
    """One of ``OUTLINES``, or the corners (x, z) of a convex polygon in the order in which x turns to z.

    Raises
    ------
    SceneError : it is neither.
    """
    name = "water.outline"
    remedy = f"give {', '.join(map(repr, OUTLINES))}, or (x, z) of 3 to {MOST_CORNERS} corners in metres"
    if isinstance(value, str):
        if value not in OUTLINES:
            raise SceneError(name, f"must be one of {', '.join(map(repr, OUTLINES))}, got {value!r}", remedy)
        return value
    try:
        corners = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise SceneError(name, f"must be a name or corners, got {value!r:.60}", remedy) from None
    if corners.ndim != 2 or corners.shape[1] != 2:
        raise SceneError(name, f"must be a name or an array (N, 2), got the shape {corners.shape}", remedy)
    if not 3 <= len(corners) <= MOST_CORNERS:
        raise SceneError(name, f"has {len(corners)} corners", remedy)
    pairs = [tuple(checks.number(f"{name}[{k}]", v, unit="metres") for v in pair) for k, pair in enumerate(corners)]
    corners = np.array(pairs)
    _check_convex(name, corners)
    ordered = corners if _area(corners) > 0.0 else corners[::-1]
    return tuple((float(x), float(z)) for x, z in ordered)


def _check_convex(name: str, corners: np.ndarray) -> None:
    along = np.roll(corners, -1, axis=0) - corners
    length = np.hypot(*along.T)
    if (length <= 0.0).any():
        k = int(np.argmin(length))
        raise SceneError(f"{name}[{k}]", "lies where the next corner does", "leave one of them out")
    way = along / length[:, None]
    before = np.roll(way, 1, axis=0)
    sine = before[:, 0] * way[:, 1] - before[:, 1] * way[:, 0]
    turned = np.arctan2(sine, (before * way).sum(axis=1))
    side = np.sign(turned.sum())
    if (side * sine < FLATTEST).any():
        k = int(np.argmin(side * sine))
        remedy = "leave out corners on a straight edge; round bays of land or walls give the convex hull"
        raise SceneError(f"{name}[{k}]", "makes no convex corner", remedy)
    if abs(abs(turned.sum()) - 2.0 * np.pi) > 1e-6:
        raise SceneError(name, "goes round more than once", "give each corner once, in order")


def _area(corners: np.ndarray) -> float:
    x, z = corners.T
    return 0.5 * float((x * np.roll(z, -1) - np.roll(x, -1) * z).sum())


def _middle(corners: np.ndarray) -> np.ndarray:
    """Centre of gravity of a polygon."""
    after = np.roll(corners, -1, axis=0)
    cross = corners[:, 0] * after[:, 1] - after[:, 0] * corners[:, 1]
    return np.asarray(((corners + after) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum()))


def _edges(corners: np.ndarray, narrows_per_m: float) -> np.ndarray:
    along = np.roll(corners, -1, axis=0) - corners
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
    away = (outward * corners).sum(axis=1)
    return np.column_stack([outward, narrows_per_m * away, away])
