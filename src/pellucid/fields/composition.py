"""Several placed volumes that reach into one another, resampled into one.

Where they overlap, the part that comes first owns the place: its surfaces and its index count there, and fields of
absorption, scattering and emission of later parts stop at its bodies. Elsewhere such fields add up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from pellucid import media

from .reaching import FIELDS, NOTHING, Array, Matter, Part
from .volume import Region, Volume
from .volume_checks import MOST_REGIONS

MOST_COMPOSED_VOXELS = 224**3
# Voxels of the result around all matter.
MARGIN_VOXELS = 3


def can_compose(parts: Sequence[Part]) -> bool:
    """Whether one volume can hold them all: sharp surfaces or an index on voxels, not both, and few enough regions.

    An index that varies within a sharp body is possible in the first part only, an optic axis that varies nowhere.
    """
    sharp = [part for part in parts if part.has_surface]
    if any(part.bends and not part.has_surface for part in parts) and sharp:
        return False
    if any(part.boundary == "sharp" and not part.volume.regions and part.bends for part in parts):
        return False
    if any(part.volume.delta_n is not None for part in sharp[1:]):
        return False
    if any(part.volume.optic_axis is not None or part.volume.delta_n_e is not None for part in sharp):
        return False
    regions = [_turned(region, part.world) for part in sharp for region in part.volume.regions]
    joined = sum(_alike(a, b) for a, b in pairwise(regions))
    return len(regions) - joined <= MOST_REGIONS


def compose(parts: Sequence[Part], matters: Sequence[Matter]) -> tuple[Volume, Array]:
    """One volume of several, and where it stands: (4, 4), object to world, without a scale.

    Parameters
    ----------
    parts : in the order of priority. The last one's ambient medium is that of the result. `can_compose` must hold.
    matters : of each part.

    Distances are resampled by cubic splines, fields trilinearly. The voxels are those of the finest part, and lie on
    them, unless that makes more than 224^3.
    """
    parts = [part if part.dispersion else replace(part, volume=_of_one_index(part.volume)) for part in parts]
    grid = _Grid.around(parts, matters)
    fill = _sharp if any(part.has_surface for part in parts) else _smooth
    return fill(parts, grid), grid.world


@dataclass(frozen=True, eq=False)
class _Grid:
    """Voxels that are to be filled. frame : (4, 4) to the world; low : (3,) corner in it; shape : (Z, Y, X)."""

    frame: Array
    low: Array
    voxel: float
    shape: tuple[int, int, int]
    outside: dict[Any, np.ndarray] = field(default_factory=dict)  # distances to boxes, as they are found

    @classmethod
    def around(cls, parts: Sequence[Part], matters: Sequence[Matter]) -> _Grid:
        limit = 1.05 * min(part.voxel_ws_m for part in parts)
        finest = [part for part in parts if part.voxel_ws_m <= limit][-1]  # of equal ones the largest
        frame = finest.world.copy()
        frame[:3, :3] /= finest.scale
        corners = []
        for part, matter in zip(parts, matters, strict=True):
            to_frame = np.linalg.inv(frame) @ part.world
            unit = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
            corners.append((unit * (matter.high - matter.low) + matter.low) @ to_frame[:3, :3].T + to_frame[:3, 3])
        low, high = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)
        voxel = max(finest.voxel_ws_m, float(np.cbrt(np.prod(high - low) / MOST_COMPOSED_VOXELS)))
        # On the voxels of the finest part, whose distances are then taken over as they are.
        origin = -0.5 * finest.scale * np.array(finest.volume.extent_m)
        first = np.floor((low - origin) / voxel) - MARGIN_VOXELS
        last = np.ceil((high - origin) / voxel) + MARGIN_VOXELS
        x, y, z = (last - first).astype(int)
        return cls(frame, origin + first * voxel, voxel, (int(z), int(y), int(x)))

    @property
    def extent(self) -> tuple[float, float, float]:
        z, y, x = self.shape
        return x * self.voxel, y * self.voxel, z * self.voxel

    @property
    def world(self) -> Array:
        out = self.frame.copy()
        middle = self.low + 0.5 * np.array(self.extent)
        out[:3, 3] += self.frame[:3, :3] @ middle
        return out

    def to_object(self, part: Part) -> Array:
        """(3, 4), from indices (x, y, z) of voxels to object metres of a part."""
        turn = np.linalg.inv(part.world) @ self.frame
        out = np.zeros((3, 4))
        out[:, :3] = turn[:3, :3] * self.voxel
        out[:, 3] = turn[:3, :3] @ (self.low + 0.5 * self.voxel) + turn[:3, 3]
        return out

    def resampled(self, part: Part, values: np.ndarray, order: int, outside: float = 0.0) -> np.ndarray:
        """A scalar field (Z, Y, X) of a part on these voxels; `outside` where its box ends."""
        from scipy.ndimage import affine_transform

        rows = self.to_object(part)
        edge, half = np.array(part.volume.voxel_m), 0.5 * np.array(part.volume.extent_m)
        matrix = (rows[:, :3] / edge[:, None])[::-1, ::-1]
        offset = ((rows[:, 3] + half) / edge - 0.5)[::-1]
        block = self._block(part)
        begin = np.array([s.start for s in block])
        out = np.full(self.shape, outside, np.float32)
        out[block] = (
            values.flat[0]
            if values.min() == values.max()
            else affine_transform(
                np.asarray(values, np.float32),
                matrix,
                offset + matrix @ begin,
                output_shape=tuple(s.stop - s.start for s in block),
                output=np.float32,
                order=order,
                mode="nearest",
            )
        )
        if order == 1:  # the fields end with the box
            out[block][self._outside_box(part)[block] > 0.0] = outside
        return out

    def _block(self, part: Part) -> tuple[slice, slice, slice]:
        """The voxels around the box of a part."""
        rows = self.to_object(part)
        unit = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners = unit * (0.5 * np.array(part.volume.extent_m))
        at = (corners - rows[:, 3]) @ np.linalg.inv(rows[:, :3]).T
        low = np.clip(np.floor(at.min(axis=0)), 0, np.array(self.shape[::-1]) - 1).astype(int)
        high = np.clip(np.ceil(at.max(axis=0)) + 1, low + 1, self.shape[::-1]).astype(int)
        x, y, z = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
        return z, y, x

    def _outside_box(self, part: Part) -> np.ndarray:
        """Distance to the box of a part, metres of the result; 0 within."""
        key = part.volume.extent_m, part.world.tobytes()
        if key in self.outside:
            return self.outside[key]
        rows, half = self.to_object(part), 0.5 * np.array(part.volume.extent_m)
        z, y, x = (np.arange(n, dtype=np.float32) for n in self.shape)
        square = np.zeros(self.shape, np.float32)
        for row, limit in zip(rows.astype(np.float32), half, strict=True):
            at = (row[2] * z + row[3])[:, None, None] + (row[1] * y)[:, None] + row[0] * x
            square += np.maximum(np.abs(at, out=at) - np.float32(limit * (1.0 + 1e-6)), 0.0) ** 2
        self.outside[key] = np.sqrt(square) * np.float32(part.scale)
        return self.outside[key]

    def distance(self, part: Part, sdf: np.ndarray) -> np.ndarray:
        """Signed distance to a body of a part, metres of the result.

        Outside of the part's box there is a lower bound: the way to the box, and what is left at its border at least.
        A body that its box cuts off ends there.
        """
        border = min(float(np.take(sdf, (0, -1), axis=a).min()) for a in range(3))
        beyond = self._outside_box(part)
        out = self.resampled(part, sdf * np.float32(part.scale), order=3)
        if border < 0.0:
            out = np.maximum(out, self._box_distance(part))
        return np.where(beyond > 0.0, beyond + np.float32(max(border, 0.0) * part.scale), out)

    def _box_distance(self, part: Part) -> np.ndarray:
        """The largest of the distances to the six faces of a part's box, negative inside."""
        rows, half = self.to_object(part), 0.5 * np.array(part.volume.extent_m)
        z, y, x = (np.arange(n, dtype=np.float32) for n in self.shape)
        out = np.full(self.shape, -np.inf, np.float32)
        for row, limit in zip(rows.astype(np.float32), half, strict=True):
            at = (row[2] * z + row[3])[:, None, None] + (row[1] * y)[:, None] + row[0] * x
            np.maximum(out, np.abs(at, out=at) - np.float32(limit), out=out)
        return out * np.float32(part.scale)


