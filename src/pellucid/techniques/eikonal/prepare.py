"""From a volume to the arrays that the shaders march through; NumPy only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.distance import homogeneous_distance
from pellucid.fields.gradient import central, sobel
from pellucid.fields.smoothing import gaussian
from pellucid.fields.volume import Volume
from pellucid.optics.dispersion import LAMBDA_D_NM

# Smallest jump of the index between neighbours that is taken for a surface: what a smaller one would reflect at normal
# incidence is below 3e-4, and graded lenses stay under it from 40 voxels of diameter on.
SURFACE_JUMP = 0.05
# A boundary event begins at this share of the steepest slope that its jump has after smoothing, and ends at the other.
EVENT_ON, EVENT_OFF = 0.25, 0.02
# Relative to its range a field may drift by this much within a cell and still count as constant there.
CONSTANT_WITHIN = 1e-5
# Voxels that are added around a body which its box cuts off, so that its distance is known on both sides of the cut.
BOX_PAD = 3


@dataclass(frozen=True)
class Channel:
    """The index field at one wavelength (or at all, without dispersion).

    force : (Z, Y, X, 4); grad(n^2)/2 in 1/m for leapfrog, grad n for Euler; then the homogeneous radius, voxels.
    index : (Z, Y, X) float32, n - ambient_n; or None when nothing needs it.
    region_n : index of each region at this wavelength.
    """

    force: np.ndarray | None
    index: np.ndarray | None
    region_n: tuple[float, ...]


@dataclass(frozen=True)
class Prepared:
    """Everything about a volume that does not depend on where it stands."""

    sharp: bool
    graded: bool
    extent_m: tuple[float, float, float]
    voxel_m: tuple[float, float, float]
    ambient_n: float
    channels: tuple[Channel, ...]
    distance: np.ndarray | None  # (Z, Y, X, regions) float32, voxels
    absorption: np.ndarray | None  # (Z, Y, X, 3), 1/m
    emission: np.ndarray | None  # (Z, Y, X, 3), radiance per metre
    opaque: np.ndarray | None  # (Z, Y, X, 4)
    region_absorption: tuple[tuple[float, float, float], ...]
    region_emission: tuple[tuple[float, float, float], ...]
    boundary_on_per_m: float
    boundary_off_per_m: float

    @property
    def dispersive(self) -> bool:
        return len(self.channels) == 3

    @property
    def voxel(self) -> float:
        return min(self.voxel_m)


def prepare(
    volume: Volume,
    boundary: str,
    smoothing_voxels: float = 0.75,
    gradient: str = "central",
    method: str = "leapfrog",
    dispersion: bool = True,
) -> Prepared:
    """Derive the arrays of one volume.

    Parameters
    ----------
    boundary : "sharp" (surfaces found by their signed distance; an array volume has its box for a surface) or
        "smooth" (the index is presmoothed and rays bend through the boundaries [tevs2007, 3.1]).
    smoothing_voxels : standard deviation of the presmoothing, smooth boundary only.
    gradient : "central" or "sobel" differences.
    method : "leapfrog" or "euler", which want different forces.
    dispersion : keep the three channels of a dispersive volume apart.

    Raises
    ------
    SceneError : when the boundary or the gradient is not one of these.
    """
    if boundary == "sharp":
        return _prepare_sharp(volume, gradient, method, dispersion)
    if boundary == "smooth":
        return _prepare_smooth(volume, smoothing_voxels, gradient, method, dispersion)
    raise SceneError("volume.boundary", f"is '{boundary}'", "use 'sharp' or 'smooth'")


def _prepare_sharp(volume: Volume, gradient: str, method: str, dispersion: bool) -> Prepared:
    volume = _closed_at_box(volume)
    regions = volume.regions
    graded = volume.delta_n is not None
    spread = dispersion and volume.is_dispersive
    fields = [f for f in (volume.absorption, volume.emission, volume.opaque) if f is not None] if graded else []
    deltas: Sequence[np.ndarray | None] = _channels(volume.delta_n, spread) if graded else [None] * (3 if spread else 1)
    straight = None if graded else _distance_to_opaque(volume)
    channels = []
    for i, delta in enumerate(deltas):
        indices = tuple(float(r.medium.n_rgb[i] if spread else r.medium.n(LAMBDA_D_NM)) for r in regions)
        force = straight if delta is None else _force(delta, fields, volume, gradient, method)
        channels.append(Channel(force, delta, indices))
    voxel = min(volume.voxel_m)
    distance = np.stack([r.sdf / voxel for r in regions], axis=-1) if regions else None
    return Prepared(
        sharp=True,
        graded=graded,
        extent_m=volume.extent_m,
        voxel_m=volume.voxel_m,
        ambient_n=volume.ambient_n,
        channels=tuple(channels),
        distance=distance,
        absorption=volume.absorption,
        emission=volume.emission,
        opaque=volume.opaque,
        region_absorption=tuple(_rgb(r.medium.absorption_rgb_per_m) for r in regions),
        region_emission=tuple(_rgb(r.emission) for r in regions),
        boundary_on_per_m=np.inf,
        boundary_off_per_m=0.0,
    )


def _prepare_smooth(volume: Volume, smoothing: float, gradient: str, method: str, dispersion: bool) -> Prepared:
    raw = volume.rasterised(by_channel=dispersion)
    assert raw.delta_n is not None
    deltas = _channels(raw.delta_n, dispersion and raw.is_dispersive)
    pad = _padding(deltas, smoothing)
    absorption, emission, opaque = (_padded(f, pad) for f in (raw.absorption, raw.emission, raw.opaque))
    shape = np.array(raw.shape[::-1])
    extent = tuple(float(e) for e in np.array(raw.extent_m) * (shape + 2 * pad) / shape)
    jump = _surface_jump(deltas[len(deltas) // 2])
    others = [f for f in (absorption, emission, opaque) if f is not None]
    grid = _Grid(raw.voxel_m, raw.ambient_n)
    channels = []
    for delta in deltas:
        soft = np.pad(delta, pad)
        if smoothing > 0.0:
            soft = gaussian(soft, smoothing)
        channels.append(Channel(_force(soft, others, grid, gradient, method), soft, ()))
    steepest = jump / (min(raw.voxel_m) * np.sqrt(2 * np.pi * (smoothing**2 + 0.5))) if jump else np.inf
    return Prepared(
        sharp=False,
        graded=True,
        extent_m=(extent[0], extent[1], extent[2]),
        voxel_m=raw.voxel_m,
        ambient_n=raw.ambient_n,
        channels=tuple(channels),
        distance=None,
        absorption=absorption,
        emission=emission,
        opaque=opaque,
        region_absorption=(),
        region_emission=(),
        boundary_on_per_m=float(EVENT_ON * steepest),
        boundary_off_per_m=float(EVENT_OFF * steepest) if jump else 0.0,
    )


def _closed_at_box(volume: Volume) -> Volume:
    """Where a body reaches the faces of its box, these are its surface: add a margin outside and cut it off there."""
    borders = [np.take(r.sdf, (0, -1), axis=a).min() for r in volume.regions for a in range(3)]
    if not borders or min(borders) >= 0.0:
        return volume
    z, y, x = np.meshgrid(
        *(
            np.abs((np.arange(-BOX_PAD, n + BOX_PAD) + 0.5) * h - 0.5 * n * h) - 0.5 * n * h
            for n, h in zip(volume.shape, volume.voxel_m[::-1], strict=True)
        ),
        indexing="ij",
        sparse=True,
    )
    outside_box = np.maximum(np.maximum(x, y), z)
    regions = []
    for region in volume.regions:
        distance = np.pad(region.sdf, BOX_PAD, mode="edge")
        regions.append(replace(region, sdf=np.maximum(distance, outside_box).astype(np.float32)))
    fields = ("delta_n", "absorption", "scattering", "anisotropy", "emission")
    margin = np.array(volume.voxel_m) * 2 * BOX_PAD
    return volume.replace(
        extent_m=tuple(np.array(volume.extent_m) + margin),
        regions=tuple(regions),
        opaque=_padded(volume.opaque, BOX_PAD),
        **{name: _padded(getattr(volume, name), BOX_PAD, "edge") for name in fields},
    )


@dataclass(frozen=True)
class _Grid:
    voxel_m: tuple[float, float, float]
    ambient_n: float


def _rgb(values: Sequence[float] | np.ndarray) -> tuple[float, float, float]:
    r, g, b = (float(v) for v in values)
    return r, g, b


def _channels(delta: np.ndarray | None, spread: bool) -> list[np.ndarray]:
    assert delta is not None
    if delta.ndim == 3:
        return [delta] * (3 if spread else 1)
    if spread:
        return [np.ascontiguousarray(delta[..., c]) for c in range(3)]
    return [np.ascontiguousarray(delta[..., 1])]


def _padding(deltas: Sequence[np.ndarray], smoothing: float) -> int:
    """Voxels of ambient medium to add on every side, where a field does not end in it by itself."""
    if smoothing <= 0.0:
        return 0
    for delta in deltas:
        border = max(float(np.abs(np.take(delta, (0, -1), axis=a)).max()) for a in range(3))
        if border > 1e-3 * float(np.abs(delta).max()) > 0.0:
            return int(np.ceil(3.0 * smoothing)) + 2
    return 0


def _padded(field: np.ndarray | None, pad: int, mode: Literal["constant", "edge"] = "constant") -> np.ndarray | None:
    """With `pad` voxels more on every side: nothing ("constant") or what is at the border ("edge")."""
    if field is None or pad == 0:
        return field
    return np.pad(field, [(pad, pad)] * 3 + [(0, 0)] * (field.ndim - 3), mode=mode)


def _force(
    delta: np.ndarray, others: Sequence[np.ndarray], grid: Volume | _Grid, gradient: str, method: str
) -> np.ndarray:
    """The field that bends rays, with the radius in which nothing at all changes in its fourth channel.

    n^2/2 = a^2/2 + (a d + d^2/2) with d = n - a: the bracket keeps its digits when d is 1e-4 [sharma1982, eq. 3].
    """
    slope = {"central": central, "sobel": sobel}[gradient]
    d = delta.astype(np.float64)
    potential = d if method == "euler" else grid.ambient_n * d + 0.5 * d * d
    force = slope(potential, grid.voxel_m)
    fields = [delta, force, *others]
    tolerances = [CONSTANT_WITHIN * float(np.ptp(f)) for f in fields]
    radius = homogeneous_distance(fields, grid.voxel_m, tolerances) / min(grid.voxel_m)
    return np.concatenate([force, radius[..., None].astype(np.float32)], axis=-1)


def _distance_to_opaque(volume: Volume) -> np.ndarray | None:
    """For straight rays only opaque voxels need a radius to be found by."""
    if volume.opaque is None:
        return None
    radius = homogeneous_distance([volume.opaque], volume.voxel_m) / min(volume.voxel_m)
    force = np.zeros((*volume.shape, 4), np.float32)
    force[..., 3] = radius
    return force


def _surface_jump(delta: np.ndarray) -> float:
    """Typical jump of the index across the surfaces of a field; 0 when it has none, as a graded lens.

    A surface is a difference between neighbours that is large and changes at once on one of its sides.
    """
    jumps = []
    for axis in range(3):
        if delta.shape[axis] < 4:
            continue
        step = np.abs(np.diff(delta, axis=axis))
        lines = np.moveaxis(step, axis, 0)
        before, here, after = lines[:-2], lines[1:-1], lines[2:]
        isolated = (here > SURFACE_JUMP) & (np.minimum(before, after) < 0.5 * here)
        jumps.append(here[isolated])
        border = np.abs(np.take(delta, (0, -1), axis=axis))
        jumps.append(border[border > SURFACE_JUMP])
    found = np.concatenate(jumps) if jumps else np.zeros(0)
    return float(np.percentile(found, 50)) if found.size else 0.0
