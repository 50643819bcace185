"""From scene objects to the parts of a scene file; what has no recipe is written beside it as arrays."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from pellucid import media
from pellucid.errors import SceneError
from pellucid.media import Medium, WaterBody
from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.scene.choices import Choices
from pellucid.scene.environment import Environment
from pellucid.scene.lights import AreaLight, DirectionalLight, PointLight
from pellucid.scene.mesh import Mesh
from pellucid.scene.refractive_sheet import PICTURES, RefractiveSheet
from pellucid.scene.refractive_volume import RefractiveVolume
from pellucid.scene.relief_surface import MAPS, ReliefLayer, ReliefSurface
from pellucid.scene.scene import Scene
from pellucid.scene.water import Water

CRYSTAL = ("optic_axis", "delta_n_e")
LIGHT_TYPES: dict[type, str] = {DirectionalLight: "directional", PointLight: "point", AreaLight: "area"}
LOOKS: dict[type, tuple[str, ...]] = {
    Mesh: (
        *("position", "rotation", "scale", "base_color", "roughness", "specular", "emission"),
        *("double_sided", "shading"),
    ),
    RefractiveVolume: (
        *("position", "rotation", "scale", "boundary", "dispersion", "spectral", "smoothing_voxels"),
        *("gradient", "surroundings", "quality", "light", "gloss"),
    ),
    ReliefSurface: (
        *("position", "rotation", "scale", "ambient_n", "tile_m", "tiles", "tiling", "technique", "quality"),
        *("dispersion", "absorption", "scattering", "specular_factor", "edges"),
    ),
    Water: (
        *("level", "extent_m", "center", "ambient_n", "technique", "quality", "foam", "color", "clarity_per_m"),
        *("dispersion", "outline", "depth_m", "floor", "floor_scale"),
    ),
    RefractiveSheet: (
        *("position", "rotation", "scale", "depth_m", "size_m", "segments", "motion_fps", "ambient_n", "refraction"),
        *("factor", "fit_angle_deg", "per", "borders", "deviation_m", "reflection", "sphere_rule", "blend", "lit"),
        *("meshes", "absorption", "show", "error_scale"),
    ),
    ReliefLayer: ("height_m", "base_m", "roughness", "specular", "normal_convention"),
}


class Sidecars:
    """Files written beside a scene file, named after it; taken back if the scene cannot be finished."""

    def __init__(self, scene_file: Path) -> None:
        self.scene_file = scene_file
        self._new: list[Path] = []

    def relative(self, path: str | Path) -> str:
        """`path` as the scene file states it: relative to its folder where that is possible."""
        try:
            return Path(os.path.relpath(path, self.scene_file.parent.resolve())).as_posix()
        except ValueError:  # another drive
            return Path(path).as_posix()

    def arrays(self, label: str, arrays: Mapping[str, np.ndarray]) -> str:
        """Writes an .npz and returns its name."""
        from pellucid.io.volumes import write_arrays

        path = self._path(label, ".npz")
        write_arrays(path, arrays)
        return path.name

    def picture(self, label: str, pixels: np.ndarray) -> str:
        """Writes an .exr and returns its name."""
        from pellucid.io.images import write_image

        path = self._path(label, ".exr")
        write_image(path, pixels)
        return path.name

    def take_back(self) -> None:
        """Removes every file that was not there before."""
        for path in self._new:
            with suppress(OSError):  # on a read-only file system there is nothing to remove
                path.unlink(missing_ok=True)

    def _path(self, label: str, suffix: str) -> Path:
        path = self.scene_file.with_name(f"{self.scene_file.stem}.{label}{suffix}")
        if not path.exists():
            self._new.append(path)
        return path


def describe_scene(scene: Scene, beside: Sidecars) -> dict[str, Any]:
    """The scene as plain dictionaries, lists, numbers and strings; defaults are left out."""
    described: dict[str, Any] = _stated(scene, ("exposure", "tone_mapping", "glow"))
    described["camera"] = _stated(scene.camera, [f.name for f in dataclasses.fields(scene.camera)])
    described["environment"] = _environment(scene.environment, beside)
    described["lights"] = [_light(light, i) for i, light in enumerate(scene.lights)]
    described["objects"] = [_object(thing, f"object-{i}", i, beside) for i, thing in enumerate(scene.objects)]
    return described


def describe_medium(medium: Any, where: str) -> str | float | dict[str, Any]:
    """A medium as a scene file names it.

    Raises
    ------
    SceneError : a medium of the user's own formula, which a file cannot state.
    """
    found = media.resolve(medium)
    if _same(found, found.name):
        return found.name
    clear = found.absorption_per_m == (0.0, 0.0, 0.0)
    if not found.is_dispersive:
        base: str | float = found.n_d
    else:
        waters = [isinstance(media.get(name), WaterBody) for name in media.names()]
        others = [name for name, water in zip(media.names(), waters, strict=True) if not water]
        named = [name for name in others if _same_indices(media.get(name), found)]
        if not named:
            raise SceneError(where, f"{found.name!r} has a formula of its own", "use a medium of pellucid.media")
        base = next((name for name in named if media.get(name).source == found.source), named[0])
    if clear and not isinstance(base, str) and not found.is_uniaxial and not isinstance(found, WaterBody):
        return base
    described = {"base": base, "absorption_rgb_per_m": list(found.absorption_per_m), "name": found.name}
    if isinstance(found, WaterBody):
        described["scattering_rgb_per_m"] = found.scattering_rgb_per_m.tolist()
        described["asymmetry"] = found.asymmetry
    if found.extraordinary is not None:
        described["absorption_e_rgb_per_m"] = list(found.extraordinary.absorption_per_m)
        described |= {} if isinstance(base, str) else {"base_e": found.extraordinary.n_d}
    return described


def _same_indices(a: Medium, b: Medium) -> bool:
    rays = a.extraordinary, b.extraordinary
    both = None not in rays and rays[0].formula == rays[1].formula  # type: ignore[union-attr]
    return a.formula == b.formula and (both or rays == (None, None))


def _same(medium: Medium, name: str) -> bool:
    try:
        return bool(media.get(name) == medium)
    except SceneError:
        return False


def _environment(environment: Environment, beside: Sidecars) -> dict[str, Any]:
    if environment.origin is None:
        source: dict[str, Any] = {"file": beside.picture("environment", environment.pixels)}
    else:
        source = _plain(environment.origin.recipe)
        if "file" in source:
            source["file"] = beside.relative(source["file"])
    return source | _stated(environment, ("intensity", "rotation_deg"))


def _light(light: Any, index: int) -> dict[str, Any]:
    if type(light) not in LIGHT_TYPES:
        raise SceneError(f"lights[{index}]", f"a {type(light).__name__} cannot be written to a scene file")
    return {"type": LIGHT_TYPES[type(light)], **_stated(light, [f.name for f in dataclasses.fields(light)])}


def _object(thing: Any, label: str, index: int, beside: Sidecars) -> dict[str, Any]:
    if isinstance(thing, Mesh):
        return {"type": "mesh", **_mesh(thing, label, beside), **_stated(thing, LOOKS[Mesh])}
    if isinstance(thing, RefractiveVolume):
        source = _volume(thing, label, f"objects[{index}].medium", beside)
        look = _stated(thing, LOOKS[RefractiveVolume])
        if thing.boundary == ("sharp" if thing.volume.regions else "smooth"):
            look.pop("boundary", None)  # what "auto" would choose
        look |= _brdf(thing.brdf, label, beside) | _proxy(thing.proxy, label, beside)
        return {"type": "refractive_volume", **source, **look}
    if isinstance(thing, ReliefSurface):
        layers = {"solid": _relief_layer(thing.solid, f"{label}.solid", beside)}
        if thing.translucent is not None:
            layers["translucent"] = _relief_layer(thing.translucent, f"{label}.translucent", beside)
        medium = {"medium": describe_medium(thing.medium, f"objects[{index}].medium")}
        mesh = _geometry(thing.mesh, f"{label}.mesh", beside) | _stated(thing.mesh, ("shading",))
        return {"type": "relief_surface", "mesh": mesh, **layers, **medium, **_stated(thing, LOOKS[ReliefSurface])}
    if isinstance(thing, Water):
        where = f"objects[{index}]"
        medium = {"medium": describe_medium(thing.medium, f"{where}.medium")}
        waves = {} if thing.waves is None else {"waves": _waves(thing.waves, label, where, beside)}
        return {"type": "water", **medium, **_stated(thing, LOOKS[Water]), **waves}
    if isinstance(thing, RefractiveSheet):
        medium = {"medium": describe_medium(thing.medium, f"objects[{index}].medium")}
        return {"type": "refractive_sheet", **_sheet(thing, label, f"objects[{index}]", beside), **medium}
    raise SceneError(f"objects[{index}]", f"a {type(thing).__name__} cannot be written to a scene file")


def _waves(waves: Any, label: str, where: str, beside: Sidecars) -> dict[str, Any]:
    from pellucid.fields.waves import to_plain

    try:
        plain, arrays = to_plain(waves)
    except SceneError as error:
        raise SceneError(f"{where}.{error.field}", error.reason, error.remedy) from error
    return plain | ({"arrays": beside.arrays(f"{label}.waves", arrays)} if arrays else {})


def _sheet(sheet: RefractiveSheet, label: str, where: str, beside: Sidecars) -> dict[str, Any]:
    """Pictures by name or beside the file, heights and positions as arrays; a formula cannot be stated."""
    said: dict[str, Any] = {}
    if callable(sheet.motion):
        raise SceneError(f"{where}.motion", "is a function, which no scene file can state", "store positions (T, V, 3)")
    if sheet.waves is not None and not isinstance(sheet.waves, np.ndarray):
        said["waves"] = _waves(sheet.waves, label, where, beside)
    arrays = {name: value for name in ("waves", "motion") if isinstance(value := getattr(sheet, name), np.ndarray)}
    if arrays:
        said["arrays"] = beside.arrays(label, arrays)
    for name in PICTURES:
        pixels = getattr(sheet, name)
        if name in sheet.files:
            said[name] = beside.relative(sheet.files[name][0])
        elif pixels is not None:
            said[name] = beside.picture(f"{label}.{name}", pixels)
    if sheet.mesh is not None:
        said["mesh"] = _geometry(sheet.mesh, f"{label}.mesh", beside) | _stated(sheet.mesh, ("shading",))
    return said | _stated(sheet, LOOKS[RefractiveSheet])


def _proxy(proxy: str | Mesh, label: str, beside: Sidecars) -> dict[str, Any]:
    if isinstance(proxy, str):
        return {} if proxy == "box" else {"proxy": proxy}
    if proxy.origin is not None and "file" in proxy.origin.recipe:
        return {"proxy": beside.relative(proxy.origin.recipe["file"])}
    return {"proxy": beside.arrays(f"{label}.proxy", _arrays(proxy))}


def _brdf(brdf: GGX | TabulatedBRDF | None, label: str, beside: Sidecars) -> dict[str, Any]:
    if isinstance(brdf, TabulatedBRDF):
        return {"brdf": {"table": beside.arrays(f"{label}.brdf", {"values": brdf.values})}}
    return {} if brdf is None else {"brdf": _plain(brdf)}


def _relief_layer(layer: ReliefLayer, label: str, beside: Sidecars) -> dict[str, Any]:
    """Pictures by name, colours and heights that are one value as such, other maps as arrays."""
    if layer.is_dynamic:
        kind = type(layer.heights).__name__
        raise SceneError(f"{label}.heights", f"{kind} that move cannot be written to a scene file", "store one moment")
    maps: dict[str, Any] = {name: getattr(layer, name) for name in MAPS if getattr(layer, name) is not None}
    said: dict[str, Any] = {name: beside.relative(layer.files[name][0]) for name in MAPS if name in layer.files}
    if layer.heights.size == 1 and "heights" not in said:
        said["heights"] = float(layer.heights[0, 0])
    if isinstance(layer.colors, tuple):
        said["colors"] = list(layer.colors)
    rest = {name: array for name, array in maps.items() if name not in said}
    arrays = {"arrays": beside.arrays(label, rest)} if rest else {}
    return said | arrays | _stated(layer, LOOKS[ReliefLayer])


def _geometry(mesh: Mesh, label: str, beside: Sidecars) -> dict[str, Any]:
    if mesh.origin is None:
        return {"arrays": beside.arrays(label, _arrays(mesh))}
    source: dict[str, Any] = _plain(mesh.origin.recipe)
    if "file" in source:
        source["file"] = beside.relative(source["file"])
    return source


def _mesh(mesh: Mesh, label: str, beside: Sidecars) -> dict[str, Any]:
    source = _geometry(mesh, label, beside)
    source["base_color"] = list(mesh.base_color)  # a file or a checkerboard brings along another default
    own = mesh.origin.base_color_map if mesh.origin else None
    if mesh.base_color_map is not own:
        picture = mesh.base_color_map
        source["base_color_map"] = "none" if picture is None else beside.picture(f"{label}.map", picture)
    return source


def _arrays(mesh: Mesh) -> dict[str, np.ndarray]:
    names = ("vertices", "faces", "normals", "uvs")
    return {name: getattr(mesh, name) for name in names if getattr(mesh, name) is not None}


def _volume(thing: RefractiveVolume, label: str, where: str, beside: Sidecars) -> dict[str, Any]:
    if thing.origin is not None:
        recipe = dict(thing.origin.recipe)
        substance = {"medium": describe_medium(recipe.pop("medium"), where)} if "medium" in recipe else {}
        source = _plain(recipe) | substance
        files = ("mesh", "array", "absorption", "scattering", "anisotropy", "emission", "opaque", "reflection")
        source |= {name: beside.relative(source[name]) for name in files if name in source}
        return source if "mesh" in source else source | _stated(thing, ("center_m",))
    volume = thing.volume
    names = ("delta_n", "absorption", "scattering", "anisotropy", "emission", "opaque", "reflection", *CRYSTAL)
    arrays = {name: getattr(volume, name) for name in names if getattr(volume, name) is not None}
    regions = []
    for i, region in enumerate(volume.regions):
        arrays[f"region_{i}"] = region.sdf
        matter = _stated(region, ("name", "emission", "scattering", "anisotropy", "optic_axis"))
        regions.append({"medium": describe_medium(region.medium, where), **matter})
    source = {"volume": beside.arrays(label, arrays), "extent_m": [float(e) for e in volume.extent_m]}
    source |= {"ambient_n": float(volume.ambient_n), **_stated(thing, ("center_m",))}
    return source | ({"regions": regions} if regions else {})


def _stated(value: Any, names: Any) -> dict[str, Any]:
    """Those fields that differ from their default, or have none."""
    wanted = [f for f in dataclasses.fields(value) if f.name in names]
    result = {}
    for f in wanted:
        default = f.default_factory() if f.default_factory is not dataclasses.MISSING else f.default
        if getattr(value, f.name) != default:
            result[f.name] = _plain(getattr(value, f.name))
    return result


def _plain(value: Any) -> Any:
    """Tuples as lists, dataclasses as the fields that differ from their defaults, or were given."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        if isinstance(value, Choices):
            return {name: _plain(getattr(value, name)) for name in sorted(value.given)}
        return _stated(value, [f.name for f in dataclasses.fields(value)])
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
