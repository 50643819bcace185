"""Ripples that the device steps and makes its maps of waves from, without a way back to the CPU."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.waves import Ripples, WaveSurface
from pellucid.gpu import Pipelines
from pellucid.gpu.layout import offset_of
from pellucid.simulation import RippleSimulation
from pellucid.techniques.water.layouts import RippleMap, WaterParams
from pellucid.techniques.water.prepare import WaveMaps, sources_of
from pellucid.techniques.water.views import needs_pictures

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.scene.water import Water
    from pellucid.scene.water_quality import WaterQuality

SHADERS = "techniques/water/shaders/ripple_"
NEAREST = ("ripple_heights", "finer_mean", "finer_square")
ROW = 64  # texels of a workgroup
LIMITS = ("wave_slope", "trough", "crest")  # of `WaterParams`, one after the other


def ripples_for_device(device: Device, item: Water, quality: WaterQuality) -> int | None:
    """Number of the layer of ripples that the device can work out by itself; None where NumPy has to.

    Cameras of pictures are placed by the slopes of the moment, and photons on the CPU need its heights.
    """
    if not device.float32_filterable or needs_pictures(quality) or quality.caustics == "cpu":
        return None
    sources = sources_of(item.waves)
    layers = [n for n, source in enumerate(sources) if isinstance(source, Ripples)]
    # Layers on coarser grids than another are interpolated.
    shape = tuple(max((s.shape[axis] for s in sources), default=0) for axis in (0, 1))
    if len(layers) != 1 or sources[layers[0]].shape != shape or sources[layers[0]].dtype != np.float32:
        return None
    return layers[0]


class RippleMaps:
    """Writes one layer of the maps of a body of water, and the parameters that hang on it.

    Parameters
    ----------
    ripples : what is simulated. layer : which of the layers of waves it is.
    """

    def __init__(self, device: Device, ripples: Ripples, layer: int) -> None:
        self.device, self.layer = device, layer
        self.simulation = RippleSimulation(device, ripples)
        self._pipelines = Pipelines(device, NEAREST)
        self._params = device.buffer(RippleMap.itemsize, "uniform", "ripple map")
        self._extremes = device.buffer(16, label="ripple extremes")
        self._limits = device.buffer(16, label="ripple limits")
        self._calm = np.zeros(ripples.shape, np.float32), np.zeros((*ripples.shape, 2), np.float32)
        self._moment: tuple[Any, WaveSurface] | None = None
        self._others = 0.0, 0.0, 0.0  # steepest slope, trough and crest of the other layers
        self._texels: Any = None
        self._levels: list[tuple[tuple[int, int], Any, Any]] = []

    @property
    def nbytes(self) -> int:
        """Bytes of the states of the simulation and of its heights."""
        rows, columns = self.simulation.ripples.shape
        return 5 * 4 * rows * columns

    def surface(self, time_s: float) -> WaveSurface:
        """Calm water that stands for the ripples on the CPU; the same object as long as they do not change."""
        key = self.simulation.ripples.moment(time_s)
        if self._moment is None or self._moment[0] != key:
            self._moment = key, WaveSurface(*self._calm)
        return self._moment[1]

    def use(self, texels: Any, moments: Any) -> None:
        """Have the textures to write: ``wave_texture`` and ``moments_texture`` of a body."""
        one = {"dimension": "2d", "array_layer_count": 1, "mip_level_count": 1}
        self._texels = texels.create_view(base_array_layer=self.layer, **one)
        self._levels = [
            (
                (max(1, moments.width >> mip), max(1, moments.height >> mip)),
                *(moments.create_view(base_array_layer=2 * self.layer + k, base_mip_level=mip, **one) for k in (0, 1)),
            )
            for mip in range(moments.mip_level_count)
        ]

    def among(self, waves: WaveMaps) -> WaveMaps:
        """Waves of all layers, of which the CPU knows this one only as calm: heights may be anywhere within limits."""
        self._others = waves.slope, *waves.range_m
        ranges = zip(waves.range_m, self.simulation.ripples.limits_m, strict=True)
        low, high = (own + limit for own, limit in ranges)
        return replace(waves, range_m=(low, high))

    def run(self, water: Any, time_s: float, moved: bool) -> None:
        """After all that the CPU wrote: the layer, if it moved, and what hangs on it in the parameters of a body.

        Parameters
        ----------
        water : buffer of `WaterParams`.
        """
        encoder = self.device.wgpu.create_command_encoder()
        if moved:
            self._advance(time_s, encoder)
        encoder.copy_buffer_to_buffer(self._limits, 0, water, offset_of(WaterParams, LIMITS[0]), 4 * len(LIMITS))
        self.device.wgpu.queue.submit([encoder.finish()])

    def _advance(self, time_s: float, encoder: Any) -> None:
        ripples = self.simulation.ripples
        params = np.zeros((), RippleMap)
        params["cell_m"], params["repeats"], params["others"] = ripples.cell, ripples.periodic, self._others
        self.device.write(self._params, params.reshape(1))
        heights = self.simulation.advance(time_s, encoder)
        encoder.clear_buffer(self._extremes)
        own = {"ripple_map": self._params, "ripple_heights": heights, "ripple_extremes": self._extremes}
        rows, columns = ripples.shape
        self._run("texels", (columns, rows), {**own, "ripple_texels_out": self._texels}, encoder)
        self._run("limits", (1, 1), {**own, "ripple_limits": self._limits}, encoder)
        mean = square = self._texels
        for size, next_mean, next_square in self._levels:
            given = {
                "finer_mean": mean, "finer_square": square, "mean_out": next_mean, "square_out": next_square
            }  # fmt: skip
            self._run("moments", size, given, encoder, FROM_TEXELS=float(mean is self._texels))
            mean, square = next_mean, next_square

    def _run(self, name: str, size: tuple[int, int], given: dict[str, Any], encoder: Any, **constants: float) -> None:
        self._pipelines.kernel(SHADERS + name, constants).run((-(-size[0] // ROW), size[1], 1), given, encoder)
