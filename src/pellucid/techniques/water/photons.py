"""Photons through waves on the CPU [mihalik2008, 8.1]: the same as the shaders caustic_*.wgsl, in NumPy.

What meshes the light meets first comes as pictures of depth from the device, as in [mihalik2008]; all else is done
here: refraction, the way to the mesh, and the sums.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pellucid.optics import fresnel_dielectric, refract
from pellucid.techniques.water.prepare import WaveMaps

STEP_TEXELS = 2.0  # of caustic_march.wgsl, and the next two
MOST_STEPS = 24
REFINEMENTS = 6
WIDEST, LAMP, SHARPEST, TORN = 6.0, 4.0, 0.004, 12.0  # texels, of caustic_spread.wgsl and caustic_splat.wgsl


@dataclass(frozen=True)
class Photons:
    """One photon of one colour for each cell of a surface.

    Attributes
    ----------
    landed : (N, N, 2) where, in texels of the map, rows along z.
    flux : (N, N) over that which falls on a cell of a level surface.
    depth_m : (N, N) of the landing below the surface.
    """

    landed: np.ndarray
    flux: np.ndarray
    depth_m: np.ndarray


def wave_at(waves: WaveMaps, center: np.ndarray, xz: np.ndarray) -> np.ndarray:
    """(..., 3) height over the level and slopes at (..., 2) places: bilinear, as the device reads them."""
    rows, columns = waves.texels.shape[1:3]
    total = np.zeros((*xz.shape[:-1], 3))
    for texels, (width, depth, repeats, _) in zip(waves.texels, waves.tiles, strict=True):
        uv = (xz - center) / (width, depth) + 0.5
        half = 0.5 / np.array([columns, rows])
        uv = uv - np.floor(uv) if repeats > 0.5 else np.clip(uv, half, 1.0 - half)
        at = np.clip(uv, half, 1.0 - half) * (columns, rows) - 0.5
        first = np.minimum(np.floor(at).astype(int), np.maximum(np.array([columns, rows]) - 2, 0))
        share = (at - first)[..., None]
        i, j = first[..., 0], first[..., 1]
        ii, jj = np.minimum(i + 1, columns - 1), np.minimum(j + 1, rows - 1)
        upper = texels[j, i, :3] * (1.0 - share[..., 0, :]) + texels[j, ii, :3] * share[..., 0, :]
        lower = texels[jj, i, :3] * (1.0 - share[..., 0, :]) + texels[jj, ii, :3] * share[..., 0, :]
        total += upper * (1.0 - share[..., 1, :]) + lower * share[..., 1, :]
    return total


class Tracer:
    """Follows photons of one lamp through one surface.

    Parameters
    ----------
    parts : () records of `layouts.CausticParams`, one for each part of the lamp. water : one of `layouts.WaterParams`.
    waves : the surface. below, above : (D, D) depths that the camera along the light sees, 0 to 1, rows along z.
    side : cells and texels along a side. iteration : whether meshes are found by [mihalik2008, 7.1].
    """

    def __init__(
        self,
        parts: Sequence[np.ndarray],
        water: np.ndarray,
        waves: WaveMaps,
        below: np.ndarray,
        above: np.ndarray,
        side: int,
        iteration: bool = False,
    ) -> None:
        self.waves, self.below, self.above, self.side, self.iteration = waves, below, above, side, iteration
        self.parts = parts
        self.p = {name: parts[0][name].astype(np.float64) for name in parts[0].dtype.names or ()}
        self.low, self.high = water["low"].astype(np.float64), water["high"].astype(np.float64)
        self.center, self.level = water["center"].astype(np.float64), float(water["level"])
        self.top, self.trough = self.level + float(water["wave_high"]), self.level + float(water["wave_low"])
        self.texel_m = float((self.high - self.low)[0]) / side

    def photons(self, channel: int = 0, part: int = 0) -> Photons:
        """Those of one colour, from one part of the lamp."""
        cells = (np.stack(np.meshgrid(*(np.arange(self.side),) * 2), axis=-1) + 0.5) / self.side
        xz = self.low + cells * (self.high - self.low)
        wave = float(self.p["focus"]) * wave_at(self.waves, self.center, xz)
        n = np.stack([-wave[..., 1], np.ones_like(wave[..., 0]), -wave[..., 2]], axis=-1)
        n /= np.linalg.norm(n, axis=-1, keepdims=True)
        origin = np.stack([xz[..., 0], self.level + wave[..., 0], xz[..., 1]], axis=-1)
        light, index = self.parts[part]["to_light"].astype(np.float64), float(self.p["index"][channel])
        facing = n @ light
        lost = float(self.p["loss"]) * fresnel_dielectric(np.maximum(facing, 0.0), 1.0, index)
        density = float(self.parts[part]["share"]) * np.maximum(facing, 0.0) / (n[..., 1] * light[1])
        flux = density * (1.0 - lost) * self._lit(origin)
        way = np.broadcast_to(-light, n.shape)
        inside = refract(np.where((facing > 0.0)[..., None], way, -n), n, 1.0, index).direction
        depth = self._iterate(origin, inside) if self.iteration else self._march(origin, inside)
        begun = self.top - origin[..., 1]
        seen = self._seen(origin, inside, depth)
        return Photons((seen - self.low) / (self.high - self.low) * self.side, flux, depth - begun)

    def height_map(self) -> np.ndarray:
        """(N, N) heights of the surface at the texels, metres over the level."""
        cells = (np.stack(np.meshgrid(*(np.arange(self.side),) * 2), axis=-1) + 0.5) / self.side
        return np.asarray(wave_at(self.waves, self.center, self.low + cells * (self.high - self.low))[..., 0])

    def light_map(self) -> np.ndarray:
        """(N, N, 4) float32: what comes to each texel, by channel, and the height of the surface."""
        channels = int(self.p["channels"])
        sums = [
            sum(splat(self.photons(c, k), part["lamp_side"], self._texel_sides()) for k, part in enumerate(self.parts))
            for c in range(channels)
        ]
        colours = sums if channels == 3 else sums[:1] * 3
        return np.stack([*colours, self.height_map()], axis=-1).astype(np.float32)

    def _texel_sides(self) -> np.ndarray:
        return np.asarray((self.high - self.low) / self.side)

    def _seen(self, origin: np.ndarray, way: np.ndarray, depth: np.ndarray) -> np.ndarray:
        slope = self.p["slope"]
        drift = way[..., [0, 2]] / np.maximum(-way[..., 1:2], 1e-4) + slope
        start = origin[..., [0, 2]] + slope * (self.level - origin[..., 1:2])
        return np.asarray(start + drift * (depth - (self.top - origin[..., 1]))[..., None])

    def _floor(self, seen: np.ndarray) -> np.ndarray:
        size = self.below.shape[0]
        at = np.clip((seen - self.low) / (self.high - self.low) * size, 0.0, size - 1.0).astype(int)
        return np.asarray(float(self.p["reach_m"]) * self.below[at[..., 1], at[..., 0]])

    def _lit(self, origin: np.ndarray) -> np.ndarray:
        """Comparison of the four nearest texels, weighted as a linear sampler does."""
        size = self.above.shape[0]
        seen = origin[..., [0, 2]] + self.p["slope_above"] * (self.level - origin[..., 1:2])
        at = (seen - self.low) / (self.high - self.low) * size - 0.5
        depth = 1.0 - (origin[..., 1] - self.trough) / float(self.p["reach_above_m"])
        first = np.floor(at)
        share = at - first
        free = np.zeros(depth.shape)
        for j, i in ((0, 0), (0, 1), (1, 0), (1, 1)):
            texel = np.clip(first + np.array([i, j]), 0, size - 1).astype(int)
            weight = np.where((i, j), share, 1.0 - share).prod(axis=-1)
            free += weight * (depth <= self.above[texel[..., 1], texel[..., 0]])
        return np.asarray(1.0 + float(self.p["shadows"]) * (free - 1.0))

    def _march(self, origin: np.ndarray, way: np.ndarray) -> np.ndarray:
        begun, reach = self.top - origin[..., 1], float(self.p["reach_m"])
        way_m = reach - begun
        drift = way[..., [0, 2]] / np.maximum(-way[..., 1:2], 1e-4) + self.p["slope"]
        wanted = np.ceil(np.linalg.norm(drift, axis=-1) * way_m / (STEP_TEXELS * self.texel_m))
        steps = np.clip(wanted, 1.0, MOST_STEPS)
        low, high, going = begun.copy(), begun.copy(), np.ones(begun.shape, bool)
        for k in range(1, MOST_STEPS + 1):
            going &= k <= steps
            low, high = np.where(going, high, low), np.where(going, begun + way_m * k / steps, high)
            going &= self._floor(self._seen(origin, way, high)) > high
        depth, going = high.copy(), np.ones(begun.shape, bool)
        for _ in range(REFINEMENTS):
            below = self._floor(self._seen(origin, way, depth))
            going &= np.abs(below - depth) >= 0.02 * self.texel_m
            low = np.where(going & (below > depth), depth, low)
            high = np.where(going & (below <= depth), depth, high)
            within = (below > low) & (below < high)
            depth = np.where(going, np.where(within, below, 0.5 * (low + high)), depth)
        return depth

    def _iterate(self, origin: np.ndarray, way: np.ndarray) -> np.ndarray:
        a = self._point_of(origin)
        w = origin + np.linalg.norm(a - origin, axis=-1, keepdims=True) * way
        best, nearest = origin, np.linalg.norm(a - origin, axis=-1)
        for _ in range(int(self.p["steps"])):
            following = self._point_of(w)
            error = np.linalg.norm(following - w, axis=-1)
            best = np.where((error < nearest)[..., None], w, best)
            nearest = np.minimum(nearest, error)
            q = following - a
            across = np.cross(way, q)
            scale = (np.cross(a - origin, q) * across).sum(-1) / np.maximum((across**2).sum(-1), 1e-12)
            crossing = origin + scale[..., None] * way
            both = np.linalg.norm(crossing - a, axis=-1) + np.linalg.norm(following - crossing, axis=-1)
            between = both <= 1.001 * np.linalg.norm(q, axis=-1)
            moved = w + np.where(w[..., 1] < following[..., 1], -error, error)[..., None] * way
            w, a = np.where(between[..., None], crossing, moved), following
        return np.asarray(self.top - best[..., 1])

    def _point_of(self, p: np.ndarray) -> np.ndarray:
        """What the camera sees where it sees a point."""
        slope = self.p["slope"]
        seen = p[..., [0, 2]] + slope * (self.level - p[..., 1:2])
        y = self.top - self._floor(seen)
        xz = seen - slope * (self.level - y)[..., None]
        return np.stack([xz[..., 0], y, xz[..., 1]], axis=-1)


def splat(photons: Photons, lamp_side: np.ndarray, texel_m: np.ndarray) -> np.ndarray:
    """(N, N) sums of flux, each photon spread between its neighbours' landings; see caustic_spread.wgsl."""
    landed, side = photons.landed, len(photons.landed)
    along, across = _beside(landed, 1), _beside(landed, 0)
    lamp = lamp_side * photons.depth_m[..., None] / texel_m
    over = [
        _spread(along[0][..., 0], along[1][..., 0], across[1][..., 0], lamp[..., 0]),
        _spread(across[0][..., 1], across[1][..., 1], along[1][..., 1], lamp[..., 1]),
    ]
    total = np.zeros(side * side)
    lit = photons.flux > 0.0
    reach = [int(np.ceil((last - first)[lit].max(initial=0.0))) + 1 for _, _, _, first, last in over]
    for j in range(reach[1]):
        rows, share_y = _texel(over[1], j)
        for i in range(reach[0]):
            columns, share_x = _texel(over[0], i)
            value = photons.flux * share_x * share_y
            kept = lit & (value > 0.0) & (rows >= 0) & (rows < side) & (columns >= 0) & (columns < side)
            place = (rows[kept] * side + columns[kept]).astype(int)
            total += np.bincount(place, weights=value[kept], minlength=side * side)
    return total.reshape(side, side)


