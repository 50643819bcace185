"""The passes of the eikonal view renderer: volumes prepared once, then rays for the pixels that they cover.

A dispersive volume is looked through once for each of its wavelengths, whose weighted colours add up to the picture.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import ComputeKernel, Device, Pipelines, RenderPass
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.surroundings.charts import Reach
from pellucid.techniques.eikonal.bodies import Body
from pellucid.techniques.eikonal.brdf_tables import BrdfTables, spreading
from pellucid.techniques.eikonal.hulls import Hull, hull_of
from pellucid.techniques.eikonal.irradiance import check_lights, flux_bound
from pellucid.techniques.eikonal.joining import Joiner, Placed
from pellucid.techniques.eikonal.layouts import DrawParams, LookCount, LookRay, VolumeParams
from pellucid.techniques.eikonal.light import MOST_BODIES, LightSimulator, Lit
from pellucid.techniques.eikonal.prepare import Prepared, prepare
from pellucid.techniques.eikonal.proxies import Box, corners, tight_box, whole_box
from pellucid.techniques.eikonal.relay import Relay, list_bytes
from pellucid.techniques.eikonal.resources import (
    LOOKS_PER_PIXEL,
    VolumeTextures,
    constants_of,
    crystal_constants,
    parameters,
    scale_of,
    scatters,
    upload,
)
from pellucid.techniques.eikonal.stand_in import StandIns, water_about
from pellucid.techniques.eikonal.wavelengths import at_sample, common_draws

if TYPE_CHECKING:
    from pellucid.scene import Camera, LightQuality, RefractiveVolume, Water
    from pellucid.surroundings import Surroundings
    from pellucid.surroundings.interfaces import Interface

# A picture is drawn in bands of rows, so that the lists of waiting rays keep to 150 MB.
BAND_PIXELS = 1 << 18
# Rays that wait are counted apart from lobes that do.
LOOK_QUEUES = 2

# Meshes show the caustics and the shadow of a body within this many radii of its box.
REACH_RADII = 5.0

Rectangle = tuple[int, int, int, int]


@dataclass
class _Loaded:
    """A volume on the device, shared by the objects that place it. `source` keeps the identity that it is found by.

    within : (4, 4), from the volume to the frame of the first of its objects.
    """

    source: Any
    prepared: Prepared
    textures: VolumeTextures
    tight: Box
    within: np.ndarray
    hulls: dict[Any, tuple[Any, Hull]] = field(default_factory=dict)  # by proxies, kept so that no id is used again

    def hull(self, objects: Sequence[RefractiveVolume]) -> Hull:
        """Where rays of the picture begin; what several objects are composed to has a box."""
        item = objects[0]
        proxy, center_m = (item.proxy, item.center_m) if len(objects) == 1 else ("box", (0.0, 0.0, 0.0))
        key = (proxy if isinstance(proxy, str) else id(proxy), center_m)
        if key not in self.hulls:
            self.hulls[key] = proxy, hull_of(self.prepared, proxy, center_m)
        return self.hulls[key][1]


class EikonalTechnique:
    """Draws `RefractiveVolume` objects.

    Attributes
    ----------
    bodies : what was prepared last. pipelines : one for each choice that a volume was drawn with.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._loaded: dict[Any, _Loaded] = {}
        self.bodies: list[Body] = []
        self.pipelines = Pipelines(device, ("screen_color",))
        self._no_looks = device.buffer(np.array([(0, 1, 1, 0)] * LOOK_QUEUES, LookCount), "storage", "no looks")
        self._brdfs = BrdfTables(device)
        self._lists: dict[str, Any] = {}
        self._draws: list[Any] = []
        self._relay = Relay(device)
        self._joiner = Joiner()
        self._capacity = 0
        self._simulator: LightSimulator | None = None
        self._lit: dict[int, Any] = {}
        self._cast: list[Any] = []
        self._stand_ins = StandIns()
        self._sum = self._kernel("sum", {})
        self._composite = RenderPass(
            device,
            "techniques/eikonal/shaders/composite",
            targets=[COLOR_FORMAT],
            depth=DEPTH_FORMAT,
            depth_compare="always",
        )

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held: volumes, and the lists of rays."""
        lists = sum(b.size for b in self._lists.values()) + self._relay.nbytes
        return sum(v.textures.nbytes for v in self._loaded.values()) + lists

    def interfaces(self, objects: Sequence[RefractiveVolume], waters: Sequence[Water]) -> list[Interface]:
        """What rays of other techniques meet of the objects."""
        return self._stand_ins.of(objects, waters)

    def prepare(self, objects: Sequence[RefractiveVolume], surroundings: Surroundings) -> None:
        """Make every volume resident, drop those that are gone, and write the parameters of each object."""
        self._brdfs.prepare(objects)
        placed = [self._joiner.place(group) for group in self._joiner.groups(objects)]
        wanted = {what.key for what in placed}
        self._loaded = {key: volume for key, volume in self._loaded.items() if key in wanted}
        bodies = []
        for number, what in enumerate(placed):
            if what.key not in self._loaded:
                self._loaded[what.key] = self._load(what)
            before = self.bodies[number] if number < len(self.bodies) else None
            volume = self._loaded[what.key]
            # Alone in the scene it may have all of its box: rays are not sent from body to body.
            box = volume.tight if len(placed) > 1 else whole_box(volume.prepared)
            bodies.append(self._place(what, volume, box, before))
            bodies[-1].number = number
        self.bodies = bodies
        for body in bodies:
            self._write_parameters(body, surroundings)
        self._relay.prepare(bodies)

    def illuminate(self, lights: Sequence[Any], surroundings: Surroundings) -> None:
        """Follow the light of all lamps through the bodies that show it; what has not changed is kept.

        Bodies that scatter get the light in them, meshes the caustics and shadows of all bodies that give any. Light
        goes on from body to body, so that what a body shows depends on all; more than `MOST_BODIES` are lit apart.
        """
        states = [_light_state(body, surroundings) for body in self.bodies]
        together = len(self.bodies) <= MOST_BODIES
        if together:
            states = [(number, states) for number in range(len(states))]
        receiving = bool(lights) and surroundings.triangle_count > 0
        casting = [body for body in self.bodies if receiving and _look_of(body).caustics]
        cast_state = [state for body, state in zip(self.bodies, states, strict=True) if body in casting]
        again = bool(casting) and not (surroundings.caustics.active and cast_state == self._cast)
        if again:
            again = self._begin_caustics(casting, lights, surroundings)
        glows = [bool(lights) and scatters(body.prepared) for body in self.bodies]
        lit = {
            number: self._lit[number]
            for number, state in enumerate(states)
            if glows[number] and number in self._lit and self._lit[number][0] == state
        }
        groups = [self.bodies] if together else [[body] for body in self.bodies]
        for group in groups:
            dim = [body for body in group if glows[body.number] and body.number not in lit]
            casts = [again and body in casting for body in group]
            if not dim and not any(casts):
                continue
            for body in group:
                check_lights(body.prepared, body.world, lights)
            followed = [
                Lit(body, _look_of(body), glows[body.number], here) for body, here in zip(group, casts, strict=True)
            ]
            self.simulator.run(followed, lights, surroundings, surroundings.caustics.land)
            for body in dim:
                before = self._lit.get(body.number)
                shown = self.simulator.field(before[1] if before else None, group.index(body))
                # The textures are kept with it, so that no id of theirs comes again.
                lit[body.number] = (states[body.number], shown, body.textures)
        for body in self.bodies:
            body.light = lit[body.number][1].bindings if glows[body.number] else {}
        if again:
            self._submit(surroundings.caustics.resolve)
        if not casting and surroundings.caustics.active:
            surroundings.caustics.drop()
        self._lit, self._cast = lit, cast_state

    def _begin_caustics(self, casting: Sequence[Body], lights: Sequence[Any], surroundings: Surroundings) -> bool:
        """Unfold the meshes around the bodies, and clear their maps; False when no mesh is near."""
        reaches, bound, texel_m = [], 0.0, np.inf
        for body in casting:
            radius = float(np.linalg.norm(whole_box(body.prepared)[1])) * scale_of(body.world)
            reaches.append(Reach(tuple(body.world[:3, 3]), REACH_RADII * radius, radius))
            longest = 2.0 * float(whole_box(body.prepared)[1].max()) * scale_of(body.world)
            texel_m = min(texel_m, longest / _look_of(body).caustic_texels)
            bound += flux_bound(body.prepared, body.world, lights, _look_of(body))
        caustics = surroundings.caustics
        caustics.prepare(surroundings.geometry, reaches, texel_m)
        if caustics.charts is None or bound <= 0.0:
            return False
        self._submit(lambda encoder: caustics.begin(encoder, bound))
        return True

    def _submit(self, encode: Callable[[Any], None]) -> None:
        encoder = self.device.wgpu.create_command_encoder()
        encode(encoder)
        self.device.wgpu.queue.submit([encoder.finish()])

    @property
    def simulator(self) -> LightSimulator:
        """The light simulator, made when it is first needed."""
        if self._simulator is None:
            self._simulator = LightSimulator(self.device)
        return self._simulator

    def _load(self, what: Placed) -> _Loaded:
        item, (volume, world) = what.objects[0], what.volume()
        composed = "sharp" if volume.regions else "smooth"
        prepared = prepare(
            volume,
            item.boundary if len(what.objects) == 1 else composed,
            item.smoothing_voxels,
            item.gradient,
            item.quality.method,
            any(o.dispersion for o in what.objects),
            max(o.spectral for o in what.objects),
        )
        source = [o.volume for o in what.objects]
        return _Loaded(source, prepared, upload(self.device, prepared), tight_box(prepared), world)

    def _place(self, what: Placed, volume: _Loaded, box: Box, before: Body | None) -> Body:
        """The body of objects; buffers of the one before are used again if it has the same volume."""
        world, quality = what.frame @ volume.within, what.objects[0].quality
        placed = Body(
            what.objects, volume.prepared, volume.textures, [], world, box, quality, volume.hull(what.objects)
        )
        if before is not None and before.textures is volume.textures:
            placed.uniforms = before.uniforms
        else:
            each = volume.prepared.channels
            placed.uniforms = [self.device.buffer(VolumeParams.itemsize, "uniform", "volume") for _ in each]
        return placed

    def _write_parameters(self, body: Body, surroundings: Surroundings) -> None:
        body.meets_meshes = _meets_meshes(body, body.box, surroundings)
        abouts = (water_about(item, surroundings.waters) for item in body.objects)
        body.water = next((water for water in abouts if water is not None), None)
        self._write_volume(body)

    def _write_volume(self, body: Body) -> None:
        for channel, uniform in enumerate(body.uniforms):
            record = parameters(
                body.prepared, body.textures, channel, body.quality, body.world, body.box, body.meets_meshes
            )
            self._brdfs.write(record, body.objects[0])
            record["body"], record["body_count"] = body.number, len(self.bodies)
            body.hull.write(record)
            body.write_water(record)
            self.device.write(uniform, record.reshape(1))
            if body.prepared.crystals is not None:
                crystals = body.prepared.crystals.record(channel)
                self.device.write(body.textures.channels[channel]["crystals"], crystals.reshape(1))

    def draw(
        self, encoder: Any, targets: Targets, camera: Camera, surroundings: Surroundings, timer: Any = None
    ) -> None:
        """Encode the draws of all bodies over what is in the targets."""
        self._shift_wavelengths(surroundings.sample_index)
        covered = {n: r for n, b in enumerate(self.bodies) if (r := _screen_rectangle(b, camera, targets.size))}
        if not covered:
            return
        bands = _bands(_around(list(covered.values())))
        self._reserve(max(width * height for _, _, width, height in bands))
        draws = common_draws([body.prepared for body in self.bodies])
        while len(self._draws) < len(bands) * len(draws):
            self._draws.append(self.device.buffer(DrawParams.itemsize, "uniform", "draw"))
        for number, band in enumerate(bands):
            seen = [n for n, rectangle in covered.items() if _overlap(rectangle, band)]
            if not seen:
                continue
            for index, (channels, weights) in enumerate(draws):
                draw = self._draws[number * len(draws) + index]
                _write_draw(self.device, draw, band, weights, first=index == 0)
                shared = {
                    **surroundings.bindings,
                    **self._lists,
                    "screen_color": targets.color,
                    "screen_depth": targets.depth,
                    "draw": draw,
                }
                self._draw_band(encoder, band, seen, channels, shared, surroundings, timer)
            self._composite.run(
                encoder,
                color=[targets.color_view],
                depth=targets.depth_view,
                bindings={"draw": draw, "picture": self._lists["picture"]},
                scissor=band,
                timer=timer,
                label="eikonal composite",
            )

    def _shift_wavelengths(self, sample: int) -> None:
        for body in self.bodies:
            shifted = at_sample(body.prepared, sample)
            if shifted is not body.prepared:
                body.prepared = shifted
                self._write_volume(body)

    def _reserve(self, pixels: int) -> None:
        """Room for `pixels` pixels and the rays that wait for them; it only grows."""
        if pixels > self._capacity:
            self._capacity = pixels
            sizes = {
                "drawn": 16 * pixels,
                "picture": 16 * pixels,
                "look_rays": LookRay.itemsize * pixels * LOOKS_PER_PIXEL,
                "look_values": 16 * pixels * LOOKS_PER_PIXEL,
            }
            self._lists = {name: self.device.buffer(size, "storage", name) for name, size in sizes.items()}
            self._lists["look_list"] = self.device.buffer(list_bytes(pixels), "indirect", "rays that look around")
        self._lists |= self._relay.reserve(self._capacity, len(self.bodies) > 1)

    def _draw_band(
        self,
        encoder: Any,
        band: Rectangle,
        seen: Sequence[int],
        channels: Sequence[int],
        shared: dict[str, Any],
        surroundings: Surroundings,
        timer: Any,
    ) -> None:
        """March, look, sum, for one wavelength. seen : numbers of the bodies that camera rays can meet."""
        width, height = band[2:]
        has_meshes = surroundings.triangle_count > 0
        objects = [body.objects[0] for body in self.bodies]
        glints = [item.gloss > 0.0 and surroundings.light_count > 0 for item in objects]
        marches = [
            (
                self._march_kernel(body, glints[number], bool(surroundings.waters)),
                {**shared, **body.textures.channels[channel], **body.light, "volume": body.uniforms[channel]},
            )
            for number, (body, channel) in enumerate(zip(self.bodies, channels, strict=True))
        ]
        blocks = (-(-width // 8), -(-height // 8), 1)
        looks = shared["look_list"]
        encoder.copy_buffer_to_buffer(self._no_looks, 0, looks, 0, self._no_looks.size)
        if len(marches) > 1:
            trace = has_meshes and not self._by_screen
            self._relay.run(encoder, blocks, width * height, seen, marches, shared, trace, timer)
        else:
            kernel, bindings = marches[0]
            kernel.run(blocks, bindings, encoder, timer, "eikonal march")
        constants = {"HAS_MESHES": float(has_meshes), **surroundings.shading_constants}
        # Rays that leave a body have been sent to all others already: what stands for them is met behind water.
        across = surroundings.across_constants if surroundings.submersion.active else {}
        across = {**across, "ACROSS_FIRST": 0.0} if across else {}
        look = self._kernel("look", {**constants, **across, "SCREEN_SPACE": float(self._by_screen)})
        look.run((0, 0, 0), shared, encoder, timer, "eikonal look", indirect=(looks, 0))
        rough = any(spreading(item) for item in objects)
        if any(glints) or rough:
            lobe = self._kernel("look_lobe", {**constants, "LOBES": float(rough)})
            tables = {**shared, **self._brdfs.bindings}
            lobe.run((0, 0, 0), tables, encoder, timer, "eikonal lobe", indirect=(looks, LookCount.itemsize))
        self._sum.run((-(-width * height // 64), 1, 1), shared, encoder, timer, "eikonal sum")

    @property
    def _by_screen(self) -> bool:
        """Rays look into the picture only if all objects are content with that."""
        return all(item.surroundings == "screen" for body in self.bodies for item in body.objects)

    def _march_kernel(self, body: Body, lamps: bool, waters: bool) -> ComputeKernel:
        prepared = body.prepared
        constants = {**constants_of(prepared, body.quality), "MEETS_MESHES": float(body.meets_meshes)}
        constants |= {"GLINTS": float(lamps), "ROUGH": float(spreading(body.objects[0]))}
        constants["WATERS"] = float(waters)
        constants["RELAYED"] = float(len(self.bodies) > 1)
        constants["PROXY"] = float(body.hull.kind)
        if prepared.sharp:
            constants["GRADED"] = float(prepared.graded)
        name = "view_sharp" if prepared.sharp else "view_smooth"
        if prepared.crystals is not None:
            name, constants = "view_crystal", {**constants, **crystal_constants(prepared)}
        return self._kernel(name, constants)

    def _kernel(self, name: str, constants: dict[str, float]) -> ComputeKernel:
        return self.pipelines.kernel(f"techniques/eikonal/shaders/{name}", constants)


def _meets_meshes(body: Body, box: Box, surroundings: Surroundings) -> bool:
    around = corners(box, 2.0 * body.prepared.voxel) @ body.world[:3, :3].T + body.world[:3, 3]
    low, high = around.min(axis=0), around.max(axis=0)
    return any((lo <= high).all() and (hi >= low).all() for lo, hi in surroundings.mesh_bounds_ws)


def _write_draw(device: Device, buffer: Any, band: Rectangle, weights: np.ndarray, first: bool) -> None:
    record = np.zeros((), DrawParams)
    record["corner"], record["size"], record["first"] = band[:2], band[2:], first
    record["weights"][:, :3] = weights.T  # columns
    device.write(buffer, record.reshape(1))


def _bands(rectangle: Rectangle) -> list[Rectangle]:
    """Cut a rectangle into rows of at most `BAND_PIXELS` pixels, which bounds the memory of the lists."""
    x, y, width, height = rectangle
    rows = max(1, BAND_PIXELS // width)
    return [(x, y + at, width, min(rows, height - at)) for at in range(0, height, rows)]


def _around(rectangles: Sequence[Rectangle]) -> Rectangle:
    corners_ = np.array([(x, y, x + width, y + height) for x, y, width, height in rectangles])
    low, high = corners_[:, :2].min(axis=0), corners_[:, 2:].max(axis=0)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _overlap(a: Rectangle, b: Rectangle) -> bool:
    return all(a[k] < b[k] + b[k + 2] and b[k] < a[k] + a[k + 2] for k in range(2))


def _screen_rectangle(body: Body, camera: Camera, size: tuple[int, int]) -> Rectangle | None:
    """The pixels that a volume's box can cover: (x, y, width, height), or None when it is out of the picture."""
    clip = camera.projection_matrix(size) @ camera.view_matrix() @ body.world
    around = np.pad(corners(body.box, 2.0 * body.prepared.voxel), ((0, 0), (0, 1)), constant_values=1.0) @ clip.T
    width, height = size
    if (around[:, 3] <= 1e-6).any():
        return (0, 0, width, height) if (around[:, 3] > 1e-6).any() else None
    ndc = around[:, :2] / around[:, 3:]
    pixels = (ndc * (0.5, -0.5) + 0.5) * (width, height)
    low = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, (width, height)).astype(int)
    high = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, (width, height)).astype(int)
    if (high <= low).any():
        return None
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _look_of(body: Body) -> LightQuality:
    return body.objects[0].light


def _light_state(body: Body, surroundings: Surroundings) -> Any:
    """What the light in a body depends on; lamps and meshes count their changes in the version of the shadows."""
    matter = tuple(id(c) for c in body.textures.channels)
    own = (matter, body.world.tobytes(), _look_of(body), body.quality)
    return (*own, surroundings.shadow_version, body.meets_meshes, body.around)
