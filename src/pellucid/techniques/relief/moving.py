"""Heights that move, on the device: simulated or uploaded, and all the maps that are made of them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.waves import Ripples
from pellucid.gpu import ComputeKernel, Pipelines
from pellucid.simulation import RippleSimulation
from pellucid.techniques.relief.layouts import ReliefMoving

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.scene import ReliefLayer, ReliefSurface
    from pellucid.scene.relief_quality import ReliefQuality

ROW = 64  # texels of a workgroup
SHADERS = "techniques/relief/shaders/moving_"
SURFACES = ("solid_surface", "translucent_surface")  # slopes of the layers, by their WGSL names
NEAREST = ("height_map", "solid_heights", "translucent_heights", "layer_heights", "finer")


def device_moves(device: Device, item: ReliefSurface, quality: ReliefQuality) -> bool:
    """Whether all maps of heights that move can be made on the device.

    Two channels of halves cannot be written by a kernel, and horizons and maps of complexity are made in NumPy.
    """
    horizons = quality.shadows == "horizon" and item.solid.is_dynamic
    return device.float32_filterable and not (quality.complexity and quality.search == "linear") and not horizons


class MovingMaps:
    """Writes heights, bounds and slopes of one surface at a time, without a way back to the CPU.

    Parameters
    ----------
    textures : ``height_map``, ``height_bounds``, ``solid_surface``, ``translucent_surface``, all with "storage".
    others : of the same technique: what simulates the same ripples is used by all.
    """

    def __init__(
        self,
        device: Device,
        item: ReliefSurface,
        tile_m: tuple[float, float],
        textures: dict[str, Any],
        others: Sequence[MovingMaps] = (),
    ) -> None:
        self.device = device
        self._layers = [item.solid] if item.translucent is None else [item.solid, item.translucent]
        self._sources = [_source(device, layer, others) for layer in self._layers]
        self._textures = textures
        self._levels = {name: _views(textures[name]) for name in ("height_bounds", *SURFACES)}
        params = np.zeros((), ReliefMoving)
        params["tile_m"], params["tiling"] = tile_m, item.tiling
        bases = [layer.base_m if layer.is_dynamic else 0.0 for layer in self._layers]
        # Where there is no translucent layer, it lies a metre below the solid one.
        params["solid_base_m"], params["translucent_base_m"] = bases[0], bases[1] if len(bases) > 1 else bases[0] - 1.0
        self._params = device.buffer(params, "uniform", "relief heights that move")

    @property
    def simulations(self) -> list[RippleSimulation]:
        """What runs on the device."""
        return [source.simulation for source in self._sources if source.simulation is not None]

    @property
    def nbytes(self) -> int:
        """Bytes of the heights of each layer."""
        return sum(4 * source.texture.width * source.texture.height for source in self._sources)

    def advance(self, time_s: float) -> None:
        """Go to a time, and write all maps anew."""
        encoder = self.device.wgpu.create_command_encoder()
        for source in self._sources:
            source.advance(self.device, time_s, encoder)
        self._write_heights(encoder)
        for layer, source, name in zip(self._layers, self._sources, SURFACES, strict=False):
            if layer.is_dynamic and layer.normals is None:
                self._write_slopes(source.texture, self._levels[name], encoder)
        self.device.wgpu.queue.submit([encoder.finish()])

    def _write_heights(self, encoder: Any) -> None:
        solid, upper = self._sources[0].texture, self._sources[-1].texture
        heights, bounds = self._textures["height_map"], self._levels["height_bounds"]
        given = {"moving": self._params, "solid_heights": solid, "translucent_heights": upper}
        self._run("heights", heights, {**given, "height_map_out": heights}, encoder)
        given = {"moving": self._params, "height_map": heights}
        self._run("bounds", heights, {**given, "bounds_out": bounds[0][1]}, encoder)
        self._run_up("bounds", bounds, encoder)

    def _write_slopes(self, heights: Any, levels: list[tuple[tuple[int, int], Any]], encoder: Any) -> None:
        given = {"moving": self._params, "layer_heights": heights, "slopes_out": levels[0][1]}
        self._run("slopes", heights, given, encoder)
        self._run_up("slopes", levels, encoder)

    def _run_up(self, name: str, levels: list[tuple[tuple[int, int], Any]], encoder: Any) -> None:
        for (_, finer), (size, view) in pairwise(levels):
            self._kernel(f"{name}_up").run(_groups(*size), {"finer": finer, f"{name}_out": view}, encoder)

    def _run(self, name: str, over: Any, given: dict[str, Any], encoder: Any) -> None:
        self._kernel(name).run(_groups(over.width, over.height), given, encoder)

    def _kernel(self, name: str) -> ComputeKernel:
        return Pipelines(self.device, NEAREST, shared=True).kernel(SHADERS + name)


class _Source:
    """Heights of one layer: a texture, and how it comes to hold them."""

    def __init__(self, texture: Any, layer: ReliefLayer, simulation: RippleSimulation | None = None) -> None:
        self.texture, self.layer, self.simulation = texture, layer, simulation

    def advance(self, device: Device, time_s: float, encoder: Any) -> None:
        if self.simulation is not None:
            self.simulation.advance(time_s, encoder)
        elif self.layer.is_dynamic:
            heights = np.asarray(self.layer.heights.advance(time_s), np.float32)
            device.write_texture(self.texture, heights[..., None])


def _source(device: Device, layer: ReliefLayer, others: Sequence[MovingMaps]) -> _Source:
    if simulates(device, layer):
        running = [s for maps in others for s in maps.simulations if s.ripples is layer.heights]
        simulation = running[0] if running else RippleSimulation(device, layer.heights)
        return _Source(simulation.heights, layer, simulation)
    heights = np.zeros(layer.heights.shape) if layer.is_dynamic else layer.heights_m
    texture = device.texture(heights.astype(np.float32)[..., None], format="r32float", label="heights of a layer")
    return _Source(texture, layer)


def simulates(device: Device, layer: ReliefLayer) -> bool:
    """Whether the device works out how a layer moves: ripples of 32 bits, and no kind of their own.

    Where the CPU does the work of the device, NumPy takes a quarter of the time for a step.
    """
    return type(layer.heights) is Ripples and layer.heights.dtype == np.float32 and not device.is_software


def _views(texture: Any) -> list[tuple[tuple[int, int], Any]]:
    """(width, height) and view of each level."""
    return [
        (
            (max(1, texture.width >> mip), max(1, texture.height >> mip)),
            texture.create_view(base_mip_level=mip, mip_level_count=1),
        )
        for mip in range(texture.mip_level_count)
    ]


def _groups(width: int, height: int) -> tuple[int, int, int]:
    return -(-width // ROW), height, 1
