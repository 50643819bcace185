"""From a volume to the arrays that the shaders march through; NumPy only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.distance import homogeneous_distance
from pellucid.fields.gradient import central, sobel
from pellucid.fields.smoothing import gaussian
from pellucid.fields.volume import Region, Volume
from pellucid.optics.dispersion import LAMBDA_D_NM, RGB_LAMBDA_NM
from pellucid.spectra import stratified
from pellucid.techniques.eikonal.crystals import Crystals, crystals_of

# Smallest jump of the index between neighbours that is taken for a surface: what a smaller one would reflect at normal
# incidence is below 3e-4, and graded lenses stay under it from 40 voxels of diameter on.
SURFACE_JUMP = 0.05
# A boundary event begins at this share of the steepest slope that its jump has after smoothing, and ends at the other.
EVENT_ON, EVENT_OFF = 0.25, 0.02
# Relative to its range a field may drift by this much within a cell and still count as constant there.
CONSTANT_WITHIN = 1e-5
# Voxels that are added around a body which its box cuts off, so that its distance is known on both sides of the cut.
BOX_PAD = 3
# Most memory for the fields of a volume whose index field differs from wavelength to wavelength, bytes.
MOST_FIELD_BYTES = 1 << 30
# Of a voxel: force and radius, and the index.
FIELD_BYTES = 20


@dataclass(frozen=True)
class Channel:
    """The index field at one wavelength (or at all, without dispersion).

    force : (Z, Y, X, 4); grad(n^2)/2 in 1/m for leapfrog, grad n for Euler; then the homogeneous radius, voxels.
    index : (Z, Y, X) float32, n - ambient_n; or None when nothing needs it.
    region_n : index of each region at this wavelength.
    lambda_nm : the wavelength.
    """

    force: np.ndarray | None
    index: np.ndarray | None
    region_n: tuple[float, ...]
    lambda_nm: float = LAMBDA_D_NM


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
    scattering: np.ndarray | None  # (Z, Y, X, 4), RGB in 1/m, then the anisotropy
    opaque: np.ndarray | None  # (Z, Y, X, 4)
    reflection: np.ndarray | None  # (Z, Y, X, 4)
    region_absorption: tuple[tuple[float, float, float], ...]
    region_emission: tuple[tuple[float, float, float], ...]
    region_scattering: tuple[tuple[float, float, float, float], ...]  # as `scattering`
    matter_extent_m: tuple[float, float, float]  # edges of the box that the fields fill: less than all where padded
    boundary_on_per_m: float
    boundary_off_per_m: float
    regions: tuple[Region, ...] = ()  # of a sharp volume, the first owns a point
    crystals: Crystals | None = None  # of a sharp volume

    @property
    def dispersive(self) -> bool:
        return len(self.channels) > 1

    @property
    def shares_fields(self) -> bool:
        """Whether its wavelengths differ in nothing but the indices of regions."""
        return len({(id(channel.force), id(channel.index)) for channel in self.channels}) == 1

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
    spectral: int = 0,
) -> Prepared:
    """Derive the arrays of one volume.

    Parameters
    ----------
    boundary : "sharp" (surfaces found by their signed distance; an array volume has its box for a surface) or
        "smooth" (the index is presmoothed and rays bend through the boundaries [tevs2007, 3.1]).
    smoothing_voxels : standard deviation of the presmoothing, smooth boundary only.
    gradient : "central" or "sobel" differences.
    method : "leapfrog" or "euler", which want different forces.
    dispersion : keep the wavelengths of a dispersive volume apart.
    spectral : how many wavelengths; 0 for the three of red, green and blue.

    Raises
    ------
    SceneError : when the boundary or the gradient is not one of these, or fields of so many wavelengths are too big.
    """
    lambdas_nm: tuple[float, ...] = (LAMBDA_D_NM,)
    if dispersion and volume.is_dispersive:
        lambdas_nm = tuple(stratified(spectral)) if spectral else RGB_LAMBDA_NM
    if boundary == "sharp":
        return _prepare_sharp(volume, gradient, method, lambdas_nm)
    if boundary == "smooth":
        return _prepare_smooth(volume, smoothing_voxels, gradient, method, lambdas_nm)
    raise SceneError("volume.boundary", f"is '{boundary}'", "use 'sharp' or 'smooth'")


def _prepare_sharp(volume: Volume, gradient: str, method: str, lambdas_nm: Sequence[float]) -> Prepared:
    matter_extent_m = volume.extent_m
    volume = _closed_at_box(volume)
    regions = volume.regions
    graded = volume.delta_n is not None
    scattering = _phased(volume)
    matter = [f for f in (volume.absorption, volume.emission, scattering) if f is not None]
    straight = None if graded else _straight_radii(volume, matter)
    matter += [] if volume.opaque is None else [volume.opaque]
    # Wavelengths that share a field share what is made of it.
    deltas = _fields_at(volume.delta_n, lambdas_nm) if volume.delta_n is not None else [None] * len(lambdas_nm)
    forces = {
        id(d): straight if d is None else _force(d, matter, volume, gradient, method, scattering)
        for d in _unlike(deltas)
    }
    channels = [
        Channel(forces[id(delta)], delta, indices_at(regions, lambda_nm), lambda_nm)
        for delta, lambda_nm in zip(deltas, lambdas_nm, strict=True)
    ]
    n_e = volume.delta_n_e
    deltas_e = [None] * len(lambdas_nm) if n_e is None else _fields_at(n_e, lambdas_nm)
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
        scattering=scattering,
        opaque=_coloured(volume.opaque),
        reflection=volume.reflection,
        region_absorption=tuple(_rgb(r.medium.absorption_rgb_per_m) for r in regions),
        region_emission=tuple(_rgb(r.emission) for r in regions),
        region_scattering=tuple((*_rgb(r.scattering), r.anisotropy) for r in regions),
        matter_extent_m=matter_extent_m,
        boundary_on_per_m=np.inf,
        boundary_off_per_m=0.0,
        regions=regions,
        crystals=crystals_of(volume, lambdas_nm, deltas, deltas_e),
    )


def _prepare_smooth(
    volume: Volume, smoothing: float, gradient: str, method: str, lambdas_nm: Sequence[float]
) -> Prepared:
    raw = volume.rasterised(by_channel=len(lambdas_nm) > 1)
    assert raw.delta_n is not None
    deltas = _fields_at(raw.delta_n, lambdas_nm)
    pad = _padding(deltas, smoothing)
    fields = (raw.absorption, raw.emission, _phased(raw), raw.opaque)
    absorption, emission, scattering, opaque = (_padded(f, pad) for f in fields)
    shape = np.array(raw.shape[::-1])
    extent = tuple(float(e) for e in np.array(raw.extent_m) * (shape + 2 * pad) / shape)
    jump = _surface_jump(deltas[len(deltas) // 2])
    others = [f for f in (absorption, emission, scattering, opaque) if f is not None]
    grid = _Grid(raw.voxel_m, raw.ambient_n)
    made: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    for delta in _unlike(deltas):
        soft = np.pad(delta, pad)
        if smoothing > 0.0:
            soft = gaussian(soft, smoothing)
        made[id(delta)] = _force(soft, others, grid, gradient, method, scattering), soft
    channels = [Channel(*made[id(d)], (), lambda_nm) for d, lambda_nm in zip(deltas, lambdas_nm, strict=True)]
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
        scattering=scattering,
        opaque=_coloured(opaque),
        reflection=_padded(volume.reflection, pad, "edge"),
        region_absorption=(),
        region_emission=(),
        region_scattering=(),
        matter_extent_m=(extent[0], extent[1], extent[2]),
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
    fields = ("delta_n", "absorption", "scattering", "anisotropy", "emission", "reflection", "optic_axis", "delta_n_e")
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


def indices_at(regions: Sequence[Region], lambda_nm: float) -> tuple[float, ...]:
    """Index of each region; beyond the wavelengths that the source of a medium covers, the one where they end."""
    return tuple(float(r.medium.n(np.clip(lambda_nm, *r.medium.valid_nm))) for r in regions)


def _fields_at(delta: np.ndarray, lambdas_nm: Sequence[float]) -> list[np.ndarray]:
    """The index field (Z, Y, X) at each wavelength; the same array where it does not depend on it.

    Of three channels the one of green serves for all colours at once. Between and beyond them the index follows
    n = a + b/lambda^2 + c/lambda^4 through the three [born1999, 2.3.4].
    """
    if delta.ndim == 3:
        return [delta] * len(lambdas_nm)
    if len(lambdas_nm) == 1:
        return [np.ascontiguousarray(delta[..., 1])]
    bytes_each = delta[..., 0].size * FIELD_BYTES
    if len(lambdas_nm) * bytes_each > max(MOST_FIELD_BYTES, len(RGB_LAMBDA_NM) * bytes_each):
        size = len(lambdas_nm) * bytes_each / 2**30
        reason = f"is {len(lambdas_nm)}, and fields of that many wavelengths take {size:.1f} GiB"
        most = max(0, MOST_FIELD_BYTES // bytes_each)
        fewer = f"use up to {most}, or " if most >= 4 else "use 0, or "
        raise SceneError(
            "refractive_volume.spectral", reason, f"{fewer}fewer voxels, or sharp regions, which share theirs"
        )
    return [(delta @ _between_channels(lambda_nm)).astype(np.float32) for lambda_nm in lambdas_nm]


def _between_channels(lambda_nm: float) -> np.ndarray:
    """(3,) shares of the red, green and blue index in that at another wavelength: Lagrange in 1/lambda^2."""
    at, u = np.asarray(RGB_LAMBDA_NM) ** -2.0, lambda_nm**-2.0
    others = [np.delete(at, c) for c in range(3)]
    return np.array([np.prod((u - o) / (at[c] - o)) for c, o in enumerate(others)])


def _unlike(fields: Sequence[np.ndarray | None]) -> list[Any]:
    """Each array of a list once."""
    return list({id(field): field for field in fields}.values())


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


def _phased(volume: Volume) -> np.ndarray | None:
    """Scattering and its anisotropy as one field (Z, Y, X, 4)."""
    if volume.scattering is None:
        return None
    g = np.zeros(volume.shape, np.float32) if volume.anisotropy is None else volume.anisotropy
    g = _continued(g[..., None], volume.scattering.mean(axis=-1))
    return np.concatenate([volume.scattering, g], axis=-1)


def _coloured(opaque: np.ndarray | None) -> np.ndarray | None:
    """Opaque voxels (Z, Y, X, 4), with their colours going on where their coverage ends."""
    if opaque is None:
        return None
    return np.concatenate([_continued(opaque[..., :3], opaque[..., 3]), opaque[..., 3:]], axis=-1)


def _continued(values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Values (Z, Y, X, C) that mean something where `weight` (Z, Y, X) is above 0, carried one voxel further.

    Else what is interpolated at the rim of a thing would fade into what stands for nothing.
    """
    from scipy.ndimage import uniform_filter

    empty = weight <= 0.0
    if not values.any() or not empty.any():
        return values
    around = uniform_filter(weight.astype(np.float64), 3, mode="constant")
    near = empty & (around > 1e-9 * float(weight.max()))
    out = np.array(values, np.float32)
    for c in range(values.shape[-1]):
        mean = uniform_filter(values[..., c].astype(np.float64) * weight, 3, mode="constant")
        out[near, c] = mean[near] / around[near]
    return out


