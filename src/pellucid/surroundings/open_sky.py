"""How much of the sky's light meshes leave to places in water, and how bright what hides it is.

For each water a grid of places lies under its surface. From each, rays go through the level surface to the sky, as
directions of equal flux; what they meet stays until meshes or waters move. A surface then receives, along each of its
axes a = +-x, +y, +-z, the share

    R_a = sum_k seen_k L_k (1 - F_k) max(a.d_k, 0)/d_k.y  /  the same of all k,

d_k refracted, and of any normal the mean of those by the squares of its parts [mctaggart2004]. What hides the sky sends
light of its own: taken to be lit as the place is, with the mean albedo rho of what the rays met, it completes the open
sky's light to R / (1 - rho (1 - R)) [jimenez2016]; to all of it among white things, as it should in an even sky.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu.kernel import ComputeKernel
from pellucid.optics import fresnel_dielectric
from pellucid.surroundings.layouts import OPEN_SIZE, OpenSky

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pellucid.gpu import Device
    from pellucid.surroundings.geometry import Geometry
    from pellucid.surroundings.submersion import WaterRegion

RAYS = 24  # from each place
AXES = np.array([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)])
INSIDE = 0.5  # share of rays that meet the back of a surface, above which a place lies in what that bounds
BACK = np.uint32(1 << 31)
ROW = 64  # places of a workgroup


class OpenSkyMaps:
    """The grids of all waters on the device.

    Parameters
    ----------
    device : where they live. resources : bind group 1 by name, which gets the grids.

    Attributes
    ----------
    ray_runs : how often rays were sent.
    """

    def __init__(self, device: Device, resources: dict[str, Any]) -> None:
        self.device, self._resources = device, resources
        self.ray_runs = 0
        self._met: list[np.ndarray] = []
        self._geometry: Geometry | None = None
        self._places: list[Any] = []
        self._shares: tuple[Any, ...] = ()
        self._buffers: tuple[Any, ...] | None = None
        resources["submerged_open"] = device.buffer(np.zeros((1, 4), np.uint32), "storage", "open sky")

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        rays = 4 * int(np.prod(OPEN_SIZE)) * RAYS if self._buffers else 0
        return int(self._resources["submerged_open"].size) + rays

    def update(
        self,
        regions: Sequence[WaterRegion],
        geometry: Geometry,
        albedo: np.ndarray,
        sky: np.ndarray,
        rotation: tuple[float, float],
    ) -> bool:
        """Bring the grids to date; tells whether they changed.

        Parameters
        ----------
        geometry : the meshes, on the device already. albedo : (M, 3) of each mesh.
        sky : (H, W, 3) radiance, row 0 towards +Y. rotation : cosine and sine of its turn about +Y.
        """
        shaded = [region for region in regions if region.shade_depth_m > 0.0]
        if not shaded or not sky.any():
            return False
        places = [(r.low_m, r.high_m, r.level_m, r.limits_m, r.shade_depth_m, r.n[1]) for r in regions]
        if geometry is not self._geometry or places != self._places:
            self._met = [self._send(region) for region in regions]
            self._geometry, self._places, self._shares = geometry, places, ()
            self.ray_runs += 1
        shares = (albedo.tobytes(), sky, rotation)
        if self._shares and shares[0] == self._shares[0] and sky is self._shares[1] and rotation == self._shares[2]:
            return False
        self._shares = shares
        material = geometry.triangles["material"]
        packed = [
            pack(open_shares(met, albedo[material], *sky_weights(region.n[1], sky, rotation)))
            for met, region in zip(self._met, regions, strict=True)
        ]
        self._store(np.concatenate(packed))
        return True

    def _store(self, packed: np.ndarray) -> None:
        buffer = self._resources["submerged_open"]
        if buffer.size == packed.nbytes:
            self.device.write(buffer, packed)
        else:
            self._resources["submerged_open"] = self.device.buffer(packed, "storage", "open sky")

    def _send(self, region: WaterRegion) -> np.ndarray:
        """(Z, Y, X, RAYS) uint32: 0 where a ray comes to the sky, else the triangle counted from 1, and its side."""
        count = int(np.prod(OPEN_SIZE))
        if region.shade_depth_m <= 0.0:
            return np.zeros((*OPEN_SIZE[::-1], RAYS), np.uint32)
        if self._buffers is None:
            ways = np.zeros((RAYS, 4), np.float32)
            ways[:, :3] = sky_directions()
            self._buffers = (
                self.device.buffer(ways, "storage", "ways to the sky"),
                self.device.buffer(4 * count * RAYS, label="met on the way to the sky"),
                self.device.buffer(OpenSky.itemsize, "uniform", "open sky"),
            )
        ways_buffer, met, params_buffer = self._buffers
        top = region.level_m + region.limits_m[1]
        params = np.zeros((), OpenSky)
        params["low"] = region.low_m[0], top - region.shade_depth_m, region.low_m[1]
        params["high"] = region.high_m[0], top, region.high_m[1]
        params["level"], params["index"] = region.level_m, region.n[1]
        self.device.write(params_buffer, params.reshape(1))
        key = "open sky"
        if key not in self.device.cache:
            self.device.cache[key] = ComputeKernel(self.device, "surroundings/shaders/open_sky")
        own = {"open_sky": params_buffer, "open_ways": ways_buffer, "open_met": met}
        self.device.cache[key].run((-(-count // ROW), RAYS, 1), {**self._resources, **own})
        return self.device.read(met, np.uint32, count * RAYS).reshape(RAYS, *OPEN_SIZE[::-1]).transpose(1, 2, 3, 0)


def sky_directions() -> np.ndarray:
    """(RAYS, 3) unit, upward in air, of equal flux through a level surface under an even sky: a spiral."""
    k = np.arange(RAYS) + 0.5
    turn, sine = k * np.pi * (3.0 - np.sqrt(5.0)), np.sqrt(k / RAYS)
    return np.stack([sine * np.cos(turn), np.sqrt(1.0 - sine**2), sine * np.sin(turn)], axis=1)


def sky_weights(n: float, sky: np.ndarray, rotation: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """(RAYS,) flux that comes along each direction, and (RAYS, 5) irradiance by it on surfaces that face the axes."""
    above = sky_directions()
    c, s = rotation
    x, z = c * above[:, 0] - s * above[:, 2], s * above[:, 0] + c * above[:, 2]
    rows, columns = sky.shape[:2]
    row = np.minimum((np.arccos(above[:, 1]) / np.pi * rows).astype(int), rows - 1)
    column = ((0.5 + np.arctan2(x, -z) / (2.0 * np.pi)) * columns).astype(int) % columns
    flux = sky[row, column].mean(axis=1) * (1.0 - fresnel_dielectric(above[:, 1], 1.0, n))
    inside = above * (1.0 / n, 1.0, 1.0 / n)
    inside[:, 1] = np.sqrt(np.maximum(1.0 - (inside[:, [0, 2]] ** 2).sum(axis=1), 1e-4))
    return flux, flux[:, None] * np.maximum(inside @ AXES.T, 0.0) / inside[:, 1:2]


def open_shares(met: np.ndarray, albedo: np.ndarray, flux: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(Z, Y, X, 8): the share of the sky's light on each of `AXES` that is left, and the albedo of what hides the rest.

    Places within matter take what places round them have.

    Parameters
    ----------
    met : (Z, Y, X, RAYS) as `OpenSkyMaps` finds. albedo : (T, 3) of each triangle. flux, weights : of `sky_weights`.
    """
    seen = met == 0
    backs = (met & BACK) != 0
    out = np.zeros((*met.shape[:3], 8), np.float32)
    out[..., :5] = (seen @ weights) / np.maximum(weights.sum(axis=0), 1e-12)
    hidden = np.where(seen, 0.0, flux)
    triangle = np.maximum((met & ~BACK).astype(np.int64) - 1, 0)
    total = hidden.sum(axis=-1)
    thrown = (albedo[triangle] * hidden[..., None]).sum(axis=-2)
    out[..., 5:] = np.where(total[..., None] > 0.0, thrown / np.maximum(total, 1e-12)[..., None], 0.0)
    mean = thrown.sum(axis=(0, 1, 2)) / max(float(total.sum()), 1e-12)
    out[..., 5:] = np.where((total > 0.0)[..., None], out[..., 5:], mean)
    return filled(out, backs.mean(axis=-1) <= INSIDE)


def filled(values: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Values (Z, Y, X, C); places that are not valid get the mean of the smallest block round them that has any."""
    weight = valid[..., None].astype(np.float32)
    if valid.all() or not valid.any():
        return values
    coarse, share = _halved(values * weight), _halved(weight)
    below = filled(coarse / np.maximum(share, 1e-12), share[..., 0] > 0.0)
    for axis, size in enumerate(values.shape[:3]):
        below = np.repeat(below, 2, axis=axis).take(np.arange(size), axis=axis)
    return np.asarray(np.where(valid[..., None], values, below), np.float32)


def _halved(values: np.ndarray) -> np.ndarray:
    for axis in range(3):
        odd = values.shape[axis] % 2
        padded = np.pad(values, [(0, odd if k == axis else 0) for k in range(4)])
        even = [slice(None)] * 4
        even[axis] = slice(0, None, 2)
        other = [slice(None)] * 4
        other[axis] = slice(1, None, 2)
        values = padded[tuple(even)] + padded[tuple(other)]
    return values


def pack(shares: np.ndarray) -> np.ndarray:
    """(N, 4) uint32, two half floats each."""
    return np.ascontiguousarray(shares.reshape(-1, 8).astype(np.float16)).view(np.uint32)
