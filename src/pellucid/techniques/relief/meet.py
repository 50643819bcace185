"""Rays of the caller through the searches that draw reliefs: arrays in, arrays out."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.fields.heightfield import ABSENT_M, bounds_pyramid
from pellucid.gpu import ComputeKernel, Device
from pellucid.scene.relief_quality import SEARCHES, ReliefQuality
from pellucid.techniques.relief.layouts import NEAREST, ReliefAsked, ReliefParams
from pellucid.techniques.relief.reference import ReliefRays
from pellucid.techniques.relief.search_maps import drawable_heights, search_bindings, upload

Array = npt.NDArray[Any]

LOOKS_FOR = ("first", "solid", "leave")


class ReliefMeeting:
    """Two height fields on a device, and one of the searches.

    Parameters
    ----------
    solid, translucent : (H, W) metres; no second layer when None.
    quality : its search, and the numbers of steps.
    tile_m : metres a tile along u and v.
    looks_for : ``"first"`` of both layers from outside, ``"solid"`` alone, or ``"leave"`` the translucent matter.
    """

    def __init__(
        self,
        device: Device,
        solid: Array,
        translucent: Array | None,
        quality: ReliefQuality,
        tile_m: tuple[float, float],
        tiling: bool = True,
        looks_for: str = "first",
    ) -> None:
        self.device = device
        two = translucent is not None
        upper = solid - ABSENT_M if translucent is None else translucent
        self.heights = drawable_heights(device, np.stack([solid, upper], axis=-1))
        self.quality, self.tile_m, self.tiling = quality, tile_m, tiling
        self.bindings = self._bindings(two)
        constants = {
            "TWO_LAYERS": float(two),
            "RELIEF_SEARCH": float(SEARCHES.index(quality.search)),
            "RELIEF_LOOKS_FOR": float(LOOKS_FOR.index(looks_for)),
        }
        module = "techniques/relief/shaders/meet"
        self.kernel = ComputeKernel(device, module, constants=constants, nearest=NEAREST)

    def __call__(self, rays: ReliefRays, reach: npt.ArrayLike) -> tuple[Array, Array]:
        """t (N,), inf where nothing is met, and layer (N,): 0 none, 1 translucent, 2 solid."""
        asked = np.zeros(len(rays), ReliefAsked)
        for name in ("uv", "duv", "h", "dh", "bend"):
            asked[name] = getattr(rays, name)
        asked["reach"] = reach
        self.bindings["asked_rays"] = self.device.buffer(asked, label="asked rays")
        self.bindings["met"] = self.device.buffer(8 * len(asked), label="met")
        self.run(len(asked))
        found = self.device.read(self.bindings["met"], np.dtype([("t", "f4"), ("layer", "u4")]), len(asked))
        return np.where(found["layer"] > 0, found["t"], np.inf), found["layer"]

    def run(self, count: int) -> None:
        """Search along the first `count` rays of those that were given last."""
        groups = -(-count // 64)
        self.kernel.run((min(groups, 32768), -(-groups // 32768), 1), self.bindings)

    def _bindings(self, two_layers: bool) -> dict[str, Any]:
        device, heights, quality = self.device, self.heights, self.quality
        nothing = device.texture(size=(1, 1), format="rgba16float", label="absent")
        volume = device.texture(size=(1, 1, 1), format="r16float", dimension="3d", label="absent")
        bounds = bounds_pyramid(heights[..., 0], heights[..., 1], self.tiling)
        shape = heights.shape
        pyramid = device.texture(size=(shape[1], shape[0]), format="rgba32float", mips=len(bounds), label="bounds")
        for level, values in enumerate(bounds):
            device.write_texture(pyramid, values, mip=level)
        unused = {
            "surface_sampler": device.sampler("linear", "repeat"),
            "distance_map": volume,
            **dict.fromkeys(
                ("relief_vertices", "solid_surface", "translucent_surface", "cone_map", "complexity_map"), nothing
            ),
        }
        return {
            **unused,
            "relief": device.buffer(self._parameters(two_layers).reshape(1), "uniform", "relief"),
            "height_map": upload(device, heights, filtered=True),
            "height_sampler": device.sampler("linear", "repeat" if self.tiling else "clamp"),
            "height_bounds": pyramid,
            **search_bindings(
                device, quality.search, quality.complexity, heights, two_layers, self.tile_m, self.tiling
            ),
        }

    def _parameters(self, two_layers: bool) -> Array:
        p, quality = np.zeros((), ReliefParams), self.quality
        low, high = self.heights.min(axis=(0, 1)), self.heights.max(axis=(0, 1))
        p["texels"], p["tiling"], p["tile_m"] = self.heights.shape[1::-1], self.tiling, self.tile_m
        p["solid_low"], p["translucent_low"] = low
        p["solid_high"], p["translucent_high"] = high
        p["hull_low"], p["hull_high"] = low[0], max(high) if two_layers else high[0]
        p["linear_steps"], p["binary_steps"] = quality.linear_steps, quality.binary_steps
        p["linear_approximation"] = quality.linear_approximation
        p["refraction_linear"], p["refraction_binary"] = quality.refraction_steps
        p["adapt_angle"], p["adapt_distance"] = quality.adapt_angle, quality.adapt_distance
        p["complexity"] = quality.complexity
        return p
