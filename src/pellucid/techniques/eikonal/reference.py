"""Slow float64 oracle of light in refractive volumes: photons, one by one, without voxels on their way.

It shares the laws (`optics`) with the shaders and nothing else. Surfaces are met by formula (`reference_bodies`), rays
in varying matter are leapfrog steps of [sharma1982] (`reference_rays`), and each track is laid into the voxels with the
exact length that it has in each: the track-length estimator of the fluence [spanier1969, 2.4].
Coordinates are those of the volume's box: metres, origin in the middle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pellucid.optics.phase import henyey_greenstein
from pellucid.scene.lights import DirectionalLight, PointLight
from pellucid.techniques.eikonal.reference_bodies import Array, Convex, Cylinder, Matter, Sphere
from pellucid.techniques.eikonal.reference_rays import Ledger, Limits, Photons, World, enter, follow, joined

__all__ = [
    "Convex", "Cylinder", "Fluence", "Limits", "Matter", "Photons", "Sphere", "TracedLight", "World",
    "scattered_radiance", "trace_light",
]  # fmt: skip

_CHUNK = 1 << 16


class Fluence:
    """Voxels that tracks are laid into: fluence (Z, Y, X, 3) and its sum of directions (Z, Y, X, 3).

    shape : (Z, Y, X). tent : spread each piece bilinearly over the four voxels around it in the plane across its
    dominant axis, as an estimator does that splats there.
    """

    def __init__(self, extent_m: tuple[float, float, float], shape: tuple[int, int, int], tent: bool = False) -> None:
        self.counts = np.array(shape[::-1])
        self.extent = np.asarray(extent_m, np.float64)
        self.voxel_m3 = float(np.prod(self.extent / self.counts))
        self.tent = tent
        self.flux_metres = np.zeros((3, int(np.prod(shape))))
        self.way_metres = np.zeros((3, int(np.prod(shape))))

    def add(self, rays: Photons, distance: Array, sigma: Array, index: Array, owner: int) -> None:
        """The straight pieces of `follow`."""
        a = (rays.x / self.extent + 0.5) * self.counts
        way = rays.d * distance[:, None] / self.extent * self.counts
        going = np.nonzero(distance > 0.0)[0]
        t = np.zeros(len(a))
        with np.errstate(divide="ignore", invalid="ignore"):
            per_cell = np.abs(1.0 / way)
            ahead = np.where(way > 0.0, np.floor(a) + 1.0 - a, a - np.ceil(a) + 1.0)
            crossing = np.where(way == 0.0, np.inf, ahead * per_cell)
        while len(going):
            begin = t[going]
            end = np.minimum(crossing[going].min(1), 1.0)
            middle = a[going] + (0.5 * (begin + end))[:, None] * way[going]
            depth = sigma[going] * distance[going, None]
            mean = _mean_over(depth, begin, end) * rays.flux[going] * ((end - begin) * distance[going])[:, None]
            self._lay(middle, way[going], mean, mean.mean(1)[:, None] * rays.d[going])
            crossing[going] += np.where(crossing[going] <= end[:, None], per_cell[going], 0.0)
            t[going] = end
            going = going[end < 1.0]

    def _lay(self, middle: Array, way: Array, flux_metres: Array, way_metres: Array) -> None:
        if not self.tent:
            self._put(np.floor(middle), 1.0, flux_metres, way_metres)
            return
        across = np.arange(3) != np.argmax(np.abs(way), axis=1)[:, None]
        corner = np.where(across, np.floor(middle - 0.5), np.floor(middle))
        part = np.where(across, middle - 0.5 - corner, 0.0)
        for offset in np.ndindex(2, 2, 2):
            weight = np.where(np.array(offset) == 1, part, 1.0 - part).prod(1)
            some = weight > 0.0
            self._put(corner[some] + offset, weight[some, None], flux_metres[some], way_metres[some])

    def _put(self, cell: Array, weight: Array | float, flux_metres: Array, way_metres: Array) -> None:
        x, y, z = np.clip(cell, 0, self.counts - 1).astype(np.int64).T
        flat = (z * self.counts[1] + y) * self.counts[0] + x
        for channel in range(3):
            np.add.at(self.flux_metres[channel], flat, (weight * flux_metres)[:, channel])
            np.add.at(self.way_metres[channel], flat, (weight * way_metres)[:, channel])

    def arrays(self) -> tuple[Array, Array]:
        """Fluence, W/m^2, and mean direction (length 0 to 1), (Z, Y, X, 3) each."""
        shape = (*self.counts[::-1], 3)
        total = self.flux_metres.mean(0)
        way = np.divide(self.way_metres, total, out=np.zeros_like(self.way_metres), where=total > 0.0)
        return (self.flux_metres / self.voxel_m3).T.reshape(shape), way.T.reshape(shape)


def _mean_over(depth: Array, begin: Array, end: Array) -> Array:
    """Mean of exp(-depth t) for t from `begin` to `end`; depth (P, 3)."""
    thick = depth * (end - begin)[:, None]
    small = np.abs(thick) < 1e-8
    mean = np.where(small, 1.0 - 0.5 * thick, -np.expm1(-thick) / np.where(small, 1.0, thick))
    return np.exp(-depth * begin[:, None]) * mean


@dataclass(frozen=True)
class TracedLight:
    """What `trace_light` found; names and units as in `pellucid.Irradiance`.

    `left` holds the rays that left the box: position and direction there, and flux.
    """

    fluence: Array
    direction: Array
    flux_in: Array
    flux_absorbed: Array
    flux_out: Array
    flux_ended: Array
    left: Photons


def trace_light(
    world: World,
    lights: Sequence[DirectionalLight | PointLight],
    shape: tuple[int, int, int],
    per_voxel: float = 4.0,
    *,
    tent: bool = False,
    limits: Limits | None = None,
    random: bool = False,
    seed: int = 1,
) -> TracedLight:
    """Fluence of lights in a box, by photons.

    Parameters
    ----------
    world : the box and what is in it.
    lights : in the coordinates of the box. A point light may stand in it.
    shape : (Z, Y, X) voxels.
    per_voxel : photons along the edge of a voxel on a lit face (their number is its square); a point light in the box
        sends as many as one on a face of its longest edge would, times six.
    tent : see `Fluence`.
    limits : when photons end.
    random : places jittered within their strata instead of in the middle.
    """
    rng, limits = np.random.default_rng(seed), limits or Limits()
    grid = Fluence(world.extent_m, shape, tent)
    total, flux_in = Ledger(), np.zeros(3)
    for light in lights:
        x, d, flux = emitted(world.extent_m, light, shape, per_voxel, rng if random else None)
        flux_in += flux.sum(0)
        for some in np.array_split(np.arange(len(x)), max(1, len(x) // _CHUNK)):
            photons, mirrored = Photons.begin(x[some], d[some], flux[some]), np.zeros(3)
            if not _within(world.extent_m, light):
                photons, mirrored = enter(world, photons, limits, rng)
            ledger = follow(world, photons, grid.add, limits, rng)
            total.absorbed += ledger.absorbed
            total.out += ledger.out + mirrored
            total.ended += ledger.ended
            total.left += ledger.left
    fluence, direction = grid.arrays()
    return TracedLight(fluence, direction, flux_in, total.absorbed, total.out, total.ended, joined(total.left))


def _within(extent_m: tuple[float, float, float], light: DirectionalLight | PointLight) -> bool:
    """Whether it is a point light that stands in the box."""
    return isinstance(light, PointLight) and bool((np.abs(light.position) < 0.5 * np.asarray(extent_m)).all())


def emitted(
    extent_m: tuple[float, float, float],
    light: DirectionalLight | PointLight,
    shape: tuple[int, int, int],
    per_voxel: float,
    rng: np.random.Generator | None,
) -> tuple[Array, Array, Array]:
    """Photons where they enter the box: positions, directions, fluxes, (P, 3) each."""
    extent, color = np.asarray(extent_m, np.float64), np.asarray(light.color)
    counts = np.maximum(np.ceil(np.array(shape[::-1]) * per_voxel).astype(int), 1)
    if isinstance(light, PointLight) and _within(extent_m, light):
        return _from_inside(light, 6 * int(counts.max()) ** 2)
    parts = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            x = _strata(counts, axis, rng) * extent - 0.5 * extent
            x[:, axis] = sign * 0.5 * extent[axis]
            area = np.prod(np.delete(extent / counts, axis))
            if isinstance(light, DirectionalLight):
                d = np.broadcast_to(np.asarray(light.direction) / np.linalg.norm(light.direction), x.shape)
                strength = np.full(len(x), light.irradiance)
            else:
                away = x - np.asarray(light.position)
                square = (away * away).sum(1)
                d, strength = away / np.sqrt(square)[:, None], light.intensity / square
            cosine = -sign * d[:, axis]
            lit = cosine > 0.0
            parts.append((x[lit], d[lit], (strength * cosine * area)[lit, None] * color))
    return tuple(np.concatenate(p) for p in zip(*parts, strict=True))  # type: ignore[return-value]


def _strata(counts: np.ndarray, axis: int, rng: np.random.Generator | None) -> Array:
    """One place in each cell of a face, (P, 3) in 0 to 1; 0 along `axis`."""
    flat = np.where(np.arange(3) == axis, 1, counts)
    cells = np.stack(np.meshgrid(*(np.arange(n) for n in flat), indexing="ij"), axis=-1).reshape(-1, 3)
    return (cells + (0.5 if rng is None else rng.random(cells.shape))) / flat


def _from_inside(light: PointLight, count: int) -> tuple[Array, Array, Array]:
    """Directions evenly over the sphere, on a Fibonacci lattice [swinbank2006]."""
    k = np.arange(count) + 0.5
    z, phi = 1.0 - 2.0 * k / count, k * np.pi * (3.0 - np.sqrt(5.0))
    r = np.sqrt(1.0 - z * z)
    d = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    flux = np.full((count, 1), 4.0 * np.pi * light.intensity / count) * np.asarray(light.color)
    return np.broadcast_to(np.asarray(light.position, np.float64), d.shape).copy(), d, flux


def scattered_radiance(
    world: World,
    origins: Array,
    directions: Array,
    fluence: Callable[[Array], tuple[Array, Array]],
    pieces: int = 64,
    limits: Limits | None = None,
) -> Array:
    """Radiance (P, 3) that view rays gather from light scattered once.

    Each straight piece of a ray's tree is cut into `pieces`; a source inside index n arrives with (ambient_n / n)^2,
    as L/n^2 is what a ray keeps [born1999, 4.8.3].

    Parameters
    ----------
    origins, directions : (P, 3), rays from the viewer; the origins lie in the box or on its faces.
    fluence : positions (Q, 3) to fluence (Q, 3) and mean direction of light (Q, 3), in the matter.
    """
    radiance = np.zeros((len(origins), 3))

    def gather(rays: Photons, distance: Array, sigma: Array, index: Array, owner: int) -> None:
        matter = world.matters[owner]
        if not any(matter.scattering):
            return
        for part in range(pieces):
            t = (part + 0.5) / pieces * distance
            light, way = fluence(rays.x + t[:, None] * rays.d)
            parallel = np.linalg.norm(way, axis=1)
            cosine = -(way * rays.d).sum(1) / np.maximum(parallel, 1e-300)
            share = henyey_greenstein(cosine, matter.anisotropy * parallel)
            source = np.asarray(matter.scattering) * light * share[:, None] * (world.ambient_n / index[:, None]) ** 2
            begin, end = np.full((2, len(t)), [[part / pieces], [(part + 1) / pieces]])
            mean = _mean_over(sigma * distance[:, None], begin, end)
            np.add.at(radiance, rays.name, source * rays.flux * mean * (distance / pieces)[:, None])

    start = Photons.begin(np.asarray(origins, float), np.asarray(directions, float), np.ones((len(origins), 3)))
    follow(world, start, gather, limits or Limits(), np.random.default_rng(1))
    return radiance
