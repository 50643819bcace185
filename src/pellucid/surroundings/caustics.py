"""Light of refractive matter on opaque meshes: bundles of rays are collected on an atlas, and shading reads it.

A mesh near matter is unfolded into charts. Bundles land on them and leave their flux in two maps: `caustic` adds
irradiance, `blocked` says how much of the lamps' own light is missing. Divided by the surface of each texel the sums
are irradiance, and `shaders/shade.wgsl` uses it as

    radiance = emission + environment + diffuse * caustic + direct * (1 - blocked / direct irradiance)

by channel, so that coloured glass has a coloured shadow.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.gpu import ComputeKernel, Pipelines, RenderPass
from pellucid.scene import checks
from pellucid.surroundings.charts import TABLE_CHARTS, TABLE_TEXELS, Charts, Reach, build_charts
from pellucid.surroundings.layouts import LandParams, LookCount, OutPatch

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer
    from pellucid.surroundings.geometry import Geometry

MOST_TEXELS = 1 << 20  # of an atlas: 24 MB of sums and up to 40 MB of maps
UNITS = 2.0**30  # the bound of flux in fixed point; as much again is left to rounding
HALF_MAX = 65504.0
KINDS = ("caustic", "blocked")


class CausticMaps:
    """The atlas of one `Surroundings`: `prepare`, then `begin`, `land` for each list of bundles, and `resolve`.

    The maps stay as they are until `begin` is called again, or `drop`, which happens by itself when a mesh moves.

    Parameters
    ----------
    device : where the maps live. resources : bind group 1 by name, which gets the maps and loses none.

    Attributes
    ----------
    active : whether there are maps to read; then shaders are run with ``CAUSTICS`` = 1.
    charts : the atlas, or None.
    """

    def __init__(self, device: Device, resources: dict[str, Any]) -> None:
        self.device = device
        self.active = False
        self.version = 0
        self.charts: Charts | None = None
        self._resources = resources
        self._made_for: tuple[Any, ...] = ()
        self._units_per_flux = 1.0
        self._landing: dict[str, Any] = {}
        self._wide_bundles: Any = None
        resources["caustic_sampler"] = device.sampler("linear", "clamp")
        self.drop()

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        if self.charts is None:
            return 0
        texels = self.charts.size[0] * self.charts.size[1]
        wide = self._wide_bundles.size if self._wide_bundles is not None else 0
        return texels * (24 + 8 + 2 * (16 if self.device.float32_filterable else 8)) + wide

    def drop(self) -> None:
        """Forget the maps: meshes are drawn as if no refractive matter were there."""
        blank = self.charts is None and "caustic_charts" in self._resources
        self.active, self.charts, self._made_for, self._landing = False, None, (), {}
        self.version += 1
        if blank:
            return
        empty = np.zeros((1, 1, 4), np.float32)
        for kind in KINDS:
            self._resources[f"{kind}_map"] = self.device.texture(empty, format="rgba16float", label=f"no {kind} map")
        self._resources["caustic_charts"] = self.device.texture(
            empty.astype(np.uint32), format="rgba32uint", label="no charts"
        )

    def prepare(
        self, geometry: Geometry, reaches: Sequence[Reach], texel_m: float, most_texels: int = MOST_TEXELS
    ) -> bool:
        """Unfold the meshes within the reaches, if anything differs from the last call; tells whether it did.

        Parameters
        ----------
        geometry : ``Surroundings.geometry``. reaches : where light can land, one for each body.
        texel_m : edge of a texel in metres, made larger where the atlas would exceed `most_texels`.

        Raises
        ------
        SceneError : for a texel that is not above 0.
        """
        made_for = (geometry, tuple(reaches), texel_m, most_texels)
        if len(self._made_for) and self._made_for[0] is geometry and self._made_for[1:] == made_for[1:]:
            return False
        self.drop()
        self._made_for = made_for
        side = self.device.limits["max-texture-dimension-2d"]
        triangles = geometry.triangles[: geometry.count]
        corners = (
            np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1) if geometry.count else np.zeros((0, 3, 3))
        )
        mesh = triangles["material"].astype(np.int64)
        charts = build_charts(
            corners, mesh, triangles["single_sided"] != 0, reaches, texel_m, min(most_texels, side**2 // 2)
        )
        if len(charts.table):
            self.charts = charts
            self._upload(charts, geometry)
        return True

    def begin(self, encoder: Any, flux_bound: float) -> None:
        """Clear the sums; at most once for each submission.

        Parameters
        ----------
        flux_bound : power that all bundles of one kind and channel will not exceed together, such as what the lamps
            shed on all bodies. The sums count in 2^-30 of it, and overflow at twice of it.

        Raises
        ------
        SceneError : for a bound that is not above 0 or not finite.
        """
        bound = checks.number("flux_bound", flux_bound, low=0.0, exclusive=True)
        if self.charts is None:
            return
        # A power of two: bounds that differ by rounding then give the same bits.
        self._units_per_flux = float(np.exp2(np.floor(np.log2(UNITS / bound))))
        record = np.zeros((), LandParams)
        record["units_per_flux"] = self._units_per_flux
        record["width"], record["height"] = self.charts.size
        self.device.write(self._landing["landing"], record.reshape(1))
        encoder.clear_buffer(self._landing["flux_sums"])

    def land(self, encoder: Any, outgoing: Any, outgoing_queue: Any, timer: PassTimer | None = None) -> None:
        """Let bundles fall on the meshes; may be called many times between `begin` and `resolve`.

        Parameters
        ----------
        outgoing : buffer of `layouts.OutPatch`.
        outgoing_queue : indirect buffer of `layouts.LookCount`: how many there are, 64 a workgroup.
        """
        if self.charts is None:
            return
        room = 4 * (outgoing.size // OutPatch.itemsize)
        if self._wide_bundles is None or self._wide_bundles.size < room:
            self._wide_bundles = self.device.buffer(room, "storage", "wide bundles")
        shared = {
            **self._resources, **self._landing, "outgoing": outgoing, "outgoing_queue": outgoing_queue,
            "wide_bundles": self._wide_bundles,
        }  # fmt: skip
        queue = self._landing["wide_queue"]
        encoder.copy_buffer_to_buffer(self._landing["none"], 0, queue, 0, LookCount.itemsize)
        self._kernel("land").run((0, 0, 0), shared, encoder, timer, "caustics land", indirect=(outgoing_queue, 0))
        self._kernel("land_wide").run((0, 0, 0), shared, encoder, timer, "caustics wide", indirect=(queue, 0))

    def resolve(self, encoder: Any, timer: PassTimer | None = None) -> None:
        """Turn the sums into the maps that shading reads."""
        if self.charts is None:
            return
        self._resolver().run(
            encoder,
            color=[self._landing[f"{kind}_target"] for kind in KINDS],
            clear=[(0.0, 0.0, 0.0, 0.0)] * 2,
            bindings={**self._resources, **self._landing},
            timer=timer,
            label="caustics resolve",
        )
        for kind in KINDS:
            self._resources[f"{kind}_map"] = self._landing[f"{kind}_texture"]
        self.active = True
        self.version += 1

    def landed_flux(self) -> dict[str, np.ndarray]:
        """Power (3,) since `begin`, read back: ``caustic`` and ``blocked`` on the charts, and each with ``_missed``."""
        if self.charts is None:
            return {name: np.zeros(3) for kind in KINDS for name in (kind, f"{kind}_missed")}
        size = self.charts.size[0] * self.charts.size[1]
        sums = self.device.read(self._landing["flux_sums"], np.int32, (size + 1, 2, 3)) / self._units_per_flux
        landed, lost = sums[:-1].sum(axis=0), sums[-1]
        return {
            name: rows[i] for i, kind in enumerate(KINDS) for name, rows in ((kind, landed), (f"{kind}_missed", lost))
        }

    def irradiance(self) -> tuple[np.ndarray, np.ndarray]:
        """The maps (H, W, 3), read back: irradiance of the caustics, and irradiance that is missing.

        Raises
        ------
        SceneError : when there are none.
        """
        if not self.active:
            raise SceneError("caustics", "no light has been collected", "call prepare, begin, land and resolve first")
        caustic, blocked = (self.device.read_texture(self._landing[f"{kind}_texture"])[..., :3] for kind in KINDS)
        return caustic, blocked

    def _upload(self, charts: Charts, geometry: Geometry) -> None:
        attributes = geometry.attributes.copy()
        attributes["chart_front"][: geometry.count], attributes["chart_back"][: geometry.count] = (
            charts.front,
            charts.back,
        )
        self.device.write(self._resources["triangle_attributes"], attributes)
        rows = -(-len(charts.table) // TABLE_CHARTS)
        table = np.zeros((rows * TABLE_CHARTS, 4 * TABLE_TEXELS), np.float32)
        table[: len(charts.table)] = charts.table
        texels = table.view(np.uint32).reshape(rows, TABLE_CHARTS * TABLE_TEXELS, 4)
        device = self.device
        self._resources["caustic_charts"] = device.texture(texels, format="rgba32uint", label="charts")
        size = charts.size[0] * charts.size[1]
        self._landing = {
            "landing": device.buffer(LandParams.itemsize, "uniform", "landing"),
            "flux_sums": device.buffer(4 * 6 * (size + 1), "storage", "flux sums"),
            "chart_area": device.buffer(charts.area_m2, "storage", "chart area"),
            "chart_owner": device.buffer(charts.owner, "storage", "chart owner"),
            "wide_queue": device.buffer(LookCount.itemsize, "indirect", "wide queue"),
            "none": device.buffer(np.array([(0, 1, 1, 0)], LookCount), "storage", "no bundles"),
        }
        for kind in KINDS:
            texture = device.texture(
                size=charts.size, format=self._format, usage=("sample", "render"), label=f"{kind} map"
            )
            self._landing[f"{kind}_texture"], self._landing[f"{kind}_target"] = texture, texture.create_view()

    @property
    def _format(self) -> str:
        return "rgba32float" if self.device.float32_filterable else "rgba16float"

    def _kernel(self, name: str) -> ComputeKernel:
        return Pipelines(self.device, shared=True).kernel(f"surroundings/shaders/{name}")

    def _resolver(self) -> RenderPass:
        constants = {} if self.device.float32_filterable else {"MOST": HALF_MAX}
        module, formats = "surroundings/shaders/resolve_caustics", [self._format] * 2
        return Pipelines(self.device, shared=True).draw(module, constants, targets=formats)
