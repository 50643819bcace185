"""The wavefront simulator: how much light there is all over a volume, and what leaves it [tevs2007, 4 and 6.2].

A front of patches enters the box. Work goes in generations: each takes a list of patches, follows every one to what it
meets next, leaves its track in the fluence, and writes what becomes of it to the next list. Nothing is read back.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.gpu import ComputeKernel, Device
from pellucid.scene import DirectionalLight, LightQuality
from pellucid.surroundings.layouts import OutPatch
from pellucid.techniques.eikonal.layouts import Generation, LightParams, LightPatch, LookCount
from pellucid.techniques.eikonal.light_sources import Source, sources_of
from pellucid.techniques.eikonal.prepare import Prepared
from pellucid.techniques.eikonal.proxies import whole_box
from pellucid.techniques.eikonal.resources import constants_of, scale_of
from pellucid.techniques.eikonal.wavelengths import draws_of

if TYPE_CHECKING:
    from pellucid.scene import Quality
    from pellucid.surroundings import Surroundings
    from pellucid.techniques.eikonal.passes import EikonalTechnique

GENERATIONS = 64
CAPACITY = 1 << 17  # patches in a list
OUT_CAPACITY = 3 << 16  # bundles that leave in one batch
BATCH = 1 << 14  # patches of the front that are followed at a time
# Patches that carry less of the front's largest than this are not divided; they leave a track of random points instead.
DIVIDE_ABOVE = 1.0 / 20.0
TOTALS = ("flux_in", "flux_absorbed", "flux_out", "flux_ended", "flux_lent", "flux_unsent")
TOTAL_WORDS = 40


@dataclass(frozen=True)
class Irradiance:
    """Light in a volume.

    fluence : (Z, Y, X, 3) float32, radiant power that crosses a small ball at each voxel, per area of its
        cross-section: in a parallel beam the irradiance of a surface that faces it. RGB, in the units of the lights.
    direction : (Z, Y, X, 3) float32, mean direction of travel in object space, over 2 x 2 x 2 voxels; its length,
        0 to 1, says how parallel light is.
    flux_in, flux_absorbed, flux_out, flux_ended : (3,) float64, radiant power that entered the box, was absorbed or
        scattered in it, left it, and was given up (too weak, too many bounces, lists full); they sum to nothing.
    patches : how many patches were followed.
    seconds : what it took.
    """

    fluence: np.ndarray
    direction: np.ndarray
    flux_in: np.ndarray
    flux_absorbed: np.ndarray
    flux_out: np.ndarray
    flux_ended: np.ndarray
    patches: int
    seconds: float


@dataclass
class LightField:
    """What the view looks up of the light in one volume: textures over its box."""

    fluence: Any
    direction: Any
    grid: tuple[int, int, int]

    @property
    def bindings(self) -> dict[str, Any]:
        """By their WGSL names."""
        return {"fluence_field": self.fluence, "light_field": self.direction}


class LightSimulator:
    """Follows light through volumes on one device.

    Lists and accumulators are kept for the next run.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._kernels: dict[Any, ComputeKernel] = {}
        self._buffers: dict[str, Any] = {}
        blank = np.zeros((GENERATIONS + 1) * 4 + TOTAL_WORDS, np.uint32)
        blank[1 : (GENERATIONS + 1) * 4 : 4] = blank[2 : (GENERATIONS + 1) * 4 : 4] = 1
        self._blank = device.buffer(blank, "storage", "blank counters")
        self._generations = [
            device.buffer(np.array([(g,)], Generation), "uniform", "generation") for g in range(GENERATIONS)
        ]

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        return sum(buffer.size for buffer in self._buffers.values())

    def run(
        self,
        prepared: Prepared,
        textures: Sequence[dict[str, Any]],
        uniforms: Sequence[Any],
        world: np.ndarray,
        lights: Sequence[object],
        surroundings: Surroundings,
        quality: Quality,
        light_quality: LightQuality,
        *,
        deposits: bool = True,
        meets_meshes: bool = False,
        land: Callable[[Any, Any, Any], None] | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Simulate all lights; sums are left in the accumulators for `fluence`, `totals` and `textures`.

        Parameters
        ----------
        textures, uniforms : bindings and VolumeParams of each channel.
        world : (4, 4) placement, metres.
        deposits : fluence is wanted; without, only what leaves.
        land : called with (encoder, outgoing, outgoing_queue) after every batch.
        progress : called with the share that is done.
        """
        grid = grid_of(prepared)
        box = whole_box(prepared)[1]
        scale = scale_of(world)
        sources = [s for lamp in lights for s in sources_of(lamp, world, box, prepared.voxel, light_quality)]
        sources = [s for s in sources if s.patch_flux > 0.0]
        self._reserve(grid, deposits, land is not None)
        self._grid, self._scale, self._prepared = grid, scale, prepared
        self._record = _record(prepared, grid, box, scale, sources, light_quality)
        self._clear()
        jobs = [
            (source, draw, first)
            for draw in draws_of(prepared)
            for source in sources
            if _worth(source, draw[1]) > 0.0
            for first in range(0, source.tiles, BATCH)
        ]
        for number, (source, (channel, weights), first) in enumerate(jobs):
            params = self._params(source, weights, first)
            bindings = {
                **surroundings.bindings,
                **textures[channel],
                **self._buffers,
                "volume": uniforms[channel],
                "light": self.device.buffer(params.reshape(1), "uniform", "light"),
            }
            flags = {"DEPOSITS": deposits, "OUTGOING": land is not None, "MEETS_MESHES": meets_meshes}
            self._batch(prepared, quality, light_quality, flags, bindings, surroundings, land)
            if progress is not None:
                self.device.wait()
                progress((number + 1) / len(jobs))

    def _batch(
        self,
        prepared: Prepared,
        quality: Quality,
        light_quality: LightQuality,
        flags: dict[str, bool],
        bindings: dict[str, Any],
        surroundings: Surroundings,
        land: Callable[[Any, Any, Any], None] | None,
    ) -> None:
        matter = constants_of(prepared, quality)
        constants = {
            **{k: v for k, v in matter.items() if k in ("ABSORBS", "SCATTERS", "BLOCKS")},
            **{name: float(value) for name, value in flags.items()},
            "INTENSITY": float(light_quality.method == "intensity"),
            "AMBIENT_MATTER": float(has_ambient_matter(prepared)),
            "GRADED": float(prepared.graded and prepared.sharp),
        }
        encoder = self.device.wgpu.create_command_encoder()
        counters, arguments = self._buffers["counters"], self._arguments
        lists = 16 * (GENERATIONS + 1)
        encoder.copy_buffer_to_buffer(self._blank, 0, counters, 0, lists)
        ping, pong = self._lists
        meshes = float(surroundings.triangle_count > 0)
        how = {"GRADED": constants["GRADED"], "SMOOTH": float(not prepared.sharp), "OUTGOING": 0.0}
        start = self._kernel("light_start", {**how, "HAS_MESHES": meshes})
        first = {**bindings, "patches": pong, "next_patches": ping, "generation": self._generations[0]}
        start.run((BATCH // 64, 1, 1), first, encoder)
        if prepared.graded:
            constants |= {"SMOOTH": how["SMOOTH"], "ADAPTIVE": matter["ADAPTIVE"]}
        march = self._kernel("light_curved" if prepared.graded else "light_straight", constants)
        for g in range(GENERATIONS - 1):
            encoder.copy_buffer_to_buffer(counters, 16 * (g + 1), arguments, 0, 16)
            step = {**bindings, "patches": ping, "next_patches": pong, "generation": self._generations[g]}
            march.run((0, 0, 0), step, encoder, indirect=(arguments, 0))
            ping, pong = pong, ping
        encoder.copy_buffer_to_buffer(counters, 16 * GENERATIONS, arguments, 0, 16)
        last = {**bindings, "patches": ping, "next_patches": pong, "generation": self._generations[GENERATIONS - 1]}
        self._kernel("light_end", {}).run((0, 0, 0), last, encoder, indirect=(arguments, 0))
        self._kernel("light_end", {}, "count").run((-(-GENERATIONS // 64), 1, 1), last, encoder)
        if land is not None:
            encoder.copy_buffer_to_buffer(counters, 0, self._outgoing_queue, 0, 16)
            land(encoder, self._buffers["outgoing"], self._outgoing_queue)
        self.device.wgpu.queue.submit([encoder.finish()])

    def _params(self, source: Source, weights: np.ndarray, first: int) -> np.ndarray:
        out = self._record.copy()
        out["position"], out["direction"], out["kind"] = source.position, source.direction, source.kind
        out["inside"], out["casts"] = source.inside, source.casts
        # Bundles carry what the lamp sends out: matter takes from that, and what is left is worth its weights.
        out["power"] = source.power
        out["weights"][:, :3] = weights.T  # columns
        out["patch_flux"] *= _worth(source, weights)
        out["face_count"] = len(source.faces)
        out["faces"][: len(source.faces)] = source.faces
        out["batch_first"], out["batch_count"] = first, min(BATCH, source.tiles - first)
        return out

    def _clear(self) -> None:
        encoder = self.device.wgpu.create_command_encoder()
        for name in ("counters", "fluence", "directions"):
            encoder.clear_buffer(self._buffers[name])
        self.device.wgpu.queue.submit([encoder.finish()])

    def _reserve(self, grid: tuple[int, int, int], deposits: bool, outgoing: bool) -> None:
        voxels = int(np.prod(grid)) if deposits else 1
        cells = int(np.prod(cells_of(grid))) if deposits else 1
        sizes = {
            "counters": 16 * (GENERATIONS + 1) + 4 * TOTAL_WORDS,
            "fluence": 12 * voxels,
            "directions": 16 * cells,
            "patches a": LightPatch.itemsize * CAPACITY,
            "patches b": LightPatch.itemsize * CAPACITY,
            "outgoing": OutPatch.itemsize * (OUT_CAPACITY if outgoing else 1),
        }
        for name, size in sizes.items():
            if name not in self._buffers or self._buffers[name].size < size:
                self._buffers[name] = self.device.buffer(size, "storage", name)
        if not hasattr(self, "_arguments"):
            self._arguments = self.device.buffer(LookCount.itemsize, "indirect", "arguments")
            self._outgoing_queue = self.device.buffer(LookCount.itemsize, "indirect", "outgoing queue")
        self._lists = self._buffers["patches a"], self._buffers["patches b"]

    def totals(self) -> tuple[dict[str, np.ndarray], int]:
        """Where the flux went, (3,) float64 each, and how many patches were followed; waits for the device.

        ``flux_unsent`` is the part of ``flux_out`` that found no room in the list for the surroundings.
        """
        size = (GENERATIONS + 1) * 4 + TOTAL_WORDS
        words = self.device.read(self._buffers["counters"], np.uint32, size)[-TOTAL_WORDS:]
        low, high = words[0::2].astype(np.int64), words[1::2].astype(np.int64)
        sums = (low + (high << 32)).astype(np.float64)
        per_quantum = 1.0 / float(self._record["total_quanta"])
        flux = {name: sums[3 * k : 3 * k + 3] * per_quantum for k, name in enumerate(TOTALS)}
        flux["flux_ended"] = flux["flux_ended"] - flux.pop("flux_lent")
        return flux, int(sums[3 * len(TOTALS)])

    def read(self) -> tuple[np.ndarray, np.ndarray]:
        """Fluence and mean direction, (Z, Y, X, 3) float32 each, of the last run."""
        x, y, z = self._grid
        i, j, k = cells_of(self._grid)
        sums = self.device.read(self._buffers["fluence"], np.int32, (z, y, x, 3)).astype(np.float32)
        ways = self.device.read(self._buffers["directions"], np.int32, (k, j, i, 4)).astype(np.float32)
        turn = ways[..., :3] / np.maximum(ways[..., 3:], 1.0)
        turn /= np.maximum(np.linalg.norm(turn, axis=-1, keepdims=True), 1.0)
        for axis, (cells, voxels) in enumerate(((k, z), (j, y), (i, x))):
            turn = np.take(turn, ((np.arange(voxels) + 0.5) * cells / voxels).astype(int), axis=axis)
        return sums * float(self._record["fluence_per_quantum"]), turn

    def field(self, before: LightField | None = None) -> LightField:
        """Fluence and direction of the last run as textures; those of `before` are written again if they fit."""
        grid = self._grid
        if before is None or before.grid != grid:
            made = [
                self.device.texture(
                    size=size, format="rgba16float", dimension="3d", usage=("sample", "storage"), label=label
                )
                for label, size in (("fluence", grid), ("light direction", cells_of(grid)))
            ]
            before = LightField(made[0], made[1], grid)
        record = self.device.buffer(self._record.reshape(1), "uniform", "light")
        bindings = {
            "light": record,
            "fluence": self._buffers["fluence"],
            "directions": self._buffers["directions"],
            "fluence_image": before.fluence,
            "direction_image": before.direction,
        }
        for entry, (x, y, z) in (("main", grid), ("turn", cells_of(grid))):
            self._kernel("light_resolve", {}, entry).run((-(-x // 64), y, z), bindings)
        return before

    def _kernel(self, name: str, constants: dict[str, float], entry: str = "main") -> ComputeKernel:
        key = (name, entry, *sorted(constants.items()))
        if key not in self._kernels:
            module = f"techniques/eikonal/shaders/{name}"
            self._kernels[key] = ComputeKernel(self.device, module, entry, constants)
        return self._kernels[key]


def illuminate(
    technique: EikonalTechnique,
    lights: Sequence[object],
    surroundings: Surroundings,
    progress: Callable[[float], None] | None = None,
) -> Irradiance:
    """Light in the one body of a technique. See `pellucid.illuminate`."""
    begun = time.perf_counter()
    body = technique.bodies[0]
    check_lights(body.prepared, body.world, lights)
    technique.follow_light(body, lights, surroundings, progress=progress)
    totals, patches = technique.simulator.totals()
    del totals["flux_unsent"]
    shape = body.objects[0].volume.shape
    fluence, direction = (_inner(field, shape) for field in technique.simulator.read())
    seconds = time.perf_counter() - begun
    return Irradiance(fluence, direction, **totals, patches=patches, seconds=seconds)


def _inner(field: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """Without the voxels that preparing has added on every side."""
    pads = [(have - want) // 2 for have, want in zip(field.shape[:3], shape, strict=True)]
    cut = tuple(slice(pad, pad + want) for pad, want in zip(pads, shape, strict=True))
    return np.ascontiguousarray(field[cut])


def has_ambient_matter(prepared: Prepared) -> bool:
    """Whether matter without a surface dims light."""
    return prepared.absorption is not None or prepared.scattering is not None


def _worth(source: Source, weights: np.ndarray) -> float:
    """Of the brightest channel of a lamp, how much is light of one draw."""
    return float(np.abs(weights @ source.power).max() / source.power.max())


def flux_bound(prepared: Prepared, world: np.ndarray, lights: Sequence[object], quality: LightQuality) -> float:
    """Power that the lamps shed on the box of a volume, brightest channel, if nothing is in between."""
    box = whole_box(prepared)[1]
    fronts = (s for lamp in lights for s in sources_of(lamp, world, box, prepared.voxel, quality))
    return sum(front.total_flux for front in fronts)


def check_lights(prepared: Prepared, world: np.ndarray, lights: Sequence[object]) -> None:
    """Lamps do not stand in opaque matter.

    Raises
    ------
    SceneError : names the lamp.
    """
    if prepared.opaque is None:
        return
    inverse = np.linalg.inv(world)
    half = 0.5 * np.array(prepared.extent_m)
    size = np.array(prepared.opaque.shape[2::-1])
    for number, lamp in enumerate(lights):
        if isinstance(lamp, DirectionalLight):
            continue
        position = np.array(lamp.position, dtype=np.float64)  # type: ignore[attr-defined]
        at = inverse[:3, :3] @ position + inverse[:3, 3]
        x, y, z = np.floor((at / (2.0 * half) + 0.5) * size).astype(int)
        if (np.abs(at) < half).all() and prepared.opaque[z, y, x, 3] > 0.5:
            reason = "lies inside opaque matter of a volume, which lets no light out"
            raise SceneError(f"scene.lights[{number}].position", reason, "move the lamp or the volume")


def grid_of(prepared: Prepared) -> tuple[int, int, int]:
    """Voxels (x, y, z) of the fluence: those of the volume."""
    x, y, z = (round(e / v) for e, v in zip(prepared.extent_m, prepared.voxel_m, strict=True))
    return x, y, z


def cells_of(grid: tuple[int, int, int]) -> tuple[int, int, int]:
    """Cells (x, y, z) of the direction of light: two voxels wide."""
    x, y, z = (-(-n // 2) for n in grid)
    return x, y, z


def _record(
    prepared: Prepared,
    grid: tuple[int, int, int],
    box: np.ndarray,
    scale: float,
    sources: Sequence[Source],
    quality: LightQuality,
) -> np.ndarray:
    """The parameters that all lights share. Quanta are as fine as the largest sum allows: all flux through a voxel."""
    out = np.zeros((), LightParams)
    voxel_m = np.array(prepared.voxel_m) * scale
    patch_flux = max((s.patch_flux for s in sources), default=1.0)
    total_flux = max(sum(s.total_flux for s in sources), patch_flux)
    longest = float(np.linalg.norm(voxel_m))
    out["box_half"] = box
    out["grid"], out["cells"] = grid, cells_of(grid)
    out["capacity"], out["out_capacity"] = CAPACITY, OUT_CAPACITY
    out["bounces"] = quality.bounces
    out["most_layers"] = 2 * max(grid) + 16
    out["patch_flux"] = patch_flux
    out["min_flux"] = quality.min_flux
    out["divide_above"] = DIVIDE_ABOVE
    out["split_width"] = quality.split_voxels * prepared.voxel
    out["quanta_per_flux_m"] = min(2.0**15 / (patch_flux * longest), 2.0**30 / (total_flux * longest))
    out["fluence_per_quantum"] = 1.0 / (float(out["quanta_per_flux_m"]) * float(np.prod(voxel_m)))
    # Of the intensity law: quanta of fluence for a flux through the cross-section of a voxel
    out["intensity_quanta"] = 1.0 / (float(out["fluence_per_quantum"]) * float(np.prod(voxel_m)) ** (2.0 / 3.0))
    out["total_quanta"] = 2.0**24 / patch_flux
    return out
