"""Placed volumes, what of them is matter, and whether that of one reaches into another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .volume import Volume

# Weaker than this share of the strongest, an index that differs from the ambient one counts as nothing.
NOTHING = 1e-7
# Of one volume, tested for lying in the box of another; they are spread evenly.
MOST_TESTED_VOXELS = 100_000

Array = npt.NDArray[np.float64]
FIELDS = ("absorption", "scattering", "emission")


@dataclass(frozen=True, eq=False)
class Part:
    """A volume, how it is drawn, and where it stands.

    boundary : "sharp" or "smooth". world : (4, 4), object to world, with a uniform scale.
    dispersion : the index of its media depends on the wavelength; else it is that at 587.56 nm.
    """

    volume: Volume
    boundary: str
    world: Array
    dispersion: bool = True

    @property
    def scale(self) -> float:
        return float(np.cbrt(np.linalg.det(self.world[:3, :3])))

    @property
    def voxel_ws_m(self) -> float:
        return self.scale * min(self.volume.voxel_m)

    @property
    def has_surface(self) -> bool:
        return self.boundary == "sharp" and bool(self.volume.regions)

    @property
    def bends(self) -> bool:
        """Whether its index differs from the ambient one anywhere."""
        return bool(self.volume.regions) or bool(self.volume.delta_n is not None and self.volume.delta_n.any())


@dataclass(frozen=True, eq=False)
class Matter:
    """What of a volume is not ambient.

    low, high : (3,) corners of the box around it, object metres. points : (P, 3), centres of some of its voxels.
    """

    low: Array
    high: Array
    points: Array

    @property
    def size(self) -> float:
        """Volume of the box, m^3."""
        return float(np.prod(self.high - self.low))


def matter_of(volume: Volume, boundary: str) -> Matter:
    """Find the voxels that hold anything. Where the box is the surface, all do."""
    held = np.ones(volume.shape, bool) if boundary == "sharp" and not volume.regions else _held(volume)
    if not held.any():
        return Matter(np.zeros(3), np.zeros(3), np.zeros((0, 3)))
    edge, half = np.array(volume.voxel_m), 0.5 * np.array(volume.extent_m)
    low, high = np.zeros(3), np.zeros(3)
    for axis in range(3):
        along = np.flatnonzero(held.any(axis=tuple(a for a in range(3) if a != 2 - axis)))
        low[axis], high[axis] = along[0] * edge[axis] - half[axis], (along[-1] + 1) * edge[axis] - half[axis]
    inside = np.flatnonzero(held)
    some = inside[:: max(1, len(inside) // MOST_TESTED_VOXELS)]
    points = (np.stack(np.unravel_index(some, volume.shape)[::-1], axis=-1) + 0.5) * edge - half
    return Matter(low, high, points)


def _held(volume: Volume) -> npt.NDArray[np.bool_]:
    held = np.zeros(volume.shape, bool)
    for region in volume.regions:
        held |= region.sdf < 0.0
    if volume.delta_n is not None and not volume.regions:
        deviation = np.abs(volume.delta_n.reshape(*volume.shape, -1)).max(axis=-1)
        held |= deviation > NOTHING * deviation.max()
    for name in FIELDS:
        if getattr(volume, name) is not None:
            held |= getattr(volume, name).any(axis=-1)
    if volume.opaque is not None:
        held |= volume.opaque[..., 3] > 0.0
    return held


def interfere(a: Matter, a_world: Array, b: Matter, b_world: Array) -> bool:
    """Whether matter of one lies in the box around the matter of the other: then rays cannot take one after another."""
    return _reaches_into(a, a_world, b, b_world) or _reaches_into(b, b_world, a, a_world)


def _reaches_into(a: Matter, a_world: Array, b: Matter, b_world: Array) -> bool:
    if not len(a.points) or not len(b.points):
        return False
    between = np.linalg.inv(b_world) @ a_world
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (a.high - a.low) + a.low
    around = corners @ between[:3, :3].T + between[:3, 3]
    if (around.max(axis=0) <= b.low).any() or (around.min(axis=0) >= b.high).any():
        return False
    there = a.points @ between[:3, :3].T + between[:3, 3]
    return bool(((there > b.low) & (there < b.high)).all(axis=1).any())