Trapezoid = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def _texel(over: Trapezoid, k: int) -> tuple[np.ndarray, np.ndarray]:
    """The k-th texel under each trapezoid, and its share."""
    x = over[3] + k
    return x, np.where(x <= over[4], _below(over, x + 1.0) - np.where(k == 0, 0.0, _below(over, x)), 0.0)


def _beside(landed: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Middle and extent of the place between the neighbours of each cell."""
    unit = np.array([1.0, 0.0]) if axis == 1 else np.array([0.0, 1.0])
    way = np.diff(landed, axis=axis)
    way = np.where((np.abs(way) > TORN).any(axis=-1, keepdims=True), unit, way)
    ends = [np.take(way, [0], axis=axis), np.take(way, [-1], axis=axis)]
    before = np.concatenate([ends[0], way], axis=axis)
    after = np.concatenate([way, ends[1]], axis=axis)
    return landed + 0.25 * (after - before), 0.5 * (after + before)


def _spread(middle: np.ndarray, one: np.ndarray, other: np.ndarray, lamp: np.ndarray) -> Trapezoid:
    a, b = np.minimum(np.abs(one), WIDEST), np.minimum(np.abs(other), WIDEST)
    smaller = np.minimum(np.minimum(a, b) + np.minimum(lamp, WIDEST), LAMP)
    larger = np.maximum(a, b)
    wide = np.maximum(np.maximum(larger, smaller), SHARPEST)
    narrow = np.maximum(np.minimum(larger, smaller), SHARPEST)
    reach = 0.5 * (wide + narrow)
    return middle, wide, narrow, np.floor(middle - reach), np.ceil(middle + reach) - 1.0


def _below(over: Trapezoid, x: np.ndarray) -> np.ndarray:
    """Share of each trapezoid that lies below x."""
    middle, wide, narrow = over[:3]
    away = np.abs(x - middle)
    edge = np.clip(0.5 * (wide + narrow) - away, 0.0, narrow)
    half = np.where(away <= 0.5 * (wide - narrow), away / wide, 0.5 - 0.5 * edge**2 / (wide * narrow))
    return np.asarray(0.5 + np.where(x < middle, -half, half))
