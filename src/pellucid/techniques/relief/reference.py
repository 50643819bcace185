"""Rays and height fields in float64 NumPy: where they truly meet, and what a refracting layer does to light.

Slow, and written to be compared with: cell after cell is walked, and in each the bilinear patch is met exactly. Tests
and `tools/relief_search_table.py` hold the searches of `shaders/` against it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.optics.attenuation import transmittance
from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.optics.snell import refract

Array = npt.NDArray[Any]

NONE, TRANSLUCENT, SOLID = 0, 1, 2


@dataclass(frozen=True)
class ReliefRays:
    """Rays in a relief: at t metres of the world they are at uv + t duv, h + t dh + t^2 bend.

    uv, duv : (N, 2) tiles, tiles per metre. h, dh, bend : (N,) metres, metres per metre, 1/m.
    """

    uv: Array
    h: Array
    duv: Array
    dh: Array
    bend: Array

    @classmethod
    def of(cls, uv: npt.ArrayLike, h: npt.ArrayLike, d_ts: npt.ArrayLike, tile_m: tuple[float, float]) -> ReliefRays:
        """Rays over a plane along unit directions d_ts (N, 3) with x along u, y along v and z along the normal."""
        d = np.atleast_2d(np.asarray(d_ts, dtype=np.float64))
        n = len(d)
        start = np.broadcast_to(np.asarray(uv, np.float64), (n, 2))
        height = np.broadcast_to(np.asarray(h, np.float64), (n,))
        return cls(start, height, d[:, :2] / np.asarray(tile_m), d[:, 2], np.zeros(n))

    def __len__(self) -> int:
        return len(self.uv)

    def height_at(self, t: Array) -> Array:
        """Height of each ray at its t."""
        return np.asarray(self.h + t * (self.dh + t * self.bend))

    def uv_at(self, t: Array) -> Array:
        """(N, 2) place of each ray at its t, tiles."""
        return np.asarray(self.uv + t[:, None] * self.duv)


@dataclass(frozen=True)
class HeightField:
    """Heights (H, W) in metres, bilinear between texel centres, row 0 at v = 1; repeated or clamped."""

    heights: Array
    tiling: bool = True

    def lattice(self, uv: Array) -> Array:
        """(N, 2) tiles to columns and rows counted in texel centres."""
        rows, columns = self.heights.shape
        return np.stack([uv[:, 0] * columns - 0.5, (1.0 - uv[:, 1]) * rows - 0.5], axis=1)

    def along(self, duv: Array) -> Array:
        """(N, 2) directions in tiles to directions in columns and rows."""
        rows, columns = self.heights.shape
        return duv * np.array([columns, -rows])

    def patch(self, cell: Array) -> tuple[Array, Array, Array, Array]:
        """Of cells (N, 2): A, B, C, D of the surface A + B x + C y + D x y, with x and y from 0 to 1 in the cell."""
        h00, h10, h01, h11 = (self._at(cell + corner) for corner in ((0, 0), (1, 0), (0, 1), (1, 1)))
        return h00, h10 - h00, h01 - h00, h00 - h10 - h01 + h11

    def _at(self, lattice: Array) -> Array:
        rows, columns = self.heights.shape
        size = np.array([columns, rows])
        i = lattice % size if self.tiling else np.clip(lattice, 0, size - 1)
        return np.asarray(self.heights[i[:, 1].astype(int), i[:, 0].astype(int)], dtype=np.float64)

    def height(self, uv: npt.ArrayLike) -> Array:
        """(N,) metres at places (N, 2) in tiles."""
        at = self.lattice(np.atleast_2d(np.asarray(uv, np.float64)))
        cell = np.floor(at)
        a, b, c, d = self.patch(cell)
        x, y = (at - cell).T
        return np.asarray(a + b * x + c * y + d * x * y)

    def slopes(self, uv: npt.ArrayLike, tile_m: tuple[float, float]) -> Array:
        """(N, 2) metres per metre along u and v: the derivatives of the patch itself."""
        at = self.lattice(np.atleast_2d(np.asarray(uv, np.float64)))
        cell = np.floor(at)
        _, b, c, d = self.patch(cell)
        x, y = (at - cell).T
        rows, columns = self.heights.shape
        return np.stack([(b + d * y) * columns / tile_m[0], -(c + d * x) * rows / tile_m[1]], axis=1)


def first_below(field: HeightField, rays: ReliefRays, reach: npt.ArrayLike) -> Array:
    """t where rays are first below a height field, within their reach; inf where they never are.

    Within a cell the height of the ray over the surface is a quadratic of t, since both coordinates are linear in t
    and the patch is bilinear: the first root of it, if it lies before the ray leaves the cell, is the meeting.
    """
    return _first(field, rays, reach, 1.0)


def first_above(field: HeightField, rays: ReliefRays, reach: npt.ArrayLike) -> Array:
    """t where rays are first above a height field, within their reach; inf where they never are."""
    return _first(field, rays, reach, -1.0)


def _first(field: HeightField, rays: ReliefRays, reach: npt.ArrayLike, side: float) -> Array:
    count = len(rays)
    limit = np.broadcast_to(np.asarray(reach, np.float64), (count,))
    found = np.full(count, np.inf)
    origin, step = field.lattice(rays.uv), field.along(rays.duv)
    cell, t = _first_cell(origin, step), np.zeros(count)
    walking = np.arange(count)
    while walking.size:
        o, d, c, start = origin[walking], step[walking], cell[walking], t[walking]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossings = np.where(d != 0.0, (c + (d > 0.0) - o) / d, np.inf)
        axis = np.argmin(crossings, axis=1)
        leaves = np.minimum(np.maximum(crossings.min(axis=1), start), limit[walking])
        meets = _root(field, _taken(rays, walking), c, start, leaves, side)
        found[walking] = meets
        goes_on = ~np.isfinite(meets) & (leaves < limit[walking])
        t[walking] = leaves
        cell[walking, axis] += np.sign(d[np.arange(len(d)), axis])
        walking = walking[goes_on]
    return found


def _first_cell(origin: Array, step: Array) -> Array:
    """The cell that a ray goes into: at a border between two, the one ahead."""
    cell = np.floor(origin)
    return np.asarray(np.where((cell == origin) & (step < 0.0), cell - 1.0, cell))


def _taken(rays: ReliefRays, which: Array) -> ReliefRays:
    return ReliefRays(rays.uv[which], rays.h[which], rays.duv[which], rays.dh[which], rays.bend[which])


def _root(field: HeightField, rays: ReliefRays, cell: Array, start: Array, end: Array, side: float) -> Array:
    """First t in [start, end] where `side` times the height over the patch of the cell is, or becomes, negative."""
    x0, y0 = (field.lattice(rays.uv_at(start)) - cell).T
    dx, dy = field.along(rays.duv).T
    a, b, c, d = field.patch(cell)
    slope = rays.dh + 2.0 * rays.bend * start
    q0 = side * (rays.height_at(start) - (a + b * x0 + c * y0 + d * x0 * y0))
    q1 = side * (slope - (b * dx + c * dy + d * (x0 * dy + y0 * dx)))
    q2 = side * (rays.bend - d * dx * dy)
    discriminant = q1 * q1 - 4.0 * q2 * q0
    with np.errstate(divide="ignore", invalid="ignore"):
        # Of both roots the first after the start, in the form that does not cancel where the ray falls.
        s = 2.0 * q0 / (-q1 + np.sqrt(discriminant))
    met = (discriminant >= 0.0) & (s >= 0.0) & (s <= end - start)
    return np.where(q0 < 0.0, start, np.where(met, start + s, np.inf))


def relief_first(
    solid: HeightField, translucent: HeightField | None, rays: ReliefRays, reach: npt.ArrayLike
) -> tuple[Array, Array]:
    """t and layer of the first matter of two layers from outside; the solid one wins ties [timonen2006, 3.2]."""
    t_solid = first_below(solid, rays, reach)
    t_upper = np.full(len(rays), np.inf) if translucent is None else first_below(translucent, rays, reach)
    layer = np.where(t_upper < t_solid, TRANSLUCENT, SOLID)
    t = np.minimum(t_solid, t_upper)
    return t, np.where(np.isfinite(t), layer, NONE)


def relief_leave(
    solid: HeightField, translucent: HeightField, rays: ReliefRays, reach: npt.ArrayLike
) -> tuple[Array, Array]:
    """t and layer where rays leave translucent matter: through its upper surface, or by meeting the solid one."""
    t_solid = first_below(solid, rays, reach)
    t_upper = first_above(translucent, rays, reach)
    layer = np.where(t_upper < t_solid, TRANSLUCENT, SOLID)
    t = np.minimum(t_solid, t_upper)
    return t, np.where(np.isfinite(t), layer, NONE)


@dataclass(frozen=True)
class ThroughLayer:
    """What a ray finds that enters a translucent layer over a solid one.

    t : (N,) metres to the layer, inf where there is none. reflectance : (N,) of its surface, 0..1. d_ts : (N, 3) the
    refracted directions. path : (N,) metres in the layer. transmittance : (N, C) of the path. uv : (N, 2) where the
    solid layer is met. layer : (N,) what ends the path.
    """

    t: Array
    reflectance: Array
    d_ts: Array
    path: Array
    transmittance: Array
    uv: Array
    layer: Array


def through_layer(
    solid: HeightField,
    translucent: HeightField,
    tile_m: tuple[float, float],
    rays: ReliefRays,
    indices: tuple[float, float],
    absorption_per_m: npt.ArrayLike,
    reach: float,
) -> ThroughLayer:
    """Follow rays over a plane into a layer, and through it to the solid one [timonen2006, 3.4].

    Refraction by Snell at the normal of the patch that is met, reflectance by Fresnel, transmittance
    exp(-sigma path). Where the translucent layer is not met first, path and reflectance are 0 and nothing bends.

    indices : outside and inside. absorption_per_m : (C,).
    """
    t, layer = relief_first(solid, translucent, rays, reach)
    enters = layer == TRANSLUCENT
    at = np.where(np.isfinite(t), t, 0.0)
    uv, h = rays.uv_at(at), rays.height_at(at)
    d = np.column_stack([rays.duv * np.asarray(tile_m), rays.dh])
    normal = np.column_stack([-translucent.slopes(uv, tile_m), np.ones(len(t))])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    bent = refract(d, normal, *indices).direction
    bent = np.where(enters[:, None], bent, d)
    cos_i = np.clip(-np.sum(d * normal, axis=1), 0.0, 1.0)
    inside = ReliefRays.of(uv, h, bent, tile_m)
    # Half a nanometre inward: the ray must not find the surface that it comes through.
    inside = replace(inside, h=inside.h - 5e-10)
    path, ends = relief_leave(solid, translucent, inside, np.where(enters, reach, 0.0))
    path = np.where(enters, path, 0.0)
    sigma = np.atleast_1d(np.asarray(absorption_per_m, np.float64))
    return ThroughLayer(
        t=t,
        reflectance=np.where(enters, fresnel_dielectric(cos_i, *indices), 0.0),
        d_ts=bent,
        path=path,
        transmittance=transmittance(sigma, path),
        uv=inside.uv_at(np.where(np.isfinite(path), path, 0.0)),
        layer=np.where(enters, ends, layer),
    )
