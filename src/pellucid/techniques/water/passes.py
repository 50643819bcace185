"""The passes of water: what each pixel shows of it, then the radiance of that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Device, Pipelines, RenderPass
from pellucid.gpu.layout import offset_of
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.scene.water_quality import (
    COLORS,
    FALLBACKS,
    FRESNELS,
    REFLECTIONS,
    REFRACTIONS,
    UNDERSIDES,
    WaterQuality,
    quality_of,
)
from pellucid.techniques.water.blocks import Block, block_of, divided
from pellucid.techniques.water.borders import OpenBorder
from pellucid.techniques.water.caustics import WaterLight
from pellucid.techniques.water.glow import WaterGlow
from pellucid.techniques.water.layouts import WaterParams, WaterViews
from pellucid.techniques.water.prepare import WaveMaps, parameters, same_surfaces, sources_of, surfaces_of, wave_maps
from pellucid.techniques.water.region import Rectangle, covered
from pellucid.techniques.water.ripple_maps import RippleMaps, ripples_for_device
from pellucid.techniques.water.views import SurfacePictures, hidden_box, needs_pictures, quality_seen_from
from pellucid.techniques.water.wave_moments import moment_levels

if TYPE_CHECKING:
    from pellucid.scene import Camera
    from pellucid.scene.water import Water
    from pellucid.surroundings import Surroundings
    from pellucid.surroundings.camera import View
    from pellucid.surroundings.views import Box

HIT_FORMAT = "rgba32float"
WAVE_NAMES = ("wave_map", "wave_sampler", "wave_moments", "wave_texture", "moments_texture")
NONE = [(0.0, 0.0, 0.0, 0.0)]
NEAREST = ("water_hits", "water_blocks", "opaque_color", "picture_depths", "picture_sampler")


@dataclass
class Body:
    """A body of water on the device.

    Attributes
    ----------
    item : what the user described. quality : what its technique makes of its quality.
    waves : its surface at `time_s`. version : counts changes of the waves.
    bindings : resources of bind group 0 by their WGSL names.
    pictures : of what is below and above it, where its quality looks things up.
    ripples : what works out a layer of its waves on the device. block : pixels that share a look, across and down.
    """

    item: Water
    quality: WaterQuality
    waves: WaveMaps
    bindings: dict[str, Any]
    time_s: float = 0.0
    version: int = 0
    params: np.ndarray = field(default_factory=lambda: np.zeros((), WaterParams))
    pictures: SurfacePictures | None = None
    ripples: RippleMaps | None = None
    block: Block = (1, 1)
    border: OpenBorder = field(default_factory=OpenBorder)

    def constants(self, quality: WaterQuality, sides_by_rays: bool) -> dict[str, float]:
        """Override constants of all shaders of this body.

        Parameters
        ----------
        quality : of `views.quality_seen_from`. sides_by_rays : whether borders may be seen that no picture shows.
        """
        return {
            "WATER_REFRACTION": float(REFRACTIONS.index(quality.refraction)),
            "WATER_REFLECTION": float(REFLECTIONS.index(quality.reflection)),
            "WATER_SIDES_BY_RAYS": float(sides_by_rays),
            "WATER_OUTLINE": float(self.item.shape.kind),
            "WATER_UNDERSIDE": float(UNDERSIDES.index(quality.underside)),
            "WATER_FALLBACK": float(FALLBACKS.index(quality.fallback)),
            "WATER_FRESNEL": float(FRESNELS.index(quality.fresnel)),
            "WATER_COLOR": float(COLORS.index(quality.color)),
            "WATER_FOAM": float(self.item.foam > 0.0),
            "WATER_GOD_RAYS": float(quality.god_rays),
            "WATER_DISPERSION": float(self.item.dispersion and self.item.matter.is_dispersive),
        }


class WaterTechnique:
    """Draws `Water` objects.

    Attributes
    ----------
    bodies : what was prepared last.
    ripples_on_device : whether the device steps ripples, where nothing on the CPU asks for them; NumPy does that faster
        than a software driver.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.bodies: list[Body] = []
        self.ripples_on_device = not device.is_software
        self.pipelines = Pipelines(device, NEAREST)
        self._targets: dict[str, Any] = {}
        self._nothing = _absent(device)
        self._light = WaterLight(device)
        self._glow: WaterGlow | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        screen = sum(t.width * t.height * (4 if t.format == DEPTH_FORMAT else 16) for t in self._targets.values())
        bodies = sum(body.waves.texels.nbytes + WaterParams.itemsize for body in self.bodies)
        bodies += sum(body.ripples.nbytes for body in self.bodies if body.ripples is not None)
        pictures = sum(body.pictures.nbytes for body in self.bodies if body.pictures is not None)
        return screen + self._light.nbytes + bodies + pictures + (self._glow.nbytes if self._glow is not None else 0)

    def prepare(self, items: Sequence[Water], surroundings: Surroundings) -> None:
        """Make waves resident that are new; parameters are written when waves are moved to a time."""
        before = list(self.bodies)
        self.bodies = [self._body(item, before, number) for number, item in enumerate(items)]

    def simulate(self, time_s: float) -> None:
        """Move the waves to a time, and write the parameters of every body of water."""
        for body in self.bodies:
            ripples = body.ripples
            surfaces = surfaces_of(body.item.waves, time_s, {ripples.layer: ripples} if ripples is not None else {})
            body.time_s = time_s
            moved = not same_surfaces(surfaces, body.waves.surfaces)
            if moved:
                self._move(body, surfaces)
            self._write(body)
            if ripples is not None:
                ripples.run(body.bindings["water"], time_s, moved)

    def _move(self, body: Body, surfaces: tuple[Any, ...]) -> None:
        body.version += 1
        if body.ripples is not None and len(surfaces) == 1:
            body.waves = replace(body.waves, surfaces=surfaces)  # the device has it all
            return
        body.waves = wave_maps(body.item, surfaces)
        if body.ripples is not None:
            body.waves = body.ripples.among(body.waves)
        self._upload(body)

    def illuminate(self, lights: Sequence[Any], surroundings: Surroundings) -> None:
        """Light below the surface: maps of what comes through it, kept until something of that moves."""
        self._light.update(self.bodies, lights, surroundings)

    def hides(self, view: View) -> Box | None:
        """The largest box whose every point lies below a surface that a view will see before it; None for none."""
        boxes = [hidden_box(body.item, body.waves.limits_m, view) for body in self.bodies]
        return max((box for box in boxes if box is not None), key=_breadth, default=None)

    def holds(self, camera: Camera) -> bool:
        """Whether a camera may be in a body of water: below its highest wave."""
        return any(_may_hold(body, camera) for body in self.bodies)

    def draw(
        self, encoder: Any, targets: Targets, camera: Camera, surroundings: Surroundings, timer: Any = None
    ) -> None:
        """Draw every body of water into colour and depth, far to near."""
        away = sorted(self.bodies, key=lambda body: _distance(body.item, camera), reverse=True)
        away.sort(key=lambda body: _may_hold(body, camera))
        for body in away:
            self._draw(encoder, body, targets, surroundings, timer)

    def _draw(self, encoder: Any, body: Body, targets: Targets, surroundings: Surroundings, timer: Any) -> None:
        top_m = body.item.level + body.waves.range_m[1]
        clip = surroundings.frame["clip_from_world"].T.astype(np.float64)
        low, high = body.item.box_m
        region = covered(low[::2], high[::2], top_m, clip, targets.size, low[1])
        if 0 in region[2:]:
            return
        copies = {
            "opaque_color": (targets.color, self._target("opaque_color", COLOR_FORMAT, targets.size)),
            "opaque_depth": (targets.depth, self._target("opaque_depth", DEPTH_FORMAT, targets.size)),
        }
        # From outside, nothing of what was drawn before shows through but by look-ups.
        outside = hidden_box(body.item, body.waves.limits_m, surroundings.view) is not None
        for name, (drawn, copy) in copies.items():
            if name == "opaque_depth" or not outside:
                size = (*targets.size, 1)
                encoder.copy_texture_to_texture({"texture": drawn}, {"texture": copy}, size)
        self._use_block(body, block_of(body.quality.shading_rate, surroundings.view) if outside else (1, 1))
        bound = {**self._nothing, **body.bindings, **surroundings.bindings, **self._light.bindings(body)}
        bound |= {name: copy for name, (_, copy) in copies.items()}
        quality = quality_seen_from(surroundings.view, body.quality, body.item.level, body.waves.range_m)
        if body.pictures is not None and needs_pictures(quality):
            waves = body.waves.limits_m, body.waves.slope
            body.pictures.draw(encoder, body.item, quality, waves, surroundings, timer)
            bound |= body.pictures.bindings
        sides = needs_pictures(quality) and body.border.shows(body.item, body.waves.limits_m[0], surroundings)
        constants = body.constants(quality, sides)
        shading = {**constants, **surroundings.shading_constants, **self._across(surroundings)}
        self._see(encoder, body.block, targets, region, bound, (constants, shading), timer)
        if body.quality.glow > 0.0:
            self._glow = self._glow or WaterGlow(self.device)
            constants = surroundings.shading_constants
            self._glow.draw(encoder, targets, bound, constants, body.quality.glow, timer)

    def _see(
        self,
        encoder: Any,
        block: Block,
        targets: Targets,
        region: Rectangle,
        bound: dict[str, Any],
        constants: tuple[dict[str, float], dict[str, float]],
        timer: Any,
    ) -> None:
        """A ray for every block of a region, and where those are no pixels, what each pixel has of those around it.

        `bound` gets the hits. Constants are those of search and shading.
        """
        shared = block != (1, 1)
        size = -(-targets.size[0] // block[0]), -(-targets.size[1] // block[1])
        hits = self._target("water_hits", HIT_FORMAT, size)
        seen = self._target("water_blocks", COLOR_FORMAT, size).create_view() if shared else targets.color_view
        on: dict[str, Any] = {"bindings": bound, "scissor": divided(region, block), "timer": timer}
        search = self._pass("find_sparse" if shared else "find", constants[0])
        search.run(
            encoder, [hits.create_view()], None if shared else targets.depth_view, NONE, label="water search", **on
        )
        bound["water_hits"] = hits
        shade = self._pass("compose", constants[1])
        shade.run(encoder, [seen], clear=NONE if shared else None, label="water shade", **on)
        if shared:
            bound["water_blocks"] = self._targets["water_blocks"]
            widen = self._pass("widen", constants[0])
            on["scissor"] = region
            widen.run(encoder, [targets.color_view], targets.depth_view, label="water widen", **on)

    def _use_block(self, body: Body, block: Block) -> None:
        if block != body.block:
            body.block, body.params["block"] = block, block
            record = body.params["block"].reshape(1, 2)
            self.device.write(body.bindings["water"], record, offset_of(WaterParams, "block"))

    def _across(self, surroundings: Surroundings) -> dict[str, float]:
        """Rays meet what stands for other things only where there are any."""
        constants = surroundings.across_constants
        return constants if len(self.bodies) > 1 or constants["ACROSS_GLASS"] else {}

    def _body(self, item: Water, before: list[Body], number: int) -> Body:
        if number < len(before) and before[number].item is item:
            return before[number]
        quality = quality_of(item.technique, item.quality)
        layer = ripples_for_device(self.device, item, quality) if self.ripples_on_device else None
        alike = (b for b in before if b.item.waves is item.waves and (b.ripples is None) == (layer is None))
        same = next(alike, None)
        if same is not None:
            kept = {name: same.bindings[name] for name in WAVE_NAMES}
            body = Body(item, quality, same.waves, kept, same.time_s, same.version, ripples=same.ripples)
        else:
            body = self._new_body(item, quality, layer)
        if number < len(before):
            body.border = before[number].border
        old = before[number].bindings if number < len(before) else {}
        if needs_pictures(quality):
            kept_pictures = before[number].pictures if number < len(before) else None
            body.pictures = kept_pictures or SurfacePictures(self.device)
        for name, layout in (("water", WaterParams), ("water_views", WaterViews)):
            body.bindings[name] = old.get(name) or self.device.buffer(layout.itemsize, "uniform", name)
        return body

    def _new_body(self, item: Water, quality: WaterQuality, layer: int | None) -> Body:
        ripples = RippleMaps(self.device, sources_of(item.waves)[layer], layer) if layer is not None else None
        waves = wave_maps(item, surfaces_of(item.waves, 0.0, {layer: ripples} if layer is not None else {}))
        body = Body(item, quality, waves, {"wave_sampler": self.device.sampler("linear", "repeat")}, ripples=ripples)
        self._upload(body)
        if ripples is not None:
            ripples.use(body.bindings["wave_texture"], body.bindings["moments_texture"])
            body.waves = replace(ripples.among(waves), surfaces=())  # nothing was worked out yet
        return body

    def _upload(self, body: Body) -> None:
        texels, moments = body.waves.texels, moment_levels(body.waves.texels)
        texture = body.bindings.get("wave_texture")
        layers, rows, columns = texels.shape[:3]
        if texture is None or tuple(texture.size) != (columns, rows, layers):
            kind = "rgba32float" if self.device.float32_filterable else "rgba16float"
            usage = ("sample", "copy") if body.ripples is None else ("sample", "copy", "storage")
            texture = self.device.texture(size=(columns, rows), format=kind, layers=layers, usage=usage, label="waves")
            body.bindings["wave_texture"] = texture
            body.bindings["wave_map"] = texture.create_view(dimension="2d-array")
            self._create_moments(body, kind, moments)
        self.device.write_texture(texture, texels)
        for mip, level in enumerate(moments):
            self.device.write_texture(body.bindings["moments_texture"], level, mip=mip)

    def _create_moments(self, body: Body, kind: str, moments: list[np.ndarray]) -> None:
        layers, rows, columns = moments[0].shape[:3]
        given: dict[str, Any] = {"format": kind, "layers": layers, "mips": len(moments), "label": "wave moments"}
        usage = ("sample", "copy") if body.ripples is None else ("sample", "copy", "storage")
        texture = self.device.texture(size=(columns, rows), usage=usage, **given)
        body.bindings["moments_texture"] = texture
        body.bindings["wave_moments"] = texture.create_view(dimension="2d-array")

    def _write(self, body: Body) -> None:
        body.params = parameters(body.item, body.quality, body.waves, body.time_s)
        body.params["block"] = body.block
        self.device.write(body.bindings["water"], body.params.reshape(1))

    def _pass(self, name: str, constants: dict[str, float]) -> RenderPass:
        options: dict[str, Any] = {"targets": (COLOR_FORMAT,)}
        if name in ("find", "find_sparse"):
            options["targets"] = (HIT_FORMAT,)
        if name in ("find", "widen"):
            options |= {"depth": DEPTH_FORMAT, "depth_compare": "greater-equal"}
        return self.pipelines.draw(f"techniques/water/shaders/{name}", constants, **options)

    def _target(self, name: str, format: str, size: tuple[int, int]) -> Any:
        kept = self._targets.get(name)
        if kept is None or (kept.width, kept.height) != size:
            usage = ("sample", "render", "copy")
            self._targets[name] = kept = self.device.texture(size=size, format=format, usage=usage, label=name)
        return kept


def _breadth(box: Box) -> float:
    low, high = box
    return (high[0] - low[0]) * (high[2] - low[2])


def _may_hold(body: Body, camera: Camera) -> bool:
    x, y, z = camera.position
    (x_low, z_low), (x_high, z_high) = body.item.bounds_m
    return x_low <= x <= x_high and z_low <= z <= z_high and y < body.item.level + body.waves.range_m[1]


def _distance(item: Water, camera: Camera) -> float:
    """From the camera to the nearest point of the surface at rest."""
    x, y, z = camera.position
    low, high = item.bounds_m
    nearest = np.clip((x, z), low, high)
    return float(np.hypot(np.hypot(*(nearest - (x, z))), y - item.level))


def _absent(device: Device) -> dict[str, Any]:
    """One texel for every picture that a body of water may not have."""
    image = device.texture(size=(1, 1), format="rgba16float", label="absent")
    stack = image.create_view(dimension="2d-array")
    names = ("wave_moments", "picture_colors", "picture_depths")
    return {name: stack for name in names} | {
        "view_sampler": device.sampler("linear", "clamp"),
        "picture_sampler": device.sampler("nearest", "clamp"),
    }
