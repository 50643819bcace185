"""Light of lamps that comes through the surface of water: shadows, and caustics on what lies below.

For each body of water and each such lamp one map lies on the level, under a camera parallel to the light
[mihalik2008, 8]. First the meshes are drawn from there, below the surface and above it. Then a photon for each cell of
the surface is refracted and followed to the first mesh, and what it carries is summed where the camera sees it land.
Photons of lamps nearby are followed by rays instead (`near_lamps`, caustic_near.wgsl).
All is kept until the lamp, the meshes, the water or its waves change; meshes are not drawn again for waves alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import ComputeKernel, Pipelines
from pellucid.gpu.layout import offset_of
from pellucid.scene import DirectionalLight
from pellucid.scene.water_outline import PART
from pellucid.surroundings.layouts import MAX_WATER_LIGHTS
from pellucid.surroundings.submersion import DEPTH_FORMAT, WaterRegion, refracted_slope
from pellucid.techniques.water.lamp_parts import lamp_in_parts, lifted, towards
from pellucid.techniques.water.layouts import CausticBeam, CausticParams, WaterParams
from pellucid.techniques.water.near_lamps import is_over, near_lamp_parts, near_lamps
from pellucid.techniques.water.photons import Tracer

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.scene.water_quality import WaterQuality
    from pellucid.surroundings import Surroundings

SHADERS = "techniques/water/shaders/"
ROW = 64  # cells of a workgroup, in a row as in memory
DEPTH_SIZE = 1024  # texels a side of what the camera along a light sees
SLICES = 8  # of the water, for beams in it; photons to one texel of them along a side:
SLICE_CELLS = 2
OPEN_M = 10.0  # depth of water that nothing lies in, for what waves focus there


@dataclass
class Lamp:
    """A lamp over one body of water.

    Attributes
    ----------
    params : () record of `layouts.CausticParams`, of its middle. buffer : the same on the device.
    depth_buffers : the same for the two passes of depth.
    parts : such records of the parts that send photons, together the lamp. part_buffers : the same on the device.
    """

    params: np.ndarray
    buffer: Any
    depth_buffers: list[Any] = field(default_factory=list)
    parts: list[np.ndarray] = field(default_factory=list)
    part_buffers: list[Any] = field(default_factory=list)

    @property
    def is_near(self) -> bool:
        """Whether its photons are followed by rays."""
        return bool(self.params["near"])


class WaterLight:
    """Maps of the light below all bodies of water.

    Parameters
    ----------
    device : where they are made.

    Attributes
    ----------
    photon_runs, depth_runs : how often photons were followed, and meshes drawn from a lamp.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.photon_runs = self.depth_runs = 0
        self._pipelines = Pipelines(device)
        self._lamps: dict[tuple[int, int], Lamp] = {}
        self._drawn: Any = None
        self._lit: Any = None
        self._size: tuple[int, ...] = ()
        self._above: Any = None
        self._above_view: Any = None
        self._beams: Any = None
        self._sums: Any = None
        self._slices: dict[int, Any] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held, without the maps, which belong to the surroundings."""
        if not self._size:
            return 0
        side, layers, channels = self._size
        return side**2 * channels * (CausticBeam.itemsize + 4) + 4 * layers * DEPTH_SIZE**2

    def update(self, bodies: Sequence[Any], lights: Sequence[Any], surroundings: Surroundings) -> None:
        """Bring the maps to date with bodies (`passes.Body`), lamps, and the meshes of the surroundings."""
        lamps = lamps_over_water(lights)
        regions = [region_of(body, lamps, surroundings.mesh_bounds_ws) for body in bodies]
        side = max((body.quality.caustic_size for body in bodies), default=1)
        sky = [surroundings.sky_through(region.n) for region in regions]
        anew = surroundings.submersion.set(regions, side, DEPTH_SIZE if bodies else 1, sky)
        surroundings.shade_sky()
        if not bodies:
            self._drawn = self._lit = None
            return
        for number, body in enumerate(bodies):
            if body.params["region"] != number:
                body.params["region"] = number
                # This alone: the device may know better what hangs on its waves.
                self.device.write(
                    body.bindings["water"], body.params["region"].reshape(1), offset_of(WaterParams, "region")
                )
        channels = max(channel_count(body) for body in bodies)
        if any(body.quality.god_rays for body in bodies):
            channels = max(channels, 2)  # room for the sums of slices
        anew = self._allocate(side, max(len(lamps), 1) * len(bodies), channels) or anew
        records = [
            (body, self._lamp((k, j), *caustic_params(body, region, lamp, surroundings.submersion.layer(k, j), side)))
            for k, (body, region) in enumerate(zip(bodies, regions, strict=True))
            for j, lamp in enumerate(lamps or [None])
        ]
        seen = [lamp.params.tobytes() for _, lamp in records]
        places = [(region.level_m, region.low_m, region.high_m, region.limits_m) for region in regions]
        drawn = (surroundings, surroundings.shadow_version, seen, places)
        lit = [(_waves_of(b), _choices(b.quality)) for b in bodies]
        encoder = self.device.wgpu.create_command_encoder()
        if anew or drawn != self._drawn:
            for body, lamp in records:
                if not lamp.is_near:
                    self._draw_depth(encoder, body, lamp, surroundings)
            self.depth_runs += 1
            self._drawn, self._lit = drawn, None
        again = lit != self._lit
        if again:
            for body, lamp in records:
                self._follow(encoder, body, lamp, surroundings)
            self.photon_runs += 1
            surroundings.submersion.version += 1
            self._lit = lit
        self.device.wgpu.queue.submit([encoder.finish()])
        for body, lamp in records if again else []:
            if body.quality.caustics == "cpu" and lamp.parts and not lamp.is_near:
                self.device.write_texture(
                    surroundings.submersion.light_map,
                    self.tracer(body, lamp, surroundings).light_map(),
                    layer=int(lamp.params["layer"]),
                )

    def tracer(self, body: Any, lamp: Lamp, surroundings: Surroundings) -> Tracer:
        """What follows the photons of a lamp through the surface of a body on the CPU."""
        layer, around = int(lamp.params["layer"]), surroundings.submersion
        below, above = (self.device.read_texture(t, layer)[..., 0] for t in (around.depth_map, self._above))
        iteration = body.quality.caustic_intersection == "iteration"
        return Tracer(lamp.parts, body.params, body.waves, below, above, around.light_map.width, iteration)

    def _draw_depth(self, encoder: Any, body: Any, lamp: Lamp, surroundings: Surroundings) -> None:
        options: dict[str, Any] = {"fragment": None, "targets": (), "depth": DEPTH_FORMAT, "depth_compare": "less"}
        depth = self._pipelines.draw(SHADERS + "caustic_depth", **options)
        layer = int(lamp.params["layer"])
        for above, texture in enumerate((surroundings.submersion.depth_map, self._above)):
            depth.run(
                encoder,
                depth=texture.create_view(dimension="2d", base_array_layer=layer, array_layer_count=1),
                clear_depth=1.0,
                bindings={**body.bindings, **surroundings.bindings, "caustic": lamp.depth_buffers[above]},
                vertices=3 * surroundings.triangle_count,
                label="water light depth",
            )

    def _follow(self, encoder: Any, body: Any, lamp: Lamp, surroundings: Surroundings) -> None:
        around = surroundings.submersion
        side = around.light_map.width
        bound = {
            **body.bindings,
            **surroundings.bindings,
            "caustic": lamp.buffer,
            "caustic_beams": self._beams,
            "caustic_sums": self._sums,
            "caustic_below": surroundings.bindings["submerged_depth"],
            "caustic_above": self._above_view,
            "caustic_map_out": surroundings.bindings["submerged_light"],
        }
        cells = int(lamp.params["cells"])
        groups = (-(-cells // ROW), cells, int(lamp.params["channels"]))
        encoder.clear_buffer(self._sums)
        # Beams in the water are made of the device's photons, whoever sums those of the map.
        for part in lamp.part_buffers:
            self._photons(body, lamp).run(groups, {**bound, "caustic": part}, encoder)
            self._kernel("caustic_splat").run(groups, {**bound, "caustic": part}, encoder)
        self._kernel("caustic_resolve").run((-(-side // ROW), side, 1), bound, encoder)
        first = lamp.params["layer"] == around.layer(int(body.params["region"]), 0)
        if body.quality.god_rays and first and not lamp.is_near:
            slices = self._slices_of(int(body.params["region"]), side // SLICE_CELLS)
            bound["caustic_slice_out"] = slices
            if len(lamp.parts) > 1:
                self._photons(body, lamp).run(groups, bound, encoder)
            encoder.clear_buffer(self._sums)
            groups = (-(-slices.size[0] // ROW), slices.size[1], SLICES)
            self._kernel("caustic_slice").run(groups, bound, encoder)
            self._kernel("caustic_slice_resolve").run(groups, bound, encoder)

    def _photons(self, body: Any, lamp: Lamp) -> ComputeKernel:
        if lamp.is_near:
            return self._kernel("caustic_near")
        iteration = body.quality.caustic_intersection == "iteration"
        return self._kernel("caustic_refract", {"CAUSTIC_ITERATION": float(iteration)})

    def _slices_of(self, region: int, side: int) -> Any:
        kept = self._slices.get(region)
        if kept is None or kept.size[0] != side:
            size, usage = (side, side, SLICES), ("sample", "storage", "copy")
            self._slices[region] = kept = self.device.texture(
                size=size, format="rgba16float", dimension="3d", usage=usage, label="light in slices of water"
            )
        return kept

    def bindings(self, body: Any) -> dict[str, Any]:
        """What the passes of a body read of its light, by their WGSL names."""
        region = int(body.params["region"])
        slices = self._slices.get(region) or self._slices_of(region, 1)
        return {"caustic_slices": slices, "caustic_slice_sampler": self.device.sampler("linear", "clamp")}

    def _kernel(self, name: str, constants: dict[str, float] | None = None) -> ComputeKernel:
        return self._pipelines.kernel(SHADERS + name, constants)

    def _lamp(self, key: tuple[int, int], params: np.ndarray, parts: list[np.ndarray]) -> Lamp:
        if key not in self._lamps:
            buffers = [self.device.buffer(CausticParams.itemsize, "uniform", "caustic") for _ in range(3)]
            self._lamps[key] = Lamp(np.zeros((), CausticParams), buffers[0], buffers[1:])
        lamp = self._lamps[key]
        if lamp.params.tobytes() != params.tobytes():
            lamp.params = params
            self.device.write(lamp.buffer, params.reshape(1))
            for above, buffer in enumerate(lamp.depth_buffers):
                record = params.copy()
                record["above"] = above
                self.device.write(buffer, record.reshape(1))
        if [part.tobytes() for part in lamp.parts] != [part.tobytes() for part in parts]:
            while len(lamp.part_buffers) < len(parts):
                lamp.part_buffers.append(self.device.buffer(CausticParams.itemsize, "uniform", "part of a lamp"))
            del lamp.part_buffers[len(parts) :]
            for buffer, part in zip(lamp.part_buffers, parts, strict=True):
                self.device.write(buffer, part.reshape(1))
            lamp.parts = parts
        return lamp

    def _allocate(self, side: int, layers: int, channels: int) -> bool:
        if self._size == (side, layers, channels):
            return False
        cells = side**2 * channels
        self._beams = self.device.buffer(CausticBeam.itemsize * cells, label="caustic beams")
        self._sums = self.device.buffer(np.zeros(cells, np.uint32), label="caustic sums")
        self._above = self.device.texture(
            size=(DEPTH_SIZE, DEPTH_SIZE), format=DEPTH_FORMAT, layers=layers, usage=("sample", "render"), label="above"
        )
        self._above_view = self._above.create_view(dimension="2d-array")
        self._size = side, layers, channels
        return True


def far_lamps(lights: Sequence[Any]) -> list[DirectionalLight]:
    """Those whose light comes from above and far away, as many as have maps; in the order of `Light.water_layer`."""
    high = [lamp for lamp in lights if isinstance(lamp, DirectionalLight) and towards(lamp)[1] > 0.0]
    return high[:MAX_WATER_LIGHTS]


def lamps_over_water(lights: Sequence[Any]) -> list[Any]:
    """Those that have maps, in the order of `Light.water_layer`: lamps far away first."""
    return [*far_lamps(lights), *near_lamps(lights)][:MAX_WATER_LIGHTS]


def shines_in(lamp: Any, body: Any) -> bool:
    """Whether a lamp nearby has photons in a body of water: where that has caustics, and is below it."""
    top = float(body.params["level"] + body.params["wave_high"])
    return body.quality.caustics != "none" and is_over(lamp, top)


def channel_count(body: Any) -> int:
    """How many colours of a body of water are refracted apart."""
    n = body.params["n_water"]
    return 1 if n[0] == n[1] == n[2] else 3


def region_of(body: Any, lamps: Sequence[Any], mesh_bounds: Sequence[tuple[np.ndarray, np.ndarray]]) -> WaterRegion:
    """What stands for a body of water where surfaces are lit.

    Parameters
    ----------
    body : of `passes.Body`. lamps : of `lamps_over_water`. mesh_bounds : lower and upper corner of each mesh, metres.
    """
    p, quality = body.params, body.quality
    n = tuple(float(v) for v in p["n_water"] / p["n_outside"])
    top = float(p["level"] + p["wave_high"])
    lowest = min((float(low[1]) for low, _ in mesh_bounds), default=top)
    # A little deeper than the lowest mesh, whose depth would else be that of nothing.
    reach = 1.01 * (top - lowest) if lowest < top else OPEN_M
    # What has the index of air is lit as air is, where nothing hides the sky.
    hides_sky = quality.shadows and n != (1.0, 1.0, 1.0)
    thesis = quality.color == "mihalik"
    absorption = np.full(3, p["clarity"]) if thesis else p["absorption"]
    scattering = np.zeros(3) if thesis else p["scattering"]
    return WaterRegion(
        level_m=float(p["level"]),
        low_m=_pair(p["low"]),
        high_m=_pair(p["high"]),
        limits_m=(float(p["wave_low"]), float(p["wave_high"])),
        n=(n[0], n[1], n[2]),
        absorption_per_m=_three(absorption),
        scattering_per_m=_three(scattering),
        asymmetry=float(p["asymmetry"]),
        shape=body.item.shape if body.item.shape.kind != PART else None,
        reach_m=max(reach, 1e-3),
        slopes=tuple(camera_slope(lamp, n[1], quality) for lamp in lamps),
        shadows=tuple(quality.shadows and lamp.cast_shadow for lamp in lamps),
        along=quality.caustic_camera == "refracted" and n[1] >= 1.0,
        near=tuple(shines_in(lamp, body) for lamp in lamps),
        shade_depth_m=shaded_depth(mesh_bounds, p["low"], p["high"], top) if hides_sky else 0.0,
    )


def shaded_depth(
    mesh_bounds: Sequence[tuple[np.ndarray, np.ndarray]], low: np.ndarray, high: np.ndarray, top: float
) -> float:
    """From the highest wave to the lowest point of meshes in the rectangle of a water, metres; 0 without any."""
    over = [b for b in mesh_bounds if (b[0][[0, 2]] < high).all() and (b[1][[0, 2]] > low).all()]
    return max((top - float(b[0][1]) for b in over), default=0.0) * (1.0 + 1e-3)


def camera_slope(lamp: Any, n: float, quality: WaterQuality) -> tuple[float, float]:
    """Horizontal way over depth, (x, z), of the camera of a map: along the refracted light, or the incident."""
    if not isinstance(lamp, DirectionalLight):
        return 0.0, 0.0
    return refracted_slope(lifted(towards(lamp)), n if quality.caustic_camera == "refracted" else 1.0)


def caustic_params(
    body: Any, region: WaterRegion, lamp: Any, layer: int, side: int
) -> tuple[np.ndarray, list[np.ndarray]]:
    """() record of `layouts.CausticParams` for the middle of a lamp, and those of its parts.

    Without a lamp, or one over the water, there are no parts, and only heights are asked of the record.
    """
    p = np.zeros((), CausticParams)
    to_light = lifted(towards(lamp)) if isinstance(lamp, DirectionalLight) else np.array([0.0, 1.0, 0.0])
    p["cells"] = side
    p["to_light"], p["layer"], p["index"], p["reach_m"] = to_light, layer, region.n, region.reach_m
    p["slope"] = camera_slope(lamp, region.n[1], body.quality) if lamp is not None else 0.0
    p["slope_above"] = to_light[[0, 2]] / to_light[1]
    p["focus"] = body.quality.caustics != "none"
    p["loss"], p["channels"], p["steps"] = 1.0, channel_count(body), body.quality.steps
    # Higher things still hide the lamp: depths there are cut off, not left out.
    p["reach_above_m"] = 1e4
    p["share"] = 1.0
    if lamp is None:
        return p, []
    p["shadows"] = body.quality.shadows and lamp.cast_shadow
    if not isinstance(lamp, DirectionalLight):
        return p, near_lamp_parts(p, lamp, region) if shines_in(lamp, body) else []
    texel_m = (np.asarray(region.high_m) - region.low_m) / side
    return p, lamp_in_parts(p, lamp, texel_m)


def _waves_of(body: Any) -> tuple[Any, ...]:
    """What of its waves maps depend on: nothing where light comes through level water."""
    return () if body.quality.caustics == "none" else (body.version, body.time_s, body.item.waves)


def _choices(quality: WaterQuality) -> tuple[Any, ...]:
    return quality.caustics, quality.caustic_intersection, quality.caustic_size, quality.god_rays


def _pair(values: np.ndarray) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _three(values: np.ndarray) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])
