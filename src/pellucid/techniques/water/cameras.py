"""Where the pictures are taken that stand for the scene below and above a surface of water; no GPU.

A camera above the water looks for what is below along rays that the surface has turned, and for what is above along
mirrored ones. [mihalik2008, 5.1, 5.2] turns and mirrors the camera itself and widens it; `fitted` widens it by just
what the rays of the visible surface need.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from pellucid.optics.snell import reflect, refract
from pellucid.surroundings.camera import View

Array = npt.NDArray[np.float64]

UP = np.array([0.0, 1.0, 0.0])
FAR_M = 1e4  # stands for infinitely far away
GRID = 17  # rays a side of a picture that ask where it shows water
STEEPEST = 0.35  # slope; what steeper waves turn out of the pictures is found otherwise
NEAREST = 0.03  # of the depth: between camera and level
MARGIN = 1.12  # points of waves lie beside those of the level


@dataclass(frozen=True)
class Basin:
    """What cameras need to know of a body of water.

    level_m : of the surface at rest. low, high : (x, z) corners of the rectangle.
    slope : steepest of the waves. n_water, n_outside : indices.
    bottom_m, top_m : heights that nothing to be seen in the water lies under, and nothing above it lies over.
    """

    level_m: float
    low: tuple[float, float]
    high: tuple[float, float]
    slope: float
    n_water: float
    n_outside: float
    bottom_m: float
    top_m: float = np.inf


def reflection_camera(view: View, level_m: float) -> View:
    """The camera mirrored in the level: it sees along mirrored rays [mihalik2008, 5.2]. Its picture is left-handed."""
    mirror = np.diag([1.0, -1.0, 1.0, 1.0])
    mirror[1, 3] = 2.0 * level_m
    return replace(view, view_from_world=view.view_from_world @ mirror)


def refraction_camera(
    view: View, level_m: float, n_from: float, n_into: float, ndc: tuple[float, float] = (0.0, -1.0)
) -> View:
    """The camera turned about O, where one of its rays meets the level, as the level turns that ray.

    Parameters
    ----------
    view : the camera. n_from, n_into : indices on its side of the surface and beyond.
    ndc : the ray, in halves of the picture from its middle; [mihalik2008, 5.1] takes the middle of the lower border.

    Notes
    -----
    O by [mihalik2008, eq. 1], the angle between incident and refracted ray by eq. 2. Where that ray meets no water, or
    is totally reflected, the camera stays.
    """
    origin, incident = ray_of(view, ndc)
    side = np.sign(origin[1] - level_m) or 1.0
    if side * incident[1] >= 0.0:
        return view
    pivot = origin + incident * (level_m - origin[1]) / incident[1]
    refracted = refract(incident, side * UP, n_from, n_into)
    if not refracted.valid:
        return view
    return turned(view, pivot, incident, np.asarray(refracted.direction))


def ray_of(view: View, ndc: tuple[float, float]) -> tuple[Array, Array]:
    """Origin and unit direction (3,) of the ray through a point of the picture, in halves of it, y up."""
    origins, ways = rays_of(view, np.array([ndc]))
    return origins[0], ways[0]


def rays_of(view: View, ndc: Array) -> tuple[Array, Array]:
    """Origins and unit directions (N, 3) of the rays through points (N, 2) of the picture, in halves of it, y up."""
    across = (ndc * view.half_extent) @ view.axes[:2]
    if view.is_orthographic:
        return view.position + across, np.broadcast_to(view.axes[2], across.shape)
    ways = view.axes[2] + across
    return np.broadcast_to(view.position, across.shape), ways / np.linalg.norm(ways, axis=1, keepdims=True)


def turned(view: View, pivot: Array, before: Array, after: Array) -> View:
    """A camera carried round a point by the rotation that takes one unit direction into another the short way."""
    axis = np.cross(before, after)
    sine, cosine = float(np.linalg.norm(axis)), float(before @ after)
    if sine < 1e-12:
        return view
    k = axis / sine
    cross = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
    rotation = np.eye(3) + sine * cross + (1.0 - cosine) * cross @ cross
    world = np.eye(4)
    world[:3, :3], world[:3, 3] = rotation, pivot - rotation @ pivot
    return replace(view, view_from_world=view.view_from_world @ np.linalg.inv(world))


def widened(view: View, factor: float) -> View:
    """A camera that shows `factor` times as much along both axes, about the middle [mihalik2008, 5.2]."""
    projection = view.projection.copy()
    projection[0, 0] /= factor
    projection[1, 1] /= factor
    return replace(view, projection=projection)


def fitted(view: View, points: Array, widest: float) -> View:
    """A camera at the same place whose picture just holds points; it looks where their middle is.

    Parameters
    ----------
    points : (N, 3) in the world. Those behind the camera are left out.
    widest : half width and height at most, tangents.
    """
    right, up, forward = view.axes
    for _ in range(3):
        x, y, depth = np.stack([right, up, forward]) @ (points - view.position).T
        ahead = depth > 1e-3 * np.hypot(x, y)
        if not ahead.any():
            return view
        across = np.stack([x[ahead], y[ahead]]) / (1.0 if view.is_orthographic else depth[ahead])
        low, high = across.min(axis=1), across.max(axis=1)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        if view.is_orthographic:
            moved = view.position + middle[0] * right + middle[1] * up
            return _placed(view, np.stack([right, up, forward]), moved, MARGIN * half)
        # The middle of the angles, not of the tangents: wide pictures would lean to their far side.
        angles = 0.5 * (np.arctan(low) + np.arctan(high))
        forward = forward + np.tan(angles[0]) * right + np.tan(angles[1]) * up
        forward = forward / np.linalg.norm(forward)
        right = _unit(right - (right @ forward) * forward)
        up = _unit(up - (up @ forward) * forward - (up @ right) * right)
    x, y, depth = np.stack([right, up, forward]) @ (points - view.position).T
    ahead = depth > 1e-3 * np.hypot(x, y)
    half = np.abs(np.stack([x[ahead], y[ahead]]) / depth[ahead]).max(axis=1) if ahead.any() else view.half_extent
    return _placed(view, np.stack([right, up, forward]), view.position, np.clip(MARGIN * half, 1e-3, widest))


def pictures(view: View, basin: Basin, mode: str, field_of_view: float) -> tuple[View | None, View | None]:
    """The cameras of the pictures of what lies below the surface and above it; None for what cannot be seen.

    Parameters
    ----------
    mode : ``"mihalik"``: turned, mirrored and widened by `field_of_view`; from below the camera itself looks up
        [mihalik2008, 7.5]. ``"fitted"``: to the rays of the visible surface, at most `field_of_view` times as wide as
        the camera, or as 60 degrees.
    """
    within = bool(view.position[1] < basin.level_m)
    if within and not holds(basin, view.position):
        return widened(view, field_of_view), None  # through an open border
    mirrored = reflection_camera(view, basin.level_m)
    basin = _away(view, basin)
    points, ways = visible_surface(view, basin)
    if not len(points):
        return None, None
    if mode == "mihalik":
        across = view if within else refraction_camera(view, basin.level_m, basin.n_outside, basin.n_water)
        across, mirrored = widened(across, field_of_view), widened(mirrored, field_of_view)
        return (mirrored, across) if within else (across, mirrored)
    below, above = _seen_from(points, ways, basin, within)
    widest = field_of_view * max(float(view.half_extent.max()), np.tan(np.radians(30.0)))
    if within:
        return fitted(mirrored, below, widest), fitted(view, above, widest) if len(above) else None
    turns = [fitted(across, below, np.inf) for across in _turned_to(view, points, basin)]
    # The steepest hides least behind what stands on the bottom.
    fits = [across for across in turns if view.is_orthographic or across.half_extent.max() <= widest]
    chosen = fits[0] if fits else min(turns, key=lambda across: float(across.half_extent.max()))
    return fitted(chosen, below, widest), fitted(mirrored, above, widest)


def holds(basin: Basin, point: Array) -> bool:
    """Whether a point (3,) lies above or below the rectangle."""
    (x0, z0), (x1, z1) = basin.low, basin.high
    return bool(x0 <= point[0] <= x1 and z0 <= point[2] <= z1)


def visible_surface(view: View, basin: Basin) -> tuple[Array, Array]:
    """Points (N, 3) of the level that a picture shows, and the unit directions (N, 3) in which it sees them."""
    inward = np.linspace(-1.0, 1.0, GRID)
    origins, ways = rays_of(view, np.stack(np.meshgrid(inward, inward), axis=-1).reshape(-1, 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (basin.level_m - origins[:, 1]) / ways[:, 1]
    ok = np.isfinite(t) & (t > 0.0) & (t < FAR_M)
    points = origins[ok] + ways[ok] * t[ok, None]
    points = np.concatenate([points, _border(view, basin)])
    (x0, z0), (x1, z1) = basin.low, basin.high
    slack = 1e-6 * max(x1 - x0, z1 - z0)
    x, _, z = points.T
    points = points[(x >= x0 - slack) & (x <= x1 + slack) & (z >= z0 - slack) & (z <= z1 + slack)]
    ways = np.broadcast_to(view.axes[2], points.shape) if view.is_orthographic else points - view.position
    return points, ways / np.linalg.norm(ways, axis=1, keepdims=True)


def _away(view: View, basin: Basin) -> Basin:
    """The basin with its level some way from a camera that is nearly in it, and sees waves where it sees no level."""
    side = min(high - low for low, high in zip(basin.low, basin.high, strict=True))
    least = min(NEAREST * max(basin.level_m - basin.bottom_m, 0.0), 0.01 * side)
    height = view.position[1] - basin.level_m
    if abs(height) >= least:
        return basin
    return replace(basin, level_m=float(view.position[1]) + (least if height < 0.0 else -least))


def _border(view: View, basin: Basin) -> Array:
    """Points on the border of the rectangle that the picture shows: a pond may lie between its rays."""
    (x0, z0), (x1, z1) = basin.low, basin.high
    s = np.linspace(0.0, 1.0, 33)
    x = np.concatenate([x0 + s * (x1 - x0), x0 + s * (x1 - x0), np.full(33, x0), np.full(33, x1)])
    z = np.concatenate([np.full(33, z0), np.full(33, z1), z0 + s * (z1 - z0), z0 + s * (z1 - z0)])
    points = np.stack([x, np.full(132, basin.level_m), z], axis=1)
    clip = np.concatenate([points, np.ones((132, 1))], axis=1) @ (view.projection @ view.view_from_world).T
    return points[(clip[:, 3] > 0.0) & (np.abs(clip[:, :2]) <= clip[:, 3:]).all(axis=1)]


def _seen_from(points: Array, ways: Array, basin: Basin, within: bool) -> tuple[Array, Array]:
    """What lies at the ends of the rays of the surface below and above it, for level water and for leaning waves."""
    lean = min(0.5 * basin.slope, STEEPEST)
    below, above = [points], [points]
    for dx, dz in ((0.0, 0.0), (lean, 0.0), (-lean, 0.0), (0.0, lean), (0.0, -lean)):
        normal = _unit(np.array([-dx, 1.0, -dz])) * (-1.0 if within else 1.0)
        facing = ways @ normal < -1e-3
        mirrored = reflect(ways[facing], normal)
        indices = (basin.n_water, basin.n_outside) if within else (basin.n_outside, basin.n_water)
        bent = refract(ways[facing], np.broadcast_to(normal, mirrored.shape), *indices)
        passed, start = bent.direction[bent.valid], points[facing]
        down, up = (mirrored, passed) if within else (passed, mirrored)
        down_from, up_from = (start, start[bent.valid]) if within else (start[bent.valid], start)
        fall = np.maximum(-down[:, 1], 0.05)
        below.append(down_from + down * (max(basin.level_m - basin.bottom_m, 0.0) / fall)[:, None])
        rise = max(basin.top_m - basin.level_m, 0.0) / np.maximum(up[:, 1], 0.05)
        above.append(up_from + up * np.minimum(rise, FAR_M)[:, None])
    return np.concatenate(below), np.concatenate(above[1:])


def _turned_to(view: View, points: Array, basin: Basin) -> list[View]:
    """The camera turned by the ray to the middle of the visible water, by that of its lower border, and between them.

    Turned about something far away it stands high, and has what is near below it.
    """
    right, up, forward = view.axes
    x, y, depth = np.stack([right, up, forward]) @ (points - view.position).T
    across = np.stack([x, y]) if view.is_orthographic else np.stack([x, y]) / np.maximum(depth, 1e-6)
    middle = across.mean(axis=1) / view.half_extent
    rays = [(float(share * middle[0]), float(share * (middle[1] + 1.0) - 1.0)) for share in (1.0, 0.5, 0.0)]
    return [refraction_camera(view, basin.level_m, basin.n_outside, basin.n_water, ray) for ray in rays]


def _placed(view: View, axes: Array, position: Array, half: Array) -> View:
    """The same kind of camera with other axes (rows right, up, forward), place and half extents."""
    world = np.eye(4)
    world[:3, 0], world[:3, 1], world[:3, 2], world[:3, 3] = axes[0], axes[1], -axes[2], position
    projection = view.projection.copy()
    projection[0, 0], projection[1, 1] = 1.0 / np.maximum(half, 1e-6)
    return replace(view, view_from_world=np.linalg.inv(world), projection=projection)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v))