def _sharp(parts: Sequence[Part], grid: _Grid) -> Volume:
    ambient = parts[-1].volume.ambient_n
    regions: list[Region] = []
    matter = _Matter(grid)
    delta = None
    for part in parts:
        owned = matter.free.copy()
        nearest = np.full(grid.shape, np.inf, np.float32)
        to_grid = np.linalg.inv(grid.world) @ part.world
        for body in part.volume.regions:
            region = _turned(body, to_grid)
            sdf = grid.distance(part, region.sdf)
            np.minimum(nearest, sdf, out=nearest)
            if regions and _alike(regions[-1], region):
                regions[-1] = replace(regions[-1], sdf=np.minimum(regions[-1].sdf, sdf))
            else:
                regions.append(replace(region, sdf=sdf))
        if part.has_surface and part.volume.delta_n is not None:
            delta = _delta(part, grid, ambient, order=3)
        matter.add(part, part.volume, owned, nearest < 2.0 * grid.voxel)
        matter.free = np.minimum(matter.free, 1.0 - _covered(nearest, grid.voxel))
    return Volume(grid.extent, ambient, delta_n=delta, regions=tuple(regions), **matter.fields())


def _smooth(parts: Sequence[Part], grid: _Grid) -> Volume:
    ambient = parts[-1].volume.ambient_n
    by_channel = any(part.volume.is_dispersive for part in parts)
    matter = _Matter(grid)
    total: Any = 0.0
    for part in parts:
        raw = part.volume.rasterised(by_channel)
        delta = _delta(replace(part, volume=raw), grid, raw.ambient_n, order=1)
        delta = delta[..., None] if delta.ndim == 3 else delta
        held = np.abs(delta).max(axis=-1) > NOTHING * max(float(np.abs(raw.delta_n).max()), 1e-30)  # type: ignore[arg-type]
        if part.volume.regions:
            sdf = np.min([region.sdf for region in part.volume.regions], axis=0)
            covered = _covered(grid.distance(part, sdf), grid.voxel)
        else:
            covered = held.astype(np.float32)
        # The index itself counts, not how it differs from an ambient medium that is not there.
        shifted = delta + (raw.ambient_n - ambient) * covered[..., None]
        total = total + matter.free[..., None] * shifted
        matter.add(part, raw, matter.free, held)
        matter.free = matter.free * (1.0 - covered)
    delta = np.broadcast_to(total, (*grid.shape, 3 if by_channel else 1))
    return Volume(grid.extent, ambient, delta_n=delta if by_channel else delta[..., 0], **matter.fields())


