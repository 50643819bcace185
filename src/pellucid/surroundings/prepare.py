"""Put the surroundings of a scene on the GPU, and only what changed since the last time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.surroundings import environment, geometry, lights, maps
from pellucid.surroundings.camera import View, view_of, write_view
from pellucid.surroundings.caustics import CausticMaps
from pellucid.surroundings.interfaces import Interface, join, matter_records, together
from pellucid.surroundings.layouts import MATERIAL_CASTS_SHADOW, MATERIAL_UNSEEN, FrameParams, Light
from pellucid.surroundings.submersion import SkyThroughSurface, Submersion, sky_through, small_sky

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.scene import Camera, Environment, Mesh, Scene, Water

RAY_EPSILON = 2e-6  # of the largest coordinate: some rounding steps of a 32-bit float


class Surroundings:
    """What a ray that leaves refractive matter sees: environment, opaque meshes, lights.

    Parameters
    ----------
    device : where the resources live.

    Attributes
    ----------
    light_count : lamps.
    triangle_count : triangles of all opaque meshes.
    mesh_bounds_ws : (lower, upper) corner in metres of each opaque mesh.
    shadow_version : grows whenever the shadow maps are out of date.
    shadow_views : one depth view for each shadow map, in the order of their layers.
    shadow_lights : which light of the scene each shadow map belongs to.
    caustics : light of refractive matter on the meshes.
    view : the camera, as `set_camera` was told.
    submersion : water that they stand in. waters : of the scene, as it describes them.
    """

    view: View

    def __init__(self, device: Device) -> None:
        self.device = device
        self.light_count = 0
        self.triangle_count = 0
        self.mesh_bounds_ws: list[tuple[np.ndarray, np.ndarray]] = []
        self.shadow_version = 0
        self.shadow_views: list[Any] = []
        self.shadow_lights: list[int] = []
        self._seen: dict[str, list[Any]] = {}
        self._frame = np.zeros((), FrameParams)
        self._resources: dict[str, Any] = {
            "frame": device.buffer(self._frame, "uniform", "frame"),
            "env_sampler": device.sampler("linear", ("repeat", "clamp", "clamp")),
            "base_color_sampler": device.sampler("linear", "repeat"),
            "shadow_sampler": device.sampler("linear", "clamp", compare="less-equal"),
        }
        self._sizes: dict[str, int] = {}
        self._version = 0
        self._geometry = geometry.gather(())
        self._layers: list[int] = []
        self._map_size = 1
        self._shown = 0
        self._interfaces: Sequence[Interface] = ()
        self._casters: list[list[bool]] = []
        self._lamp_kinds = lights.lamp_constants(np.zeros(0, Light))
        self._far_lamps = 0
        self._albedo = geometry.albedo(())
        self.caustics = CausticMaps(device, self._resources)
        self.waters: tuple[Water, ...] = ()
        self.submersion = Submersion(device, self._resources)
        self._viewed: tuple[Camera, tuple[int, int]] | None = None
        self._aimed: tuple[tuple[float, float], int] | None = None
        self._sky = np.zeros((1, 2, 3))
        self._through: dict[tuple[float, ...], SkyThroughSurface] = {}

    @property
    def bindings(self) -> dict[str, Any]:
        """Resources of bind group 1 by their WGSL names."""
        return self._resources

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the picture in pixels."""
        return int(self._frame["size"][0]), int(self._frame["size"][1])

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        return FrameParams.itemsize + sum(self._sizes.values()) + self.caustics.nbytes + self.submersion.nbytes

    @property
    def geometry(self) -> geometry.Geometry:
        """The triangles of all opaque meshes, in the order of the GPU's; the same object until one of them changes."""
        return self._geometry

    @property
    def shading_constants(self) -> dict[str, float]:
        """Override constants of every shader that shades meshes; they tell kinds of lamps, not where one is."""
        regions = self.submersion.regions
        own = {
            "CAUSTICS": float(self.caustics.active),
            "SUBMERGED": float(self.submersion.active),
            "LAMPS": float(self.light_count),
            "SUBMERGED_OUTLINES": float(self.submersion.outlined),
            "MAPS_ALONG": float(all(region.along for region in regions)),
            "ASTRAY": float(any(any(region.scattering_per_m) for region in regions)),
        }
        return {**own, "LAMPS_OCCLUDED": float(self.triangle_count > 0), **self._lamp_kinds}

    @property
    def across_constants(self) -> dict[str, float]:
        """Override constants of shaders whose rays meet what stands for water and glass."""
        return {"ACROSS_WATER": float(self.submersion.active), "ACROSS_GLASS": float(bool(self._interfaces))}

    @property
    def sun_may_be_apart(self) -> bool:
        """Whether all that waves change of the light on meshes is one map, of one lamp and one water."""
        regions = self.submersion.regions
        if len(regions) != 1 or self.caustics.active:
            return False
        return self._far_lamps == 1 and bool(regions[0].slopes) and not any(regions[0].near)

    def state(self, waters: bool = True) -> tuple[Any, ...]:
        """What pictures of the meshes depend on, but for the camera: equal to an earlier one while they are the same.

        Parameters
        ----------
        waters : whether light in water counts.
        """
        own = (self, self._version, self.shadow_version, self.caustics.version)
        return (*own, self.submersion.version) if waters else own

    @property
    def frame(self) -> np.ndarray:
        """The frame parameters as last uploaded, a copy."""
        return self._frame.copy()

    @property
    def shown_meshes(self) -> int:
        """How many meshes the picture shows: those of the scene, without stand-ins."""
        return self._shown

    def prepare(
        self,
        scene: Scene,
        size: tuple[int, int],
        stand_ins: Sequence[Mesh] = (),
        interfaces: Sequence[Interface] = (),
    ) -> None:
        """Upload what differs from the last call; the parts of a scene are told apart by identity.

        Parameters
        ----------
        scene : the scene. size : (width, height) of the picture in pixels.
        stand_ins : meshes that rays and lamps meet, but the picture does not show, since a technique draws better.
        interfaces : the same of transparent matter, met by rays that ask for it (`across_constants`); told apart by
            identity.
        """
        from pellucid.scene import Mesh, Water

        self.waters = tuple(o for o in scene.objects if isinstance(o, Water))
        meshes = [o for o in scene.objects if isinstance(o, Mesh)] + list(stand_ins)
        self._shown = len(meshes) - len(stand_ins)
        try:
            moved = self._prepare_geometry(meshes, interfaces)
            self._prepare_maps(meshes)
            self._prepare_materials(meshes, relit=self._prepare_lights(scene.lights, moved))
            self._prepare_environment(scene.environment)
        except Exception:
            self._seen.clear()  # what was uploaded is now uncertain
            raise
        self.light_count = len(scene.lights)
        self._frame["light_count"] = self.light_count
        self.set_camera(scene.camera, size)

    def sky_through(self, n: tuple[float, float, float]) -> SkyThroughSurface:
        """Light of the environment just below level water; `n` is its index by channel over that of what is above."""
        if n not in self._through:
            self._through[n] = sky_through(self._sky, self._frame["environment_sh"][:, :3].astype(np.float64), n)
        return self._through[n]

    def shade_sky(self) -> None:
        """Find what meshes hide of the sky from what lies in the waters that `submersion` knows."""
        turn = float(self._frame["environment_rotation"][0]), float(self._frame["environment_rotation"][1])
        if self.submersion.open_sky.update(self.submersion.regions, self._geometry, self._albedo, self._sky, turn):
            self.submersion.version += 1
            self.submersion.settled += 1

    def set_camera(
        self,
        camera: Camera,
        size: tuple[int, int],
        jitter: tuple[float, float] = (0.0, 0.0),
        sample_index: int = 0,
    ) -> None:
        """Change the view; writes the frame parameters and nothing else.

        Parameters
        ----------
        camera : the view. size : (width, height) of the picture in pixels.
        jitter : offset of the sampled point from each pixel's centre, pixels right and down.
        sample_index : number of the picture among those that are averaged.
        """
        if self._viewed != (camera, size):
            self._viewed, self.view = (camera, size), view_of(camera, size)
            self._aimed = None
        # The environment's size decides which of its levels is as sharp as the picture.
        aimed = jitter, int(self._frame["environment_height"])
        if self._aimed != aimed:
            self._aimed = aimed
            write_view(self._frame, self.view, size, jitter)
        self._frame["sample_index"] = sample_index
        self.device.write(self._resources["frame"], self._frame.reshape(1))

    def frame_of(self, view: View, size: tuple[int, int]) -> np.ndarray:
        """(1,) frame parameters of another view of the same scene, of `size` (width, height) pixels."""
        record = self._frame.copy()
        write_view(record, view, size)
        return record.reshape(1)

    @property
    def sample_index(self) -> int:
        """Number of the picture among those that are averaged, as `set_camera` was told."""
        return int(self._frame["sample_index"])

    def _prepare_geometry(self, meshes: Sequence[Mesh], interfaces: Sequence[Interface]) -> bool:
        state = [_placement(m) for m in meshes]
        moved = self._changed("geometry", [part for mesh in state for part in mesh])
        if moved:
            self._geometry = geometry.gather(meshes)
        joined_anew = self._changed("interfaces", [len(meshes), *interfaces])
        if moved or joined_anew:
            self._interfaces = tuple(interfaces)
            self._store_triangles(len(meshes))
        return moved

    def _store_triangles(self, meshes: int) -> None:
        """Meshes and interfaces on the device; the atlas of caustics is made anew for them."""
        self.caustics.drop()
        own = self._geometry
        joined = join((own.nodes, own.triangles, own.attributes), own.count, self._interfaces, max(meshes, 1))
        self._store("bvh_nodes", joined.nodes)
        self._store("bvh_triangles", joined.triangles)
        self._store("triangle_attributes", joined.attributes)
        self._frame["joint_root"] = joined.root
        self.triangle_count = self._geometry.count
        self.mesh_bounds_ws = self._geometry.bounds
        self._frame["triangle_count"] = self._geometry.count
        self._frame["ray_epsilon_m"] = RAY_EPSILON * self._geometry.scale_m

    def _prepare_maps(self, meshes: Sequence[Mesh]) -> None:
        images = [m.base_color_map for m in meshes]
        if self._changed("maps", images):
            levels, self._layers = maps.stack_maps(images)
            self._map_size = levels[0].shape[1]
            self._store_texture("base_color_maps", levels, "rgba16float", "2d-array")

    def _prepare_lights(self, lamps: Sequence[object], moved: bool) -> bool:
        if not self._changed("lights", list(lamps)) and not moved:
            return False
        records, self._casters = lights.light_records(lamps, self._geometry.corners)
        self._store("lights", records)
        self.shadow_lights = lights.shadow_order(records)
        self._lamp_kinds = lights.lamp_constants(records[: len(lamps)])
        self._far_lamps = lights.far_over_water(records)
        self._prepare_shadows(len(self._casters))
        return True

    def _prepare_materials(self, meshes: Sequence[Mesh], relit: bool) -> None:
        if not self._changed("materials", [*meshes, self._shown, *self._interfaces]) and not relit:
            return
        own = geometry.materials(meshes, self._geometry, self._layers, self._map_size)
        records = together(own, matter_records(self._interfaces))
        for layer, casts in enumerate(self._casters):
            records["flags"][: len(casts)] |= np.uint32(MATERIAL_CASTS_SHADOW << layer) * np.array(casts)
        records["flags"][self._shown : len(meshes)] |= MATERIAL_UNSEEN
        self._albedo = geometry.albedo(meshes)
        self._store("materials", records)

    def _prepare_shadows(self, layers: int) -> None:
        self.shadow_version += 1
        if len(self.shadow_views) == layers and "shadow_maps" in self._resources:
            return
        side = lights.SHADOW_SIZE if layers else 1
        texture = self.device.texture(
            size=(side, side),
            format="depth32float",
            layers=max(layers, 1),
            usage=("sample", "render"),
            label="shadow maps",
        )
        self._resources["shadow_maps"] = texture.create_view(dimension="2d-array")
        self._sizes["shadow_maps"] = 4 * side * side * max(layers, 1)
        self.shadow_views = [
            texture.create_view(dimension="2d", base_array_layer=k, array_layer_count=1) for k in range(layers)
        ]

    def _prepare_environment(self, sky: Environment) -> None:
        angle = np.radians(sky.rotation_deg)
        self._frame["environment_rotation"] = np.cos(angle), np.sin(angle)
        self._frame["environment_intensity"] = sky.intensity
        if not self._changed("environment", [sky.pixels]):
            return
        levels = environment.mip_levels(sky.pixels)
        self._frame["environment_sh"][:, :3] = environment.irradiance_sh(levels[0])
        self._frame["environment_height"] = levels[0].shape[0]
        self._frame["environment_max_lod"] = len(levels) - 1
        self._sky, self._through = small_sky(levels), {}
        self._store_environment("env_map", levels)
        self._store_environment("env_glossy", environment.glossy_levels(levels))

    def _store_environment(self, name: str, levels: list[np.ndarray]) -> None:
        filterable = self.device.float32_filterable
        if not filterable:
            levels = [np.minimum(level, environment.HALF_MAX) for level in levels]
        rgba = [np.pad(level, ((0, 0), (0, 0), (0, 1)), constant_values=1.0)[None] for level in levels]
        self._store_texture(name, rgba, "rgba32float" if filterable else "rgba16float", "2d")

    def _changed(self, part: str, state: list[Any]) -> bool:
        """Whether a part of the scene differs from the last call; objects are kept so that no id returns."""
        before = self._seen.get(part)
        same = before is not None and len(before) == len(state)
        same = same and all(_same(a, b) for a, b in zip(before or [], state, strict=False))
        self._seen[part] = state
        return not same

    def _store(self, name: str, records: np.ndarray) -> None:
        self._version += 1
        buffer = self._resources.get(name)
        if buffer is not None and self._sizes[name] == records.nbytes:
            self.device.write(buffer, records)
            return
        self._resources[name] = self.device.buffer(records, "storage", name)
        self._sizes[name] = records.nbytes

    def _store_texture(self, name: str, levels: list[np.ndarray], format: str, dimension: str) -> None:
        """Levels are (layers, H, W, 4), finest first."""
        self._version += 1
        layers, height, width = levels[0].shape[:3]
        texture = self.device.texture(
            size=(width, height),
            format=format,
            layers=layers,
            mips=len(levels),
            usage=("sample", "copy"),
            label=name,
        )
        for mip, level in enumerate(levels):
            self.device.write_texture(texture, level, mip=mip)
        self._resources[name] = texture.create_view(dimension=dimension)
        bytes_per_texel = 16 if format == "rgba32float" else 8
        self._sizes[name] = sum(level.size // 4 for level in levels) * bytes_per_texel


def _placement(mesh: Mesh) -> list[Any]:
    arrays = [mesh.vertices, mesh.faces, mesh.normals, mesh.uvs]
    return [*arrays, mesh.position, mesh.rotation, mesh.scale, mesh.double_sided]


def _same(a: Any, b: Any) -> bool:
    return a is b or (isinstance(a, tuple | float | int | bool) and type(a) is type(b) and bool(a == b))
