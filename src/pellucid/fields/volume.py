"""A box of space in which the refractive index varies: the data that the laws of light act on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid import media
from pellucid.errors import SceneError
from pellucid.media import Medium
from pellucid.optics.dispersion import LAMBDA_D_NM

from .numbers import real_array
from .region import Region
from .sampling import Extent, FieldFunction, box_edges, check_resolution, check_size, sampled, sampling
from .volume_checks import check_crystal, check_ranges, common_shape
from .voxels import Voxels, refractive_index, unit_vectors, voxels

MediumLike = Medium | str | float
Axis = Sequence[float] | npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Volume:
    """Optical fields on voxels, or up to four bodies with sharp surfaces, in a box about the origin.

    Arrays are indexed [z, y, x], channels last, and are kept as contiguous read-only float32. The centre of
    voxel i along x is at `(i + 0.5) * voxel_m[0] - extent_m[0] / 2`.

    Parameters
    ----------
    extent_m : edges of the box (x, y, z), metres.
    ambient_n : index outside.
    delta_n : (Z, Y, X) index minus `ambient_n` at 587.56 nm, or (Z, Y, X, 3) at the RGB wavelengths. A
        difference, because float32 cannot hold n of a gas well.
    absorption, scattering : (Z, Y, X, 3) coefficients, 1/m, >= 0. With `regions` they are added to what the region
        at a place has, also outside all regions: smoke around a body.
    anisotropy : (Z, Y, X) mean cosine of what `scattering` scatters, in (-1, 1).
    emission : (Z, Y, X, 3) radiance gained per metre, >= 0; added as they are.
    opaque : (Z, Y, X, 4) linear RGB and coverage 0 to 1 of opaque matter.
    reflection : (Z, Y, X, 4) what boundaries do to the light that they mirror: share that is kept, RGB, 0 to 1 (the
        rest is absorbed), and roughness 0 to 1, for a `RefractiveVolume` with a BRDF.
    regions : bodies; the **first** whose distance is negative owns a point. With `delta_n` as well, that is the index
        inside the first body (a graded lens with a sharp surface), which then should be continued past the surface.
    optic_axis : (Z, Y, X, 3) axis of the first body, a uniaxial crystal, from place to place in object space; of any
        length but 0. It is interpolated, so neighbours must not point to opposite sides.
    delta_n_e : (Z, Y, X) or (Z, Y, X, 3) extraordinary index of the first body minus `ambient_n`. Without it that
        differs from the ordinary one as in the medium.

    Raises
    ------
    SceneError
        Names the field that is wrong.
    """

    extent_m: tuple[float, float, float]
    ambient_n: float = 1.0
    delta_n: Voxels | None = None
    absorption: Voxels | None = None
    scattering: Voxels | None = None
    anisotropy: Voxels | None = None
    emission: Voxels | None = None
    opaque: Voxels | None = None
    reflection: Voxels | None = None
    regions: tuple[Region, ...] = ()
    optic_axis: Voxels | None = None
    delta_n_e: Voxels | None = None
    shape: tuple[int, int, int] = field(init=False)

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "ambient_n", refractive_index("ambient_n", self.ambient_n))
        put(self, "regions", tuple(self.regions))
        put(self, "shape", common_shape(self))
        put(self, "extent_m", box_edges(self.extent_m, self.shape))
        for name, channels in _CHANNELS.items():
            values = getattr(self, name)
            if values is not None:
                put(self, name, voxels(name, values, channels, self.shape))
        if self.optic_axis is not None:
            put(self, "optic_axis", unit_vectors("optic_axis", self.optic_axis))
        check_ranges(self)
        check_crystal(self)

    @property
    def voxel_m(self) -> tuple[float, float, float]:
        """Voxel edges (x, y, z), metres."""
        z, y, x = self.shape
        return self.extent_m[0] / x, self.extent_m[1] / y, self.extent_m[2] / z

    @property
    def nbytes(self) -> int:
        """Memory of all arrays."""
        arrays = [getattr(self, name) for name in _CHANNELS] + [r.sdf for r in self.regions]
        return sum(a.nbytes for a in arrays if a is not None)

    @property
    def is_dispersive(self) -> bool:
        """Whether the index differs between the colour channels."""
        by_channel = any(n is not None and n.ndim == 4 for n in (self.delta_n, self.delta_n_e))
        return by_channel or any(r.medium.is_dispersive for r in self.regions)

    @property
    def has_crystals(self) -> bool:
        """Whether light splits into two rays in any body."""
        return self.optic_axis is not None or any(r.optic_axis is not None for r in self.regions)

    @classmethod
    def from_array(
        cls,
        n: npt.ArrayLike,
        extent_m: Extent,
        ambient_n: float = 1.0,
        absorption: npt.ArrayLike | None = None,
        scattering: npt.ArrayLike | None = None,
        anisotropy: npt.ArrayLike | None = None,
        emission: npt.ArrayLike | None = None,
        opaque: npt.ArrayLike | None = None,
        reflection: npt.ArrayLike | None = None,
    ) -> Volume:
        """A volume from the refractive index of every voxel.

        Parameters
        ----------
        n : (Z, Y, X) index > 0, or (Z, Y, X, 3) one for each colour channel.
        extent_m : edges (x, y, z), or one number: the longest edge, with cubic voxels.
        others : as in `Volume`.
        """
        index = real_array("n", n)
        if index.ndim not in (3, 4) or (index.ndim == 4 and index.shape[3] != 3):
            raise SceneError("n", f"has shape {index.shape}", "give (Z, Y, X) or (Z, Y, X, 3)")
        check_size("n", index.shape[:3])
        bad = int(np.count_nonzero(~np.isfinite(index)))
        if bad:
            raise SceneError("n", f"has {bad} values that are not finite", "replace NaN and infinity by an index")
        if float(index.min()) <= 0.0:
            raise SceneError("n", f"has {float(index.min()):g}", "a refractive index is above 0")
        ambient = refractive_index("ambient_n", ambient_n)
        # In double precision: n - 1 of a gas would lose most of its digits in float32.
        delta = (index.astype(np.float64) - ambient).astype(np.float32)
        fields = {
            "absorption": absorption,
            "scattering": scattering,
            "anisotropy": anisotropy,
            "emission": emission,
            "opaque": opaque,
            "reflection": reflection,
        }
        return cls(extent_m, ambient, delta, **fields)  # type: ignore[arg-type]

    @classmethod
    def from_function(cls, f: FieldFunction, resolution: int, extent_m: Extent, ambient_n: float = 1.0) -> Volume:
        """A volume from the index as a function of place.

        Parameters
        ----------
        f : `f(x, y, z)` of arrays in metres from the centre, giving the index.
        resolution : voxels along the longest edge.
        extent_m : edges (x, y, z), or one number for a cube.
        """
        shape, extent = sampling(resolution, extent_m)
        return cls.from_array(sampled("f", f, shape, extent), extent, ambient_n)

    @classmethod
    def from_sdf(
        cls,
        f: FieldFunction,
        medium: MediumLike,
        resolution: int,
        extent_m: Extent,
        ambient_n: float = 1.0,
        optic_axis: Axis | None = None,
    ) -> Volume:
        """One body from its signed distance `f(x, y, z)` in metres, negative inside; else as `from_function`.

        optic_axis : of a crystal, see `Region`.
        """
        return cls.from_regions([(f, medium)], resolution, extent_m, ambient_n, [optic_axis])

    @classmethod
    def from_regions(
        cls,
        regions: Sequence[tuple[FieldFunction | npt.ArrayLike, MediumLike]],
        resolution: int,
        extent_m: Extent,
        ambient_n: float = 1.0,
        optic_axes: Sequence[Axis | None] = (),
    ) -> Volume:
        """Several bodies in one box; where they overlap the first has priority.

        Parameters
        ----------
        regions : up to four pairs of a signed distance (function of x, y, z, or array) and a medium.
        resolution, extent_m : as in `from_function`.
        optic_axes : one for each body, or None for one that is not to be drawn as a crystal; see `Region`.
        """
        shape, extent = sampling(resolution, extent_m)
        axes = list(optic_axes) or [None] * len(regions)
        if len(axes) != len(regions):
            raise SceneError("optic_axes", f"has {len(axes)} for {len(regions)} regions", "give one, or None, for each")
        bodies = []
        for i, pair in enumerate(regions):
            if not isinstance(pair, tuple | list) or len(pair) != 2:
                raise SceneError(f"regions[{i}]", f"cannot be {type(pair).__name__!r}", "give (distance, medium)")
            distance, medium = pair
            name = f"regions[{i}].sdf"
            values = sampled(name, distance, shape, extent) if callable(distance) else distance
            sdf = voxels(name, values, None, shape)
            bodies.append(Region(sdf, media.resolve(medium), optic_axis=axes[i]))  # type: ignore[arg-type]
        return cls(extent, ambient_n, regions=tuple(bodies))  # type: ignore[arg-type]

    @classmethod
    def from_mesh(
        cls,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        medium: MediumLike,
        resolution: int,
        margin_voxels: int = 3,
        ambient_n: float = 1.0,
        rounding_voxels: float = 0.0,
        progress: Callable[[float], None] | None = None,
        optic_axis: Axis | None = None,
    ) -> tuple[Volume, tuple[float, float, float]]:
        """A body bounded by a triangle mesh, in cubic voxels around it (see `voxelise.signed_distance`).

        Parameters
        ----------
        vertices : (V, 3) metres.
        faces : (F, 3).
        resolution : voxels along the longest edge, margins included.
        margin_voxels : empty voxels around the mesh on each side.
        rounding_voxels : standard deviation of a Gaussian that the distances are blurred by, 0 to 8: rounds off the
            facets of a coarse mesh, and its edges. A blurred distance never exceeds that to the blurred surface.
        optic_axis : of a crystal, see `Region`.

        Returns
        -------
        The volume, and where its centre lies in the mesh's coordinates (x, y, z).
        """
        from .smoothing import gaussian
        from .voxelise import cleaned, signed_distance

        points, triangles = cleaned(vertices, faces)
        used = points[np.unique(triangles)]
        low, high = used.min(axis=0), used.max(axis=0)
        check_resolution(resolution)
        blur = _rounding(rounding_voxels)
        if resolution <= 2 * margin_voxels + 1 or margin_voxels < 0:
            raise SceneError("resolution", f"is {resolution} with margins of {margin_voxels} voxels")
        voxel = float((high - low).max()) / (resolution - 2 * margin_voxels)
        count = np.ceil((high - low) / voxel - 1e-9).astype(int) + 2 * margin_voxels
        centre = 0.5 * (low + high)
        shape = (int(count[2]), int(count[1]), int(count[0]))
        sdf = signed_distance(points, triangles, shape, centre - 0.5 * (count - 1) * voxel, voxel, progress)
        sdf = gaussian(sdf, blur)
        if not (sdf < 0.0).any():
            raise SceneError("mesh", "encloses no voxel centre", "close it, thicken it, or use a finer resolution")
        x, y, z = (float(c) * voxel for c in count)
        body = Region(sdf, media.resolve(medium), optic_axis=optic_axis)  # type: ignore[arg-type]
        volume = cls((x, y, z), ambient_n, regions=(body,))
        return volume, (float(centre[0]), float(centre[1]), float(centre[2]))

    def rasterised(self, by_channel: bool = True) -> Volume:
        """The same matter as voxel fields, for the smooth boundary model; a volume of arrays is returned as is.

        by_channel : an index for each colour channel where the media disperse, else the one at the main wavelength.

        A voxel is covered by `clamp(0.5 - sdf / h, 0, 1)`, h the mean voxel edge: the covered share of a cube cut by a
        plane parallel to a face. Of what earlier regions leave uncovered, each takes its share, so two
        bodies that touch leave no gap. Fields of the volume are added to what the bodies have; of all that scatters in
        a voxel the anisotropy is the mean, weighted by scattering.
        """
        if not self.regions:
            return self
        channels = 3 if self.is_dispersive and by_channel else 1
        delta = np.zeros((*self.shape, channels))
        absorption, emission, scattering = (_filled(getattr(self, name), (*self.shape, 3)) for name in _ADDED)
        # Sum of scattering times anisotropy: the mean cosine of a mixture is the mean of those of its parts.
        forward = scattering.mean(axis=-1) * _filled(self.anisotropy, self.shape)
        free = np.ones(self.shape)
        graded = None if self.delta_n is None else self.delta_n.reshape(*self.shape, -1).astype(np.float64)
        if graded is not None and graded.shape[3] > channels:
            graded = graded[..., 1:2]  # green, the nearest of the three to the main wavelength
        for number, region in enumerate(self.regions):
            covered = np.clip(0.5 - region.sdf.astype(np.float64) / float(np.mean(self.voxel_m)), 0.0, 1.0)
            share = np.minimum(covered, free)[..., None]
            free -= share[..., 0]
            inside = _region_index(region.medium, channels) - self.ambient_n
            delta += share * (graded if number == 0 and graded is not None else inside)
            absorption += share * np.asarray(region.medium.absorption_rgb_per_m)
            emission += share * np.asarray(region.emission)
            scattering += share * np.asarray(region.scattering)
            forward += share[..., 0] * np.mean(region.scattering) * region.anisotropy
        strength = scattering.mean(axis=-1)
        anisotropy = np.divide(forward, strength, out=np.zeros(self.shape), where=strength > 0.0)
        return Volume(
            self.extent_m,
            self.ambient_n,
            delta_n=(delta if channels == 3 else delta[..., 0]).astype(np.float32),
            absorption=absorption.astype(np.float32) if absorption.any() else None,
            scattering=scattering.astype(np.float32) if scattering.any() else None,
            anisotropy=anisotropy.astype(np.float32) if anisotropy.any() else None,
            emission=emission.astype(np.float32) if emission.any() else None,
            opaque=self.opaque,
            reflection=self.reflection,
        )

    def __repr__(self) -> str:
        edges = " x ".join(f"{edge:g}" for edge in self.extent_m)
        held = [name for name in _CHANNELS if getattr(self, name) is not None]
        bodies = [f"{region.name or region.medium.name}" for region in self.regions]
        return f"Volume({edges} m, shape={self.shape}, ambient_n={self.ambient_n:g}, of {', '.join(bodies + held)})"

    def replace(self, **changes: Any) -> Volume:
        """A copy with some fields changed."""
        return replace(self, **changes)


_CHANNELS: dict[str, int | None] = {
    "delta_n": -1,
    "absorption": 3,
    "scattering": 3,
    "anisotropy": None,
    "emission": 3,
    "opaque": 4,
    "reflection": 4,
    "optic_axis": 3,
    "delta_n_e": -1,
}

# Fields that add up with the constants of regions, in the order that `rasterised` names them in.
_ADDED = ("absorption", "emission", "scattering")


def _filled(values: Voxels | None, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """A copy to add to; zeros where there is no field."""
    return np.zeros(shape) if values is None else values.astype(np.float64)


def _rounding(voxels: float) -> float:
    if isinstance(voxels, bool) or not isinstance(voxels, int | float | np.number) or not 0.0 <= voxels <= 8.0:
        raise SceneError("rounding_voxels", f"is {voxels!r}", "use 0 to 8 voxels")
    return float(voxels)


def _region_index(medium: Medium, channels: int) -> npt.NDArray[np.float64]:
    return np.asarray(medium.n_rgb if channels == 3 else [float(medium.n(LAMBDA_D_NM))], dtype=np.float64)