class _Matter:
    """Fields that fill up part by part. free : (Z, Y, X), the share that no body of a part before owns."""

    def __init__(self, grid: _Grid) -> None:
        self.grid = grid
        self.free: np.ndarray = np.ones(grid.shape, np.float32)
        self.sums: dict[str, np.ndarray] = {}
        self.forward = np.zeros(grid.shape, np.float32)
        self.opaque: np.ndarray | None = None
        self.reflection: np.ndarray | None = None
        self.mirrors = np.zeros(grid.shape, bool)

    def add(self, part: Part, volume: Volume, free: np.ndarray, near: np.ndarray) -> None:
        """Take over the fields of a part. volume : it, or it on voxels. near : where its boundaries lie."""
        placed = replace(part, volume=volume)
        for name in FIELDS:
            values = getattr(volume, name)
            if values is None:
                continue
            found = self._channels(placed, values) * free[..., None]
            self.sums[name] = self.sums[name] + found if name in self.sums else found
            if name == "scattering" and volume.anisotropy is not None:
                self.forward += found.mean(axis=-1) * self.grid.resampled(placed, volume.anisotropy, order=1)
        if volume.opaque is not None:
            found = self._channels(placed, volume.opaque)
            taken = np.zeros(self.grid.shape, bool) if self.opaque is None else self.opaque[..., 3] > 0.0
            self.opaque = found if self.opaque is None else np.where(taken[..., None], self.opaque, found)
        if volume.reflection is not None:
            if self.reflection is None:
                self.reflection = np.ones((*self.grid.shape, 4), np.float32)
                self.reflection[..., 3] = 0.0
            own = near & ~self.mirrors
            self.reflection[own] = np.clip(self._channels(placed, volume.reflection)[own], 0.0, 1.0)
        self.mirrors |= near

    def _channels(self, part: Part, values: np.ndarray) -> np.ndarray:
        planes = [self.grid.resampled(part, values[..., c], order=1) for c in range(values.shape[-1])]
        return np.stack(planes, axis=-1)

    def fields(self) -> dict[str, Any]:
        out: dict[str, Any] = {name: values for name, values in self.sums.items() if values.any()}
        if self.forward.any():
            strength = self.sums["scattering"].mean(axis=-1)
            out["anisotropy"] = np.divide(self.forward, strength, out=np.zeros_like(strength), where=strength > 0.0)
        return {**out, "opaque": self.opaque, "reflection": self.reflection}


