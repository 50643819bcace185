"""The passes of the eikonal view renderer: volumes prepared once, then rays for the pixels that they cover.

A dispersive volume is looked through three times, each time with the index of one channel and for that channel only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import ComputeKernel, Device, RenderPass
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.techniques.eikonal.layouts import DrawParams, VolumeParams
from pellucid.techniques.eikonal.prepare import Prepared, prepare
from pellucid.techniques.eikonal.resources import VolumeTextures, parameters, upload

if TYPE_CHECKING:
    from pellucid.scene import Camera, RefractiveVolume
    from pellucid.surroundings import Surroundings

EVERY_CHANNEL = 3


@dataclass
class _Resident:
    """A volume on the device. `source` keeps the identity alive that it is found by."""

    source: Any
    prepared: Prepared
    textures: VolumeTextures
    uniforms: list[Any]
    draws: list[Any]  # one for each channel, the last for all at once


class EikonalTechnique:
    """Draws `RefractiveVolume` objects."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._residents: dict[Any, _Resident] = {}
        self._drawn: dict[int, tuple[_Resident, Any]] = {}
        self._kernels: dict[Any, ComputeKernel] = {}
        self._scratch: Any = None
        self._composite = RenderPass(
            device,
            "techniques/eikonal/shaders/composite",
            targets=[COLOR_FORMAT],
            depth=DEPTH_FORMAT,
            depth_compare="always",
        )

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held by volumes."""
        return sum(r.textures.nbytes for r in self._residents.values())

    def prepare(self, objects: Sequence[RefractiveVolume], surroundings: Surroundings) -> None:
        """Make every volume resident, drop those that are gone, and write the parameters of each object."""
        wanted = {_key(o, n): o for n, o in enumerate(objects)}
        for key in [k for k in self._residents if k not in wanted]:
            del self._residents[key]
        self._drawn = {}
        for key, item in wanted.items():
            if key not in self._residents:
                self._residents[key] = self._load(item)
            resident = self._residents[key]
            self._write_parameters(item, resident, surroundings)
            self._drawn[id(item)] = (resident, item)

    def _load(self, item: RefractiveVolume) -> _Resident:
        prepared = prepare(
            item.volume, item.boundary, item.smoothing_voxels, item.gradient, item.quality.method, item.dispersion
        )
        textures = upload(self.device, prepared)
        uniforms = [self.device.buffer(VolumeParams.itemsize, "uniform", "volume") for _ in prepared.channels]
        draws = [self.device.buffer(DrawParams.itemsize, "uniform", "draw") for _ in range(EVERY_CHANNEL + 1)]
        return _Resident(item.volume, prepared, textures, uniforms, draws)

    def _write_parameters(self, item: RefractiveVolume, resident: _Resident, surroundings: Surroundings) -> None:
        world = item.object_to_world()
        scale = float(np.cbrt(np.linalg.det(world[:3, :3])))
        corners = _corners(resident.prepared) @ world[:3, :3].T + world[:3, 3]
        low, high = corners.min(axis=0), corners.max(axis=0)
        meets = any((lo <= high).all() and (hi >= low).all() for lo, hi in surroundings.mesh_bounds_ws)
        for channel, uniform in enumerate(resident.uniforms):
            record = parameters(
                resident.prepared, resident.textures, channel, item.quality, world, scale, meets_meshes=meets
            )
            self.device.write(uniform, record.reshape(1))

    def draw(
        self,
        encoder: Any,
        item: RefractiveVolume,
        targets: Targets,
        camera: Camera,
        surroundings: Surroundings,
        timer: Any = None,
    ) -> None:
        """Encode the draws of one volume over what is in the targets."""
        resident, _ = self._drawn[id(item)]
        scissor = _screen_rectangle(resident.prepared, item, camera, targets.size)
        if scissor is None:
            return
        x, y, width, height = scissor
        rows = self._pixels(width * height)
        count = len(resident.uniforms)
        kernel = self._kernel(item, resident.prepared)
        # Red goes first and starts each pixel anew; without dispersion one draw serves every channel.
        for channel in (0, 1, 2) if count == 3 else (EVERY_CHANNEL,):
            own = channel % EVERY_CHANNEL
            self._write_draw(resident.draws[channel], channel, scissor)
            kernel.run(
                (-(-width // 8), -(-height // 8), 1),
                {
                    **surroundings.bindings,
                    **resident.textures.channels[own],
                    "volume": resident.uniforms[own],
                    "screen_color": targets.color,
                    "screen_depth": targets.depth,
                    "draw": resident.draws[channel],
                    "drawn": rows,
                },
                encoder,
                timer,
                "eikonal",
            )
        self._composite.run(
            encoder,
            color=[targets.color_view],
            depth=targets.depth_view,
            bindings={"draw": resident.draws[channel], "drawn": rows},
            scissor=(x, y, width, height),
            timer=timer,
            label="eikonal composite",
        )

    def _pixels(self, count: int) -> Any:
        """Storage for what `count` pixels see; it only grows."""
        if self._scratch is None or self._scratch.size < 16 * count:
            self._scratch = self.device.buffer(16 * count, "storage", "eikonal pixels")
        return self._scratch

    def _write_draw(self, buffer: Any, channel: int, scissor: tuple[int, int, int, int]) -> None:
        record = np.zeros((), DrawParams)
        record["corner"], record["size"], record["channel"] = scissor[:2], scissor[2:], channel
        self.device.write(buffer, record.reshape(1))

    def _kernel(self, item: RefractiveVolume, prepared: Prepared) -> ComputeKernel:
        constants = {
            "EULER": float(item.quality.method == "euler"),
            "ADAPTIVE": float(item.quality.adaptive),
            "SCREEN_SPACE": float(item.surroundings == "screen"),
        }
        if prepared.sharp:
            constants["GRADED"] = float(prepared.graded)
        key = (prepared.sharp, *constants.items())
        if key not in self._kernels:
            name = f"techniques/eikonal/shaders/{'view_sharp' if prepared.sharp else 'view_smooth'}"
            self._kernels[key] = ComputeKernel(self.device, name, constants=constants, nearest=("screen_color",))
        return self._kernels[key]


def _key(item: RefractiveVolume, number: int) -> Any:
    return (
        *(number, id(item.volume), item.boundary, item.smoothing_voxels, item.gradient),
        *(item.quality.method, item.dispersion),
    )


def _corners(prepared: Prepared) -> np.ndarray:
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return signs * (0.5 * np.array(prepared.extent_m) + 2.0 * prepared.voxel)


def _screen_rectangle(
    prepared: Prepared, item: RefractiveVolume, camera: Camera, size: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """The pixels that a volume's box can cover: (x, y, width, height), or None when it is out of the picture."""
    clip = camera.projection_matrix(size) @ camera.view_matrix() @ item.object_to_world()
    corners = np.concatenate([_corners(prepared), np.ones((8, 1))], axis=1) @ clip.T
    width, height = size
    if (corners[:, 3] <= 1e-6).any():
        return (0, 0, width, height) if (corners[:, 3] > 1e-6).any() else None
    ndc = corners[:, :2] / corners[:, 3:]
    pixels = (ndc * (0.5, -0.5) + 0.5) * (width, height)
    low = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, (width, height)).astype(int)
    high = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, (width, height)).astype(int)
    if (high <= low).any():
        return None
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])
