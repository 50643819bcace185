"""The wavefront simulator: how much light there is all over a volume, and what leaves it [tevs2007, 4 and 6.2].

A front of patches enters the box. Work goes in generations: each takes a list of patches, follows every one to what it
meets next, leaves its track in the fluence, and writes what becomes of it to the next list. Nothing is read back.

With several bodies, light that leaves one is handed on to the body that it meets next, and begins there again. A front
begins only where the lamp shines straight on a body: what comes through another body comes from that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import ComputeKernel, Device, Pipelines
from pellucid.scene import LightQuality
from pellucid.surroundings.layouts import OutPatch
from pellucid.techniques.eikonal.layouts import (
    MOST_OTHERS,
    Generation,
    LightPatch,
    LookCount,
    OtherBodies,
)
from pellucid.techniques.eikonal.light_params import (
    BATCH,
    CAPACITY,
    FLUENCE_BYTES,
    OUT_CAPACITY,
    batch_of,
    cells_of,
    grid_of,
    others_of,
    params_of,
    record_of,
    voxel_of,
    worth_of,
)
from pellucid.techniques.eikonal.light_sources import Source, sources_of
from pellucid.techniques.eikonal.prepare import Prepared
from pellucid.techniques.eikonal.resources import constants_of
from pellucid.techniques.eikonal.wavelengths import common_draws, draws_of

if TYPE_CHECKING:
    from pellucid.surroundings import Surroundings
    from pellucid.techniques.eikonal.bodies import Body

GENERATIONS = 64  # at most
DIVISIONS = 24  # generations beside those that bounces take: patches are divided on their way
TOTALS = ("flux_in", "flux_absorbed", "flux_out", "flux_ended", "flux_lent", "flux_unsent")
TOTAL_WORDS = 40
# Light that has gone through so many bodies in a row goes to the meshes; so many bodies light one another at all.
BODIES_IN_A_ROW = 4
MOST_BODIES = MOST_OTHERS + 1


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


@dataclass
class Lit:
    """A body that light is followed through.

    quality : how carefully. deposits : fluence is wanted; without, only what leaves.
    casts : what leaves lands on meshes.
    """

    body: Body
    quality: LightQuality
    deposits: bool = True
    casts: bool = False


@dataclass
class _Followed:
    """A body of a run: its parameters, its fronts, and what its light is summed up in."""

    lit: Lit
    grid: tuple[int, int, int]
    record: np.ndarray
    sources: list[Source]
    sums: dict[str, Any]
    others: Any


class LightSimulator:
    """Follows light through volumes on one device.

    Lists and accumulators are kept for the next run.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._pipelines = Pipelines(device)
        self._buffers: dict[str, Any] = {}
        self._sums: list[dict[str, Any]] = []
        self._followed: list[_Followed] = []
        blank = np.zeros((GENERATIONS + 1) * 4 + TOTAL_WORDS, np.uint32)
        blank[1 : (GENERATIONS + 1) * 4 : 4] = blank[2 : (GENERATIONS + 1) * 4 : 4] = 1
        self._blank = device.buffer(blank, "storage", "blank counters")
        self._generations = [
            device.buffer(np.array([(g,)], Generation), "uniform", "generation") for g in range(GENERATIONS)
        ]

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        return sum(buffer.size for buffers in (self._buffers, *self._sums) for buffer in buffers.values())

    def run(
        self,
        lit: Sequence[Lit],
        lights: Sequence[object],
        surroundings: Surroundings,
        land: Callable[[Any, Any, Any], None] | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Simulate all lights; sums are left in the accumulators for `read`, `totals` and `field`.

        Parameters
        ----------
        lit : bodies that light one another, at most `MOST_BODIES`.
        land : called with (encoder, outgoing, outgoing_queue) after every batch of a body that casts.
        progress : called with the share that is done.
        """
        several = len(lit) > 1
        self._reserve(several or any(item.casts for item in lit), several)
        fronts = [_fronts(item, self._grid(item), lights) for item in lit]
        largest = max((s.patch_flux for sources in fronts for s in sources), default=0.0)
        total = sum(s.total_flux for sources in fronts for s in sources)
        bodies = [item.body for item in lit]
        self._followed = [
            _Followed(
                item,
                self._grid(item),
                record_of(item.body, item.quality, self._grid(item), sources, largest, total),
                sources,
                self._sums_of(number, item),
                self.device.buffer(others_of(bodies, item.body).reshape(1), "uniform", "other bodies"),
            )
            for number, (item, sources) in enumerate(zip(lit, fronts, strict=True))
        ]
        self._clear()
        if several:
            draws = common_draws([item.body.prepared for item in lit])
        else:
            draws = [((channel,), weights) for channel, weights in draws_of(lit[0].body.prepared)]
        jobs = [
            (number, source, draw, first)
            for draw in draws
            for number, followed in enumerate(self._followed)
            for source in followed.sources
            if worth_of(source, draw[1]) > 0.0
            for first in range(0, source.tiles, batch_of(source))
        ]
        for done, (number, source, draw, first) in enumerate(jobs):
            self._batch(number, source, draw, first, surroundings, land)
            if progress is not None:
                self.device.wait()
                progress((done + 1) / len(jobs))

    def _batch(
        self,
        number: int,
        source: Source,
        draw: tuple[tuple[int, ...], np.ndarray],
        first: int,
        surroundings: Surroundings,
        land: Callable[[Any, Any, Any], None] | None,
    ) -> None:
        """A part of a front of one body, and all that becomes of it in the others."""
        encoder = self.device.wgpu.create_command_encoder()
        several = len(self._followed) > 1
        bound = [self._bindings(k, source, draw, first, surroundings) for k in range(len(self._followed))]
        meshes = {"HAS_MESHES": float(surroundings.triangle_count > 0)}
        if several:
            arrivals = [self._buffers["arrivals a"], self._buffers["arrivals b"]]
            encoder.copy_buffer_to_buffer(self._blank, 0, self._queues, LookCount.itemsize, LookCount.itemsize)
        followed = self._followed[number]
        start = self._kernel("light_start", {**self._how(followed), **meshes})
        self._follow(encoder, followed, bound[number], start, None)
        if not several:
            if followed.lit.casts and land is not None:
                encoder.copy_buffer_to_buffer(followed.sums["counters"], 0, self._outgoing_queue, 0, LookCount.itemsize)
                land(encoder, self._buffers["outgoing"], self._outgoing_queue)
            self.device.wgpu.queue.submit([encoder.finish()])
            return
        self._hand_on(encoder, followed, {**bound[number], "arrivals": arrivals[1]}, meshes, land)
        for row in range(1, BODIES_IN_A_ROW):
            arrivals.reverse()
            encoder.copy_buffer_to_buffer(self._queues, LookCount.itemsize, self._arrivals_queue, 0, LookCount.itemsize)
            encoder.copy_buffer_to_buffer(self._blank, 0, self._queues, LookCount.itemsize, LookCount.itemsize)
            for body, bindings in zip(self._followed, bound, strict=True):
                arriving = {**bindings, "arrivals": arrivals[0], "arrivals_queue": self._arrivals_queue}
                self._follow(
                    encoder, body, arriving, self._kernel("light_arrive", self._how(body)), self._arrivals_queue
                )
                leaving = {**bindings, "arrivals": arrivals[1]}
                if row == BODIES_IN_A_ROW - 1:
                    leaving["others"] = self._no_others
                self._hand_on(encoder, body, leaving, meshes, land)
        self.device.wgpu.queue.submit([encoder.finish()])

    def _bindings(
        self,
        number: int,
        source: Source,
        draw: tuple[tuple[int, ...], np.ndarray],
        first: int,
        surroundings: Surroundings,
    ) -> dict[str, Any]:
        followed, channel = self._followed[number], draw[0][number]
        params = params_of(followed.record, source, draw[1], first)
        return {
            **surroundings.bindings,
            **followed.lit.body.textures.channels[channel],
            **self._buffers,
            **followed.sums,
            "others": followed.others,
            "volume": followed.lit.body.uniforms[channel],
            "light": self.device.buffer(params.reshape(1), "uniform", "light"),
        }

    def _how(self, followed: _Followed) -> dict[str, float]:
        """The constants of the kernels that put light on the box of a body."""
        prepared = followed.lit.body.prepared
        how = {"GRADED": float(prepared.graded and prepared.sharp), "SMOOTH": float(not prepared.sharp)}
        return {**how, "OUTGOING": 0.0, "HANDS_ON": float(len(self._followed) > 1)}

    def _follow(
        self, encoder: Any, followed: _Followed, bindings: dict[str, Any], start: ComputeKernel, waiting: Any
    ) -> None:
        """What `start` puts on the box of a body goes through all generations. waiting : its indirect arguments."""
        body, quality = followed.lit.body, followed.lit.quality
        prepared, several = body.prepared, len(self._followed) > 1
        matter = constants_of(prepared, body.quality)
        constants = {
            **{k: v for k, v in matter.items() if k in ("ABSORBS", "SCATTERS", "BLOCKS")},
            "DEPOSITS": float(followed.lit.deposits),
            "OUTGOING": float(followed.lit.casts or several),
            "MEETS_MESHES": float(body.meets_meshes),
            "HANDS_ON": float(several),
            "INTENSITY": float(quality.method == "intensity"),
            "AMBIENT_MATTER": float(has_ambient_matter(prepared)),
            "GRADED": float(prepared.graded and prepared.sharp),
        }
        counters, arguments = bindings["counters"], self._arguments
        lists = 16 * (GENERATIONS + 1)
        encoder.copy_buffer_to_buffer(self._blank, 0, counters, 0, lists)
        ping, pong = self._lists
        begin = {**bindings, "patches": pong, "next_patches": ping, "generation": self._generations[0]}
        if waiting is None:
            start.run((BATCH // 64, 1, 1), begin, encoder)
        else:
            start.run((0, 0, 0), begin, encoder, indirect=(waiting, 0))
        if prepared.graded:
            constants |= {"SMOOTH": float(not prepared.sharp), "ADAPTIVE": matter["ADAPTIVE"]}
        march = self._kernel("light_curved" if prepared.graded else "light_straight", constants)
        generations = generations_for(quality)
        for g in range(generations - 1):
            encoder.copy_buffer_to_buffer(counters, 16 * (g + 1), arguments, 0, 16)
            step = {**bindings, "patches": ping, "next_patches": pong, "generation": self._generations[g]}
            march.run((0, 0, 0), step, encoder, indirect=(arguments, 0))
            ping, pong = pong, ping
        encoder.copy_buffer_to_buffer(counters, 16 * generations, arguments, 0, 16)
        last = {**bindings, "patches": ping, "next_patches": pong, "generation": self._generations[generations - 1]}
        self._kernel("light_end", {}).run((0, 0, 0), last, encoder, indirect=(arguments, 0))
        self._kernel("light_end", {}, "count").run((1, 1, 1), last, encoder)

    def _hand_on(
        self,
        encoder: Any,
        followed: _Followed,
        bindings: dict[str, Any],
        meshes: dict[str, float],
        land: Callable[[Any, Any, Any], None] | None,
    ) -> None:
        """What has left a body goes to the arrivals of others, or lands."""
        encoder.copy_buffer_to_buffer(followed.sums["counters"], 0, self._outgoing_queue, 0, LookCount.itemsize)
        encoder.copy_buffer_to_buffer(self._blank, 0, self._queues, 0, LookCount.itemsize)
        sorting = {**bindings, "outgoing_queue": self._outgoing_queue, "bundle_queues": self._queues}
        self._kernel("light_hand_on", meshes).run((0, 0, 0), sorting, encoder, indirect=(self._outgoing_queue, 0))
        if followed.lit.casts and land is not None:
            land(encoder, self._buffers["landing"], self._queues)

    def _clear(self) -> None:
        encoder = self.device.wgpu.create_command_encoder()
        for followed in self._followed:
            for buffer in followed.sums.values():
                encoder.clear_buffer(buffer)
        self.device.wgpu.queue.submit([encoder.finish()])

    def _reserve(self, outgoing: bool, several: bool) -> None:
        sizes = {
            "patches a": LightPatch.itemsize * CAPACITY,
            "patches b": LightPatch.itemsize * CAPACITY,
            "outgoing": OutPatch.itemsize * (OUT_CAPACITY if outgoing else 1),
        }
        if several:
            sizes |= dict.fromkeys(("landing", "arrivals a", "arrivals b"), OutPatch.itemsize * OUT_CAPACITY)
        _grow(self.device, self._buffers, sizes)
        if not hasattr(self, "_arguments"):
            self._arguments = self.device.buffer(LookCount.itemsize, "indirect", "arguments")
            self._outgoing_queue = self.device.buffer(LookCount.itemsize, "indirect", "outgoing queue")
            self._arrivals_queue = self.device.buffer(LookCount.itemsize, "indirect", "arrivals queue")
            self._queues = self.device.buffer(2 * LookCount.itemsize, "indirect", "landing and arrivals")
            self._no_others = self.device.buffer(np.zeros(1, OtherBodies), "uniform", "no other bodies")
        self._lists = self._buffers["patches a"], self._buffers["patches b"]

    def _grid(self, lit: Lit) -> tuple[int, int, int]:
        return grid_of(lit.body.prepared, lit.quality, self.device.limits["max-storage-buffer-binding-size"])

    def _sums_of(self, number: int, lit: Lit) -> dict[str, Any]:
        grid = self._grid(lit)
        if len(self._sums) <= number:
            self._sums.append({})
        sizes = {
            "counters": 16 * (GENERATIONS + 1) + 4 * TOTAL_WORDS,
            "fluence": FLUENCE_BYTES * (int(np.prod(grid)) if lit.deposits else 1),
            "directions": 16 * (int(np.prod(cells_of(grid))) if lit.deposits else 1),
        }
        _grow(self.device, self._sums[number], sizes)
        return self._sums[number]

    def totals(self, number: int = 0) -> tuple[dict[str, np.ndarray], int]:
        """Where the flux of a body went, (3,) float64 each, and how many patches were followed; waits for the device.

        ``flux_unsent`` is the part of ``flux_out`` that found no room in the list for the surroundings.
        """
        size = (GENERATIONS + 1) * 4 + TOTAL_WORDS
        followed = self._followed[number]
        words = self.device.read(followed.sums["counters"], np.uint32, size)[-TOTAL_WORDS:]
        low, high = words[0::2].astype(np.int64), words[1::2].astype(np.int64)
        sums = (low + (high << 32)).astype(np.float64)
        per_quantum = 1.0 / float(followed.record["total_quanta"])
        flux = {name: sums[3 * k : 3 * k + 3] * per_quantum for k, name in enumerate(TOTALS)}
        flux["flux_ended"] = flux["flux_ended"] - flux.pop("flux_lent")
        return flux, int(sums[3 * len(TOTALS)])

    def read(self, number: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Fluence and mean direction, (Z, Y, X, 3) float32 each, of a body of the last run."""
        followed = self._followed[number]
        x, y, z = followed.grid
        i, j, k = cells_of(followed.grid)
        sums = self.device.read(followed.sums["fluence"], np.int32, (z, y, x, 3)).astype(np.float32)
        ways = self.device.read(followed.sums["directions"], np.int32, (k, j, i, 4)).astype(np.float32)
        turn = ways[..., :3] / np.maximum(ways[..., 3:], 1.0)
        turn /= np.maximum(np.linalg.norm(turn, axis=-1, keepdims=True), 1.0)
        for axis, (cells, voxels) in enumerate(((k, z), (j, y), (i, x))):
            turn = np.take(turn, ((np.arange(voxels) + 0.5) * cells / voxels).astype(int), axis=axis)
        return sums * float(followed.record["fluence_per_quantum"]), turn

    def field(self, before: LightField | None = None, number: int = 0) -> LightField:
        """Fluence and direction in a body of the last run as textures; those of `before` are used again if they fit."""
        followed = self._followed[number]
        grid = followed.grid
        if before is None or before.grid != grid:
            made = [
                self.device.texture(
                    size=size, format="rgba16float", dimension="3d", usage=("sample", "storage"), label=label
                )
                for label, size in (("fluence", grid), ("light direction", cells_of(grid)))
            ]
            before = LightField(made[0], made[1], grid)
        record = self.device.buffer(followed.record.reshape(1), "uniform", "light")
        bindings = {
            "light": record,
            "fluence": followed.sums["fluence"],
            "directions": followed.sums["directions"],
            "fluence_image": before.fluence,
            "direction_image": before.direction,
        }
        for entry, (x, y, z) in (("main", grid), ("turn", cells_of(grid))):
            self._kernel("light_resolve", {}, entry).run((-(-x // 64), y, z), bindings)
        return before

    def _kernel(self, name: str, constants: dict[str, float], entry: str = "main") -> ComputeKernel:
        return self._pipelines.kernel(f"techniques/eikonal/shaders/{name}", constants, entry)


def generations_for(quality: LightQuality) -> int:
    """How many generations light is followed through. Each is a dispatch, also when nothing is left to follow."""
    return min(GENERATIONS, DIVISIONS + 2 * quality.bounces)


def has_ambient_matter(prepared: Prepared) -> bool:
    """Whether matter without a surface dims light."""
    return prepared.absorption is not None or prepared.scattering is not None


def _fronts(lit: Lit, grid: tuple[int, int, int], lights: Sequence[object]) -> list[Source]:
    """The fronts that carry any light on the box of a body."""
    body = lit.body
    voxel = voxel_of(body.prepared, grid)
    sources = (s for lamp in lights for s in sources_of(lamp, body.world, body.box, voxel, lit.quality))
    return [source for source in sources if source.patch_flux > 0.0]


def _grow(device: Device, buffers: dict[str, Any], sizes: dict[str, int]) -> None:
    """Make the buffers that are missing or too small."""
    for name, size in sizes.items():
        if name not in buffers or buffers[name].size < size:
            buffers[name] = device.buffer(size, "storage", name)
