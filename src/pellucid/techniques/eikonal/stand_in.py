"""What rays of other things see of a body of glass: its surfaces as triangles, with an index on either side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.surface_nets import nets_in_voxels
from pellucid.surroundings.interfaces import Interface
from pellucid.techniques.eikonal.proxies import corners

if TYPE_CHECKING:
    from pellucid.fields.volume import Region, Volume
    from pellucid.scene import RefractiveVolume, Water

# Cells along the longest edge of a grid from which triangles are made, as long as it holds the bodies.
CELLS = 64
# A coarser grid may change what a body fills by this share.
KEPT = 0.02

NOTHING = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Surface:
    """A surface of a region where no earlier one owns the place, in the volume's own coordinates.

    inner, outer : numbers of the regions behind the faces and before them; -1 for what is around.
    """

    points: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    inner: int
    outer: int


class StandIns:
    """Makes them, and keeps those of objects and volumes that stay."""

    def __init__(self) -> None:
        self._surfaces: dict[int, tuple[Volume, list[Surface]]] = {}
        self._placed: dict[int, tuple[RefractiveVolume, float, list[Interface]]] = {}

    def of(self, items: Sequence[RefractiveVolume], waters: Sequence[Water]) -> list[Interface]:
        """Interfaces of all volumes with regions; nothing stands for others."""
        volumes = {id(item.volume): item.volume for item in items}
        self._surfaces = {
            key: self._surfaces[key] if key in self._surfaces else (volume, surfaces_of(volume))
            for key, volume in volumes.items()
        }
        before, self._placed = self._placed, {}
        for item in items:
            around, kept = around_n(item, waters), before.get(id(item))
            if kept is None or kept[1] != around:
                kept = item, around, place(item, self._surfaces[id(item.volume)][1], around)
            self._placed[id(item)] = kept
        return [interface for item in items for interface in self._placed[id(item)][2]]


def around_n(item: RefractiveVolume, waters: Sequence[Water]) -> float:
    """Index of what counts as air about a volume: that above a water that it reaches into, or its own ambient one."""
    water = water_about(item, waters)
    return item.volume.ambient_n if water is None else water.ambient_n


def water_about(item: RefractiveVolume, waters: Sequence[Water]) -> Water | None:
    """The first water that the box of a volume reaches into."""
    world = item.object_to_world()
    around = corners((np.zeros(3), 0.5 * np.array(item.volume.extent_m))) @ world[:3, :3].T + world[:3, 3]
    low, high = around.min(axis=0), around.max(axis=0)
    for water in waters:
        (x_low, z_low), (x_high, z_high) = water.bounds_m
        beside = high[0] < x_low or low[0] > x_high or high[2] < z_low or low[2] > z_high
        if not beside and low[1] < water.level:
            return water
    return None


def place(item: RefractiveVolume, surfaces: Sequence[Surface], around: float) -> list[Interface]:
    """Surfaces of a volume in world space, with what is on either side of them."""
    world = item.object_to_world()
    out = []
    for surface in surfaces:
        points = surface.points @ world[:3, :3].T + world[:3, 3]
        normals = surface.normals @ world[:3, :3].T / item.scale
        inner, outer = (_matter(item, number, around) for number in (surface.inner, surface.outer))
        out.append(Interface(points, surface.faces, normals, *inner, *outer))
    return out


def _matter(item: RefractiveVolume, number: int, around: float) -> tuple[float, Any]:
    """Index over that around, and absorption, 1/m, where fields of the volume count as even."""
    if number < 0:
        return 0.0, NOTHING
    volume, region = item.volume, item.volume.regions[number]
    absorption = np.asarray(region.medium.absorption_rgb_per_m, np.float64)
    if volume.absorption is not None:
        absorption = absorption + volume.absorption[region.sdf < 0.0].mean(axis=0)
    r, g, b = (float(a) for a in absorption)
    return region.medium.n_d / around, (r, g, b)


def surfaces_of(volume: Volume) -> list[Surface]:
    """The surfaces of all regions of a volume."""
    step = coarsest(volume)
    return [surface for number in range(len(volume.regions)) for surface in _surfaces(volume, number, step)]


def coarsest(volume: Volume) -> int:
    """Voxels between samples that still hold every region: 1 where one is thin."""
    most = -(-max(volume.shape) // CELLS)
    return next((step for step in range(most, 1, -1) if all(_holds(r, step) for r in volume.regions)), 1)


def _holds(region: Region, step: int) -> bool:
    whole, part = (np.count_nonzero(sdf < 0.0) for sdf in (region.sdf, region.sdf[::step, ::step, ::step]))
    return bool(abs(part * step**3 - whole) <= KEPT * whole)


def _surfaces(volume: Volume, number: int, step: int) -> list[Surface]:
    """The triangles of one region, apart by what is before them."""
    sdf, voxel = volume.regions[number].sdf, np.array(volume.voxel_m)
    outside = step * float(voxel.max())
    points, faces = nets_in_voxels(np.pad(sdf[::step, ::step, ::step].astype(np.float64), 1, constant_values=outside))
    if not len(faces):
        return []
    at = np.clip((points - 1.0) * step, 0.0, np.array(volume.shape[::-1]) - 1.0)
    normals = _gradient(sdf, at) / voxel
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    taken, before = _neighbours(volume, number, at[faces].mean(axis=1))
    metres = (at + 0.5) * voxel - 0.5 * np.array(volume.extent_m)
    return [
        Surface(metres, faces[~taken & (before == outer)], normals, number, int(outer))
        for outer in np.unique(before[~taken])
    ]


def _neighbours(volume: Volume, number: int, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether an earlier region owns a place on the surface of one, and which later region is before it."""
    taken, before = np.zeros(len(places), bool), np.full(len(places), -1)
    for earlier in volume.regions[:number]:
        taken |= _sampled(earlier.sdf, places) < 0.0
    for later in range(len(volume.regions) - 1, number, -1):
        before[_sampled(volume.regions[later].sdf, places) < 0.0] = later
    return taken, before


def _sampled(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(Z, Y, X) at (N, 3) places x, y, z in voxels, linear between their centres."""
    last = np.array(values.shape[::-1]) - 1
    low = np.clip(np.floor(places).astype(int), 0, np.maximum(last - 1, 0))
    share, total = places - low, np.zeros(len(places))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, share, 1.0 - share), axis=1)
        x, y, z = np.minimum(low + np.array(corner), last).T
        total += weight * values[z, y, x]
    return total


def _gradient(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(N, 3) differences over two voxels, per voxel but for a factor."""
    last = np.array(values.shape[::-1]) - 1.0
    sides = [[np.clip(places + sign * np.eye(3)[axis], 0.0, last) for sign in (1, -1)] for axis in range(3)]
    return np.stack([_sampled(values, up) - _sampled(values, down) for up, down in sides], axis=1)