def _force(
    delta: np.ndarray,
    others: Sequence[np.ndarray],
    grid: Volume | _Grid,
    gradient: str,
    method: str,
    scattering: np.ndarray | None,
) -> np.ndarray:
    """The field that bends rays, with the radius in which nothing at all changes in its fourth channel.

    No radius where light is scattered: how much of it there is differs from place to place.

    n^2/2 = a^2/2 + (a d + d^2/2) with d = n - a: the bracket keeps its digits when d is 1e-4 [sharma1982, eq. 3].
    """
    slope = {"central": central, "sobel": sobel}[gradient]
    d = delta.astype(np.float64)
    potential = d if method == "euler" else grid.ambient_n * d + 0.5 * d * d
    force = slope(potential, grid.voxel_m)
    fields = [delta, force, *others]
    tolerances = [CONSTANT_WITHIN * float(np.ptp(f)) for f in fields]
    radius = homogeneous_distance(fields, grid.voxel_m, tolerances) / min(grid.voxel_m)
    if scattering is not None:
        radius[scattering[..., :3].any(axis=-1)] = 0.0
    return np.concatenate([force, radius[..., None].astype(np.float32)], axis=-1)


def _straight_radii(volume: Volume, matter: Sequence[np.ndarray]) -> np.ndarray | None:
    """What straight rays need of radii, voxels: in the fourth channel to opaque voxels, in the first to other matter.

    No force bends them, so its channels are free.
    """
    if volume.opaque is None and not matter:
        return None
    radii = np.zeros((*volume.shape, 4), np.float32)
    for channel, fields in ((0, matter), (3, [] if volume.opaque is None else [volume.opaque])):
        if fields:
            tolerances = [CONSTANT_WITHIN * float(np.ptp(f)) for f in fields]
            radii[..., channel] = homogeneous_distance(fields, volume.voxel_m, tolerances) / min(volume.voxel_m)
    return radii


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
