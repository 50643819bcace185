"""The passes of a relief: what each pixel sees of it, then the radiance of that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Device, Pipelines, RenderPass
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.scene.relief_quality import quality_of
from pellucid.techniques.relief.body import Body, geometry_key, is_same, maps_key, moves, write_parameters
from pellucid.techniques.relief.cube import SceneCube
from pellucid.techniques.relief.frames import vertex_texels
from pellucid.techniques.relief.layouts import NEAREST, ReliefParams
from pellucid.techniques.relief.light import LightMaps, light_constants, mapped_lights, plane_of
from pellucid.techniques.relief.moving import MovingMaps, device_moves
from pellucid.techniques.relief.prepare import (
    Maps,
    hull,
    maps,
)
from pellucid.techniques.relief.screen import rectangle
from pellucid.techniques.relief.search_maps import search_bindings
from pellucid.techniques.relief.stand_in import stand_in

if TYPE_CHECKING:
    from pellucid.scene import Camera, Mesh, ReliefSurface
    from pellucid.surroundings import Surroundings

HIT_FORMAT = "rgba32uint"


class ReliefTechnique:
    """Draws `ReliefSurface` objects.

    Attributes
    ----------
    bodies : what was prepared last. pipelines : one for each choice that a relief was drawn with.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.bodies: list[Body] = []
        self.pipelines = Pipelines(device, NEAREST)
        self._hits: Any = None
        self._cubes: dict[int, SceneCube] = {}
        self._nothing = _absent(device)
        self._light_maps: list[LightMaps] = []
        self._stand_ins: list[tuple[ReliefSurface, Mesh]] = []

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        hits = 0 if self._hits is None else 16 * self._hits.width * self._hits.height
        return hits + sum(body.nbytes for body in self.bodies) + sum(maps.nbytes for maps in self._light_maps)

    def prepare(self, items: Sequence[ReliefSurface], surroundings: Surroundings) -> None:
        """Make maps and meshes resident that are new, and write the parameters of every surface."""
        before = list(self.bodies)
        self.bodies = [self._body(item, before, number) for number, item in enumerate(items)]
        self._cubes = {number: cube for number, cube in self._cubes.items() if number < len(items)}
        for body in self.bodies:
            write_parameters(body)
            self.device.write(body.bindings["relief"], body.params.reshape(1))

    def stand_ins(self, items: Sequence[ReliefSurface]) -> list[Mesh]:
        """What rays and shadow maps of others see of the surfaces; the same meshes until one of them changes."""
        kept = {_stand_in_key(item): mesh for item, mesh in self._stand_ins}
        self._stand_ins = [(item, kept.get(_stand_in_key(item)) or stand_in(item)) for item in items]
        return [mesh for _, mesh in self._stand_ins]

    def simulate(self, time_s: float) -> None:
        """Move the heights of layers that do to a time, and all that depends on them."""
        for body in self.bodies:
            item = body.item
            if not moves(item) or time_s == body.time_s:
                continue
            body.time_s, body.version = time_s, body.version + 1
            if body.moving is not None:
                body.moving.advance(time_s)
            else:
                body.maps = maps(item, body.hull.tile_m, self.device.float32_filterable, time_s, body.maps)
                self._rewrite(body)

    def _rewrite(self, body: Body) -> None:
        item, layers, quality = body.item, body.maps, body.quality
        changed = {"height_map": [layers.heights], "height_bounds": layers.bounds}
        if item.solid.is_dynamic:
            changed["solid_surface"] = [_four(s) for s in layers.solid]
        if item.translucent is not None and item.translucent.is_dynamic:
            changed["translucent_surface"] = [_four(s) for s in layers.translucent]
        for name, levels in changed.items():
            for mip, level in enumerate(levels):
                self.device.write_texture(body.bindings[name], level, mip=mip)
        if quality.complexity:
            two, tile_m = body.two_layers, body.hull.tile_m
            of_quality = (quality.search, quality.complexity)
            body.bindings |= search_bindings(self.device, *of_quality, layers.heights, two, tile_m, item.tiling)

    def illuminate(self, lights: Sequence[Any], surroundings: Surroundings) -> None:
        """Light from the lamps' side; kept until lamps, heights or placement change.

        Maps are true where each texel stands for one place, or many alike: on plane meshes, for lamps far away or one
        tile. Elsewhere every fragment sends rays.
        """
        while len(self._light_maps) < len(self.bodies):
            self._light_maps.append(LightMaps(self.device, self.pipelines))
        for body, light_maps in zip(self.bodies, self._light_maps, strict=False):
            self._illuminate(body, light_maps, lights, surroundings)

    def _illuminate(self, body: Body, light_maps: LightMaps, lights: Sequence[Any], surroundings: Surroundings) -> None:
        plane = None
        if body.quality.occlusion == "texture" or body.quality.caustics:
            plane = plane_of(body.hull, body.params["world_from_object"].T)
        mapped = 0 if plane is None else mapped_lights(lights, body.hull)
        body.light_constants = light_constants(body.quality, lights, mapped)
        body.params["mapped_lights"] = mapped
        self.device.write(body.bindings["relief"], body.params.reshape(1))
        if body.quality.shadows == "horizon":
            solid, heights = body.item.solid, body.maps.heights[..., 0]
            kept = body.maps.heights if solid.is_dynamic else solid
            of_body = (body.hull.tile_m, body.item.tiling, kept)
            body.bindings["horizon_map"] = light_maps.horizon(heights, *of_body)
        if plane is not None and mapped:
            bound = {**self._nothing, **body.bindings, **surroundings.bindings}
            state = (tuple(lights), body.bindings["height_map"], body.version)
            light_maps.update(bound, body.params, plane, len(lights), body.constants, state)
        body.bindings |= light_maps.bindings

    def draw(
        self, encoder: Any, targets: Targets, camera: Camera, surroundings: Surroundings, timer: Any = None
    ) -> None:
        """Draw every surface into colour and depth, before what is there only where it is nearer."""
        hits = self._hit_target(targets.size)
        for number, body in enumerate(self.bodies):
            if body.quality.environment.startswith("cube"):
                self._look_around(encoder, number, body, surroundings, timer)
            p = body.params
            seen = rectangle(
                body.hull,
                (float(p["hull_low"]), float(p["hull_high"])),
                (p["world_from_object"] @ surroundings.frame["clip_from_world"]).T,
                targets.size,
            )
            if seen is None:
                continue
            shared = {**self._nothing, **body.bindings, **surroundings.bindings}
            self._pass("find", body.constants).run(
                encoder,
                color=[hits.create_view()],
                depth=targets.depth_view,
                clear=[(0.0, 0.0, 0.0, 0.0)],
                bindings=shared,
                vertices=len(body.hull.vertices),
                scissor=seen,
                timer=timer,
                label="relief search",
            )
            rays = body.quality.environment == "rays" and self._meets_meshes(body, surroundings)
            constants = {**body.constants, **surroundings.shading_constants, "RELIEF_RAYS": float(rays)}
            constants |= surroundings.across_constants if body.quality.environment == "rays" else {}
            constants["LAMPS_OCCLUDED"] = float(self._meets_meshes(body, surroundings))
            self._pass("compose", constants).run(
                encoder,
                color=[targets.color_view],
                bindings={**shared, "relief_hits": hits},
                scissor=seen,
                timer=timer,
                label="relief shade",
            )

    def _meets_meshes(self, body: Body, surroundings: Surroundings) -> bool:
        """Whether rays that leave a surface can meet any: one that lies in a plane does not meet what stands for it."""
        if len(self.bodies) == 1 and surroundings.shown_meshes == 0:
            return body.hull.plane is None
        return surroundings.triangle_count > 0

    def _look_around(self, encoder: Any, number: int, body: Body, surroundings: Surroundings, timer: Any) -> None:
        """Draw the cube of a body, if it has none where it stands, or wants one for every picture."""
        again = body.quality.environment == "cube_every_frame" and surroundings.sample_index == 0
        if number not in self._cubes:
            self._cubes[number], again = SceneCube(self.device), True
        cube, center_ws = self._cubes[number], body.params["world_from_object"][3, :3]
        if again or not cube.belongs_to(body.item.mesh, center_ws):
            cube.draw(encoder, body.item.mesh, center_ws, surroundings, timer)
        body.bindings["scene_cube"] = cube.view

    def _body(self, item: ReliefSurface, before: list[Body], number: int) -> Body:
        """A body whose geometry and maps are taken from those before where they are the same."""
        of_geometry, bindings, nbytes = geometry_key(item), {}, ReliefParams.itemsize
        same = next((b for b in before if is_same(b.geometry_key, of_geometry)), None)
        shape = same.hull if same else hull(item)
        if same:
            bindings["relief_vertices"] = same.bindings["relief_vertices"]
        else:
            texels = vertex_texels(shape.vertices)
            bindings["relief_vertices"] = self.device.texture(texels, format="rgba32float", label="relief vertices")
        quality = quality_of(item.technique, item.quality)
        if moves(item) and quality.search in ("cone", "distance"):
            # Bounds are new in a moment; maps of free space are not, and find nothing that bounds do not.
            quality = quality.replace(search="max_mip")
        two_layers = item.draws_translucent
        if not two_layers:
            quality = quality.replace(caustics=False)  # nothing focuses light
        on_device = moves(item) and device_moves(self.device, item, quality)
        of_maps = [*maps_key(item, shape.tile_m), quality.search, quality.complexity, two_layers, on_device]
        alike = next((b for b in before if is_same(b.maps_key, of_maps)), None)
        layers = alike.maps if alike else maps(item, shape.tile_m, self.device.float32_filterable)
        if alike:
            bindings |= {name: alike.bindings[name] for name in MAP_NAMES if name in alike.bindings}
        else:
            bindings |= self._upload(layers, item.tiling, on_device)
            of_quality = (quality.search, quality.complexity)
            bindings |= search_bindings(self.device, *of_quality, layers.heights, two_layers, shape.tile_m, item.tiling)
        nbytes += shape.vertices.nbytes + sum(a.nbytes for a in (layers.heights, *layers.bounds))
        nbytes += 8 * sum(level.shape[0] * level.shape[1] for level in (*layers.solid, *layers.translucent))
        if number < len(before):
            bindings["relief"] = before[number].bindings["relief"]
        else:
            bindings["relief"] = self.device.buffer(ReliefParams.itemsize, "uniform", "relief")
        body = Body(item, quality, shape, layers, bindings, of_geometry, of_maps, nbytes)
        if alike:
            body.time_s, body.version, body.moving = alike.time_s, alike.version, alike.moving
        elif on_device:
            others = [b.moving for b in before if b.moving is not None]
            body.moving = MovingMaps(self.device, item, shape.tile_m, bindings, others)
            body.nbytes += body.moving.nbytes
        return body

    def _upload(self, layers: Maps, tiling: bool, written: bool) -> dict[str, Any]:
        """Textures and samplers; `written` ones a kernel may write to."""
        address = "repeat" if tiling else "clamp"
        filterable = self.device.float32_filterable
        slopes = [_four(s) for s in layers.solid], [_four(s) for s in layers.translucent]
        return {
            "height_map": self._texture([layers.heights], f"rg{32 if filterable else 16}float", "heights", written),
            "height_sampler": self.device.sampler("linear", address),
            "height_bounds": self._texture(layers.bounds, "rgba32float", "height bounds", written),
            "solid_surface": self._texture(slopes[0], "rgba16float", "solid slopes", written),
            "translucent_surface": self._texture(slopes[1], "rgba16float", "slopes", written),
            "color_map": self._texture([_four(c) for c in layers.colors], "rgba16float", "colours"),
            "surface_sampler": self.device.sampler("linear", address),
        }

    def _texture(self, levels: Sequence[np.ndarray], format: str, label: str, written: bool = False) -> Any:
        height, width = levels[0].shape[:2]
        usage = ("sample", "storage") if written else ("sample",)
        texture = self.device.texture(size=(width, height), format=format, mips=len(levels), usage=usage, label=label)
        for mip, level in enumerate(levels):
            self.device.write_texture(texture, level, mip=mip)
        return texture

    def _pass(self, name: str, constants: dict[str, float]) -> RenderPass:
        options: dict[str, Any] = {"targets": (COLOR_FORMAT,)}
        if name == "find":
            options = {"targets": (HIT_FORMAT,), "depth": DEPTH_FORMAT, "depth_compare": "greater", "cull": "back"}
        return self.pipelines.draw(f"techniques/relief/shaders/{name}", constants, **options)

    def _hit_target(self, size: tuple[int, int]) -> Any:
        if self._hits is None or (self._hits.width, self._hits.height) != size:
            usage = ("sample", "render")
            self._hits = self.device.texture(size=size, format=HIT_FORMAT, usage=usage, label="relief hits")
        return self._hits