def _delta(part: Part, grid: _Grid, ambient: float, order: int) -> np.ndarray:
    """Index of a part minus that of the result's ambient medium, (Z, Y, X) or (Z, Y, X, 3)."""
    values = part.volume.delta_n
    assert values is not None
    shift = np.float32(part.volume.ambient_n - ambient)
    if values.ndim == 3:
        return grid.resampled(part, values, order) + shift
    return np.stack([grid.resampled(part, values[..., c], order) for c in range(3)], axis=-1) + shift


def _covered(sdf: np.ndarray, voxel: float) -> np.ndarray:
    return np.clip(np.float32(0.5) - sdf / np.float32(voxel), 0.0, 1.0)


def _of_one_index(volume: Volume) -> Volume:
    def single(region: Region) -> Region:
        medium = region.medium
        one = media.constant(medium.n_d, medium.absorption_per_m, medium.name)
        if medium.extraordinary is not None:
            other = medium.extraordinary
            one = media.uniaxial(one.n_d, other.n_d, medium.absorption_per_m, other.absorption_per_m, medium.name)
        return replace(region, medium=one)

    return volume.replace(regions=tuple(single(region) for region in volume.regions))


def _alike(a: Region, b: Region) -> bool:
    """Whether nothing tells the insides of two bodies apart."""
    if a.optic_axis is None or b.optic_axis is None:
        parallel = a.optic_axis is b.optic_axis
    else:
        parallel = abs(float(np.dot(a.optic_axis, b.optic_axis))) > 1.0 - 1e-12
    same = (a.medium, a.emission, a.scattering, a.anisotropy) == (b.medium, b.emission, b.scattering, b.anisotropy)
    return same and parallel


def _turned(region: Region, placement: Array) -> Region:
    """A body whose axis is stated in another frame. placement : (4, 4), its own to the other, uniformly scaled."""
    if region.optic_axis is None:
        return region
    x, y, z = placement[:3, :3] @ region.optic_axis
    return replace(region, optic_axis=(float(x), float(y), float(z)))
