"""The passes of the eikonal view renderer: volumes prepared once, then one full-screen draw a wavelength channel.

A dispersive volume is drawn three times, each time with the index of one channel and with the other channels masked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Device, RenderPass
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.techniques.eikonal.layouts import VolumeParams
from pellucid.techniques.eikonal.prepare import Prepared, prepare
from pellucid.techniques.eikonal.resources import VolumeTextures, parameters, upload

if TYPE_CHECKING:
    from pellucid.scene import Camera, RefractiveVolume
    from pellucid.surroundings import Surroundings

ALL_CHANNELS = 7


@dataclass
class _Resident:
    """A volume on the device. `source` keeps the identity alive that it is found by."""

    source: Any
    prepared: Prepared
    textures: VolumeTextures
    uniforms: list[Any]


class EikonalTechnique:
    """Draws `RefractiveVolume` objects."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._residents: dict[Any, _Resident] = {}
        self._drawn: dict[int, tuple[_Resident, Any]] = {}
        self._pipelines: dict[Any, RenderPass] = {}
        self._blank = (
            device.texture(size=(1, 1), format=COLOR_FORMAT, usage=("sample", "copy")),
            device.texture(size=(1, 1), format=DEPTH_FORMAT, usage=("sample", "render")),
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
        return _Resident(item.volume, prepared, textures, uniforms)

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
        screen = item.surroundings == "screen"
        color, depth = targets.copies(encoder) if screen else self._blank
        count = len(resident.uniforms)
        # The middle wavelength goes last and is the one that writes depth.
        for channel in (0, 2, 1) if count == 3 else (0,):
            mask = 1 << channel if count == 3 else ALL_CHANNELS
            last = count == 1 or channel == 1
            has_surface = resident.prepared.sharp or np.isfinite(resident.prepared.boundary_on_per_m)
            self._pipeline(item, resident.prepared, mask, last and has_surface).run(
                encoder,
                color=[targets.color_view],
                depth=targets.depth_view,
                bindings={
                    **surroundings.bindings,
                    **resident.textures.channels[channel],
                    "volume": resident.uniforms[channel],
                    "screen_color": color,
                    "screen_depth": depth,
                },
                scissor=scissor,
                timer=timer,
                label="eikonal",
            )

    def _pipeline(self, item: RefractiveVolume, prepared: Prepared, mask: int, depth_write: bool) -> RenderPass:
        constants = {
            "EULER": float(item.quality.method == "euler"),
            "ADAPTIVE": float(item.quality.adaptive),
            "SCREEN_SPACE": float(item.surroundings == "screen"),
        }
        if prepared.sharp:
            constants["GRADED"] = float(prepared.graded)
        key = (prepared.sharp, mask, depth_write, *constants.items())
        if key not in self._pipelines:
            name = "view_sharp" if prepared.sharp else "view_smooth"
            self._pipelines[key] = RenderPass(
                self.device,
                f"techniques/eikonal/shaders/{name}",
                targets=[COLOR_FORMAT],
                depth=DEPTH_FORMAT,
                depth_write=depth_write,
                write_mask=mask,
                constants=constants,
                nearest=("screen_color",),
            )
        return self._pipelines[key]


def _key(item: RefractiveVolume, number: int) -> Any:
    return (
        number, id(item.volume), item.boundary, item.smoothing_voxels, item.gradient, item.quality.method, item.dispersion
    )  # fmt: skip


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