MAP_NAMES = (
    *("height_map", "height_sampler", "height_bounds", "solid_surface", "translucent_surface"),
    *("color_map", "surface_sampler", "cone_map", "distance_map", "complexity_map"),
)


def _stand_in_key(item: ReliefSurface) -> tuple[Any, ...]:
    where = (item.tiles, item.tile_m, item.position, item.rotation, item.scale)
    return (id(item.mesh), id(item.solid), *where)


def _four(image: np.ndarray) -> np.ndarray:
    missing = 4 - image.shape[2]
    return np.pad(image, ((0, 0), (0, 0), (0, missing)), constant_values=1.0 if missing == 1 else 0.0)


def _absent(device: Device) -> dict[str, Any]:
    """One texel for every map that a surface may not have."""
    image = device.texture(size=(1, 1), format="rgba16float", label="absent")
    stack = device.texture(size=(1, 1), format="rgba16float", label="absent").create_view(dimension="2d-array")
    volume = device.texture(format="r16float", size=(1, 1, 1), dimension="3d", label="absent")
    cube = device.texture(size=(1, 1), format="rgba16float", layers=6, label="absent").create_view(dimension="cube")
    names = ("cone_map", "complexity_map")
    stacks = ("horizon_map", "light_map", "relief_caustic_map")
    rest = {"distance_map": volume, "scene_cube": cube}
    return {name: image for name in names} | {name: stack for name in stacks} | rest
