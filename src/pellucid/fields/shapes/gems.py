"""Cut stones: convex bodies between planes. The table faces +y, the culet -y, the girdle lies about y = 0."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

from .primitives import Shape, Values, positive


def convex(normals: npt.ArrayLike, offsets_m: npt.ArrayLike) -> Shape:
    """The body `normal . p <= offset` for all planes; exact inside, a lower bound outside.

    The largest of the plane distances never exceeds the distance to the body, which lies behind
    every plane.

    Parameters
    ----------
    normals : (N, 3) outward directions.
    offsets_m : (N,) distances of the planes from the origin.
    """
    n = np.asarray(normals, dtype=float)
    lengths = np.linalg.norm(n, axis=1)
    n = n / lengths[:, None]
    d = np.asarray(offsets_m, dtype=float) / lengths

    def distance(x: Any, y: Any, z: Any) -> Values:
        worst = np.full(np.broadcast(x, y, z).shape, -np.inf)
        for (a, b, c), offset in zip(n, d, strict=True):
            np.maximum(worst, a * x + b * y + c * z - offset, out=worst)
        return worst

    return distance


def brilliant_planes(
    diameter_m: float,
    table: float = 0.53,
    crown_deg: float = 34.5,
    pavilion_deg: float = 40.75,
    girdle: float = 0.02,
    star: float = 0.5,
    lower_half: float = 0.77,
) -> tuple[Values, Values]:
    """The 57 facets of a round brilliant, as planes.

    The three proportions that set the light are Tolkowsky's: table 53 % of the diameter, crown 34.5 deg,
    pavilion 40.75 deg [tolkowsky1919]; hence crown height 16.2 % and pavilion depth 43.1 %. Mains pass
    through the girdle at multiples of 45 deg. Stars and halves follow: each is the plane of three
    points that it shares with its neighbours.

    Parameters
    ----------
    diameter_m : of the girdle.
    table : width of the table between opposite corners, share of the diameter.
    crown_deg, pavilion_deg : angles of the main facets with the girdle plane.
    girdle : thickness, share of the diameter.
    star : how far stars reach from the table's edge to the girdle, as a share.
    lower_half : how far lower halves reach from the girdle to the culet, as a share.

    Returns
    -------
    normals (57, 3) and offsets (57,): table, 8 stars, 8 crown mains, 16 upper halves, 16 lower halves, 8
    pavilion mains.
    """
    r = 0.5 * positive("diameter_m", diameter_m)
    if not (0.2 <= table <= 0.9 and 0.0 < crown_deg < 60.0 and 0.0 < pavilion_deg < 60.0 and 0.0 < girdle < 0.2):
        raise SceneError("table, crown_deg, pavilion_deg, girdle", "are no proportions of a brilliant")
    rise, fall = np.tan(np.radians(crown_deg)), np.tan(np.radians(pavilion_deg))
    top, eighth = girdle * r, np.pi / 4.0
    between = np.cos(eighth / 2.0)
    table_r, table_y = table * r, top + (1.0 - table) * r * rise
    # Edge between two crown mains, in the plane half way between them.
    star_r = table_r * between + star * (r - table_r * between)
    star_y = top + (r - star_r * between) * rise
    low_r = (1.0 - lower_half) * r
    low_y = -top - (r - low_r * between) * fall

    planes = [_plane((0.0, table_y, 0.0), (0.0, table_y, 1.0), (1.0, table_y, 0.0))]
    turns = np.arange(8) * eighth
    half = eighth / 2.0
    for a in turns:
        planes.append(
            _plane(_at(table_r, table_y, a), _at(table_r, table_y, a + eighth), _at(star_r, star_y, a + half))
        )
    planes += [_main(a, r, top, rise) for a in turns]
    for a in turns:
        for s in (half, -half):
            planes.append(_plane(_at(star_r, star_y, a + s), _at(r, top, a), _at(r, top, a + s)))
    for a in turns:
        for s in (half, -half):
            planes.append(_plane(_at(low_r, low_y, a + s), _at(r, -top, a), _at(r, -top, a + s)))
    planes += [_main(a, r, -top, -fall) for a in turns]
    normals, offsets = zip(*planes, strict=True)
    return np.array(normals), np.array(offsets)


def brilliant_cut(diameter_m: float, **proportions: float) -> Shape:
    """Round brilliant with a round girdle; `proportions` as in `brilliant_planes`."""
    body = convex(*brilliant_planes(diameter_m, **proportions))
    radius = 0.5 * diameter_m
    return lambda x, y, z: np.maximum(body(x, y, z), np.hypot(x, z) - radius)


def emerald_planes(length_m: float, width_m: float, corner: float = 0.18) -> tuple[Values, Values]:
    """Planes of an emerald cut: an oblong with cut corners, three steps above and three below the girdle.

    Parameters
    ----------
    length_m, width_m : along x and z.
    corner : how much of the width each corner takes off both sides.

    Returns
    -------
    normals (57, 3) and offsets (57,): table, 8 girdle sides, 24 crown and 24 pavilion steps.
    """
    length, width = positive("length_m", length_m), positive("width_m", width_m)
    if length < width or not 0.0 < corner < 0.45:
        raise SceneError("length_m, width_m, corner", "need length >= width and a corner between 0 and 0.45")
    cut = corner * width
    reach = {0: length / 2.0, 2: width / 2.0, 1: (length / 2.0 + width / 2.0 - cut) / np.sqrt(2.0)}
    # (inset, height) in shares of the width, from the girdle to the table and to the keel.
    crown = np.array([(0.0, 0.015), (0.055, 0.075), (0.115, 0.12), (0.185, 0.15)]) * width
    pavilion = np.array([(0.0, -0.015), (0.12, -0.17), (0.28, -0.335), (0.5, -0.495)]) * width
    normals, offsets = [(0.0, 1.0, 0.0)], [crown[-1, 1]]
    for k in range(8):
        out = (np.cos(k * np.pi / 4.0), np.sin(k * np.pi / 4.0))
        distance = reach[min(k % 4, 4 - k % 4)]
        normals.append((out[0], 0.0, out[1]))
        offsets.append(distance)
        for steps in (crown, pavilion):
            for (i0, y0), (i1, y1) in itertools.pairwise(steps):
                slope = np.array([abs(y1 - y0), (i1 - i0) * np.sign(y1 - y0)])
                slope /= np.linalg.norm(slope)
                normals.append((out[0] * slope[0], slope[1], out[1] * slope[0]))
                offsets.append(slope[0] * (distance - i0) + slope[1] * y0)
    return np.array(normals), np.array(offsets)


def emerald_cut(length_m: float, width_m: float, corner: float = 0.18) -> Shape:
    """Emerald cut; see `emerald_planes`."""
    return convex(*emerald_planes(length_m, width_m, corner))


def rhombohedron(edge_m: float, blunt_deg: float = 101.9) -> tuple[Shape, Values]:
    """A rhombohedron that lies on one of its six faces; with the angle of calcite's cleavage unless told.

    Parameters
    ----------
    edge_m : length of its edges.
    blunt_deg : blunt angle of its rhombs, above 90 and below 120; three of them meet in two opposite corners.

    Returns
    -------
    The shape, centred on the origin, faces up and down along y; and the line through its two blunt corners (3,), unit:
    the optic axis of calcite.
    """
    edge = positive("edge_m", edge_m)
    if not 90.0 < blunt_deg < 120.0:
        raise SceneError("blunt_deg", f"is {blunt_deg:g}", "three blunt angles meet in a corner: 90 to 120 degrees")
    # Edges from a blunt corner lean by `lean` from the axis, 120 degrees apart.
    lean = np.arcsin(np.sqrt((1.0 - np.cos(np.radians(blunt_deg))) / 1.5))
    turns = np.radians([0.0, 120.0, 240.0])
    edges = np.stack([np.sin(lean) * np.cos(turns), np.sin(lean) * np.sin(turns), np.full(3, np.cos(lean))], axis=1)
    normals = np.cross(np.roll(edges, -1, axis=0), np.roll(edges, -2, axis=0))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    half = 0.5 * edge * float(np.abs(normals[0] @ edges[0]))
    side = np.cross(edges[1], normals[0])
    turn = np.stack([edges[1], normals[0], side])  # rows: where x, y and z of the result lie
    faces = np.concatenate([normals, -normals]) @ turn.T
    return convex(faces, np.full(6, half)), turn @ np.array([0.0, 0.0, 1.0])


def _at(radius: float, height: float, turn: float) -> tuple[float, float, float]:
    return radius * np.cos(turn), height, radius * np.sin(turn)


def _main(turn: float, radius: float, height: float, slope: float) -> tuple[Values, float]:
    """Plane through the girdle at one turn, that rises (or, with a negative slope, falls) towards the axis."""
    normal = np.array([abs(slope) * np.cos(turn), np.sign(slope), abs(slope) * np.sin(turn)])
    normal /= np.linalg.norm(normal)
    return normal, float(normal @ _at(radius, height, turn))


def _plane(a: Any, b: Any, c: Any) -> tuple[Values, float]:
    """Plane of three points, facing away from the origin."""
    normal = np.cross(np.subtract(b, a), np.subtract(c, a))
    normal /= np.linalg.norm(normal)
    offset = float(normal @ np.asarray(a))
    return (normal, offset) if offset >= 0.0 else (-normal, -offset)
