"""From the parts of a scene file to scene objects; every error names the field of the file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from pellucid import media
from pellucid.errors import AssetError, SceneError
from pellucid.media import Medium
from pellucid.scene import schema
from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.scene.camera import Camera
from pellucid.scene.environment import Environment
from pellucid.scene.light_quality import LightQuality
from pellucid.scene.lights import AreaLight, DirectionalLight, PointLight
from pellucid.scene.mesh import Mesh
from pellucid.scene.placement import Light, Origin, SceneObject
from pellucid.scene.quality import Quality
from pellucid.scene.refractive_sheet import PICTURES, RefractiveSheet
from pellucid.scene.refractive_volume import RefractiveVolume
from pellucid.scene.relief_quality import ReliefQuality
from pellucid.scene.relief_surface import MAPS, ReliefLayer, ReliefSurface
from pellucid.scene.scene import Scene
from pellucid.scene.water import Water
from pellucid.scene.water_quality import WaterQuality

CRYSTAL = ("optic_axis", "delta_n_e")
LIGHTS: dict[str, type[Light]] = {"directional": DirectionalLight, "point": PointLight, "area": AreaLight}
MESHES: dict[str, Callable[..., Mesh]] = {
    "plane": Mesh.plane,
    "box": Mesh.box,
    "sphere": Mesh.sphere,
    "torus": Mesh.torus,
    "checkerboard": Mesh.checkerboard,
}


def build_scene(part: schema.SceneFile, file: Path) -> Scene:
    """The scene that a file describes; paths in it are relative to its folder."""
    folder = file.parent
    given: dict[str, Any] = part.given("camera", "environment", "lights", "objects")
    with located(file, "camera"):
        given["camera"] = Camera(**part.camera.given())
    if part.environment is not None:
        with located(file, "environment"):
            given["environment"] = _environment(part.environment, folder)
    given["lights"], given["objects"] = [], []
    for i, light in enumerate(part.lights):
        with located(file, f"lights[{i}]"):
            given["lights"].append(LIGHTS[light.type](**light.given("type")))
    for i, thing in enumerate(part.objects):
        with located(file, f"objects[{i}]"):
            given["objects"].append(_object(thing, folder))
    with located(file, ""):
        return Scene(**given)


@contextmanager
def located(file: Path, where: str) -> Iterator[None]:
    """Rewrites ``mesh.scale`` of a SceneError to ``file: objects[2].scale``."""
    try:
        yield
    except SceneError as error:
        last = error.field.partition(".")[2] or error.field
        raise SceneError(f"{file}: {'.'.join(filter(None, (where, last)))}", error.reason, error.remedy) from error


def _environment(part: Any, folder: Path) -> Environment:
    given = part.given("kind", "file", "intensity", "rotation_deg")
    makers: dict[str, Callable[..., Environment]] = {
        "studio": Environment.studio,
        "sky": Environment.sky,
        "constant": Environment.constant,
    }
    if isinstance(part, schema.EnvironmentPicture):
        result = Environment.load(folder / part.file)
    else:
        result = makers[part.kind](**given)
    changes = {name: getattr(part, name) for name in ("intensity", "rotation_deg") if name in part.model_fields_set}
    return result.replace(**changes)


def _object(part: Any, folder: Path) -> SceneObject:
    if isinstance(part, schema.ReliefFile):
        return _relief(part, folder)
    if isinstance(part, schema.SheetFile):
        return _sheet(part, folder)
    if isinstance(part, schema.WaterFile):
        return _water(part, folder)
    return _mesh(part, folder) if isinstance(part, schema.MeshBase) else _volume(part, folder)


def _mesh(part: schema.MeshBase, folder: Path) -> Mesh:
    given = part.given("type", "kind", "file", "part", "arrays")
    if "base_color_map" in given:
        given["base_color_map"] = _map(given["base_color_map"], folder)
    if isinstance(part, schema.MeshOfFile):
        return _mesh_of_file(part, folder / part.file, given)
    if isinstance(part, schema.MeshOfArrays):
        # No recipe: saving under the same name writes these arrays anew.
        return _mesh_of_arrays(folder / part.arrays, **given)
    return MESHES[part.kind](**given)  # type: ignore[attr-defined]


def _mesh_of_file(part: schema.MeshOfFile, path: Path, look: dict[str, Any]) -> Mesh:
    if part.part is None:
        return Mesh.load(path, **look)
    parts = Mesh.load_all(path, **look)
    if not 0 <= part.part < len(parts):
        raise SceneError("mesh.part", f"is {part.part}, but {path.name} has {len(parts)} parts", "they count from 0")
    return parts[part.part]


def _mesh_of_arrays(path: Path, **given: Any) -> Mesh:
    from pellucid.io.volumes import read_arrays

    arrays: dict[str, Any] = dict(read_arrays(path))
    if not {"vertices", "faces"} <= set(arrays) <= {"vertices", "faces", "normals", "uvs"}:
        raise AssetError(path, f"holds {sorted(arrays)}, not a mesh", "it needs vertices and faces")
    return Mesh(**arrays, **given)


def _map(name: str, folder: Path) -> np.ndarray | None:
    """A picture as base colour; ``"none"`` takes away the one that a mesh file brings along."""
    from pellucid.io.images import read_image

    if name == "none":
        return None
    pixels = read_image(folder / name)
    return pixels if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)


def _volume(part: Any, folder: Path) -> RefractiveVolume:
    look = {name: getattr(part, name) for name in schema.VolumeBase.model_fields if name in part.model_fields_set}
    del look["type"]
    if "quality" in look:
        look["quality"] = _valued(Quality, part.quality)
    if "light" in look:
        look["light"] = _valued(LightQuality, part.light)
    if "proxy" in look:
        look["proxy"] = _proxy(part.proxy, folder)
    if "brdf" in look:
        look["brdf"] = _brdf(part.brdf, folder)
    if "center_m" in part.model_fields_set:
        look["center_m"] = part.center_m
    if isinstance(part, schema.VolumeOfMesh):
        names = {"resolution", "ambient_n", "rounding_voxels", "optic_axis"} & part.model_fields_set
        settings = {name: getattr(part, name) for name in names}
        return RefractiveVolume.from_mesh(folder / part.mesh, substance(part.medium), **settings, **look)
    if isinstance(part, schema.VolumeOfArray):
        return _volume_of_array(part, folder, look)
    return _stored_volume(part, folder, look)


def _valued(kind: type, part: schema.Model) -> Any:
    try:
        return kind(**part.given())
    except SceneError as error:
        raise SceneError(f"refractive_volume.{error.field}", error.reason, error.remedy) from error


def _proxy(name: str, folder: Path) -> str | Mesh:
    """The name of a shape, or a mesh by the file that holds it."""
    if not Path(name).suffix:
        return name
    return _mesh_of_arrays(folder / name) if Path(name).suffix == ".npz" else Mesh.load(folder / name)


def _brdf(part: schema.BrdfFile, folder: Path) -> GGX | TabulatedBRDF:
    from pellucid.io.volumes import read_volume

    if "table" not in part.model_fields_set:
        return GGX(**part.given())
    if len(part.model_fields_set) > 1:
        raise SceneError("brdf.table", "is given with roughness or tint", "choose one of them")
    try:
        return TabulatedBRDF(read_volume(folder / part.table))
    except SceneError as error:
        raise AssetError(folder / part.table, f"as a BRDF: {error.reason}", error.remedy) from error


def _volume_of_array(part: schema.VolumeOfArray, folder: Path, look: dict[str, Any]) -> RefractiveVolume:
    from pellucid.io.volumes import read_volume

    names = ("array", "absorption", "scattering", "anisotropy", "emission", "opaque", "reflection")
    files = {name: folder / getattr(part, name) for name in names if name in part.model_fields_set}
    arrays: dict[str, Any] = {name: read_volume(path) for name, path in files.items()}
    settings = part.given(*names, *schema.VolumeBase.model_fields, "center_m")
    recipe = {**settings, **{name: str(path.resolve()) for name, path in files.items()}}
    try:
        return RefractiveVolume.from_array(arrays.pop("array"), **arrays, **settings, **look, origin=Origin(recipe))
    except SceneError as error:
        blamed = files.get("array" if error.field == "n" else error.field)
        if blamed is None:
            raise
        raise AssetError(blamed, f"as {error.field} of a volume: {error.reason}", error.remedy) from error


def _stored_volume(part: schema.StoredVolume, folder: Path, look: dict[str, Any]) -> RefractiveVolume:
    from pellucid.fields.volume import Region, Volume
    from pellucid.io.volumes import read_arrays

    path = folder / part.volume
    arrays: dict[str, Any] = dict(read_arrays(path))
    regions = []
    for i, region in enumerate(part.regions or []):
        if f"region_{i}" not in arrays:
            raise AssetError(path, f"has no array 'region_{i}'", "it belongs to another scene file")
        words = region.given("medium")
        regions.append(Region(arrays.pop(f"region_{i}"), substance(region.medium), **words))
    fields = ("delta_n", "absorption", "scattering", "anisotropy", "emission", "opaque", "reflection", *CRYSTAL)
    if set(arrays) - set(fields):
        raise AssetError(path, f"holds {sorted(set(arrays) - set(fields))}, not a volume", "save the scene again")
    if "ambient_n" in part.model_fields_set:
        arrays["ambient_n"] = part.ambient_n
    volume = Volume(extent_m=part.extent_m, regions=tuple(regions), **arrays)
    return RefractiveVolume(volume, **look)


def _relief(part: schema.ReliefFile, folder: Path) -> ReliefSurface:
    given = part.given("type", "mesh", "solid", "translucent", "medium", "quality")
    if "quality" in part.model_fields_set:
        given["quality"] = _valued(ReliefQuality, part.quality)
    if "medium" in part.model_fields_set:
        given["medium"] = substance(part.medium)
    for name in {"solid", "translucent"} & part.model_fields_set:
        given[name] = _relief_layer(getattr(part, name), folder, f"relief_surface.{name}")
    return ReliefSurface(_mesh(part.mesh, folder), **given)


def _water(part: schema.WaterFile, folder: Path) -> Water:
    given = part.given("type", "waves", "medium", "quality")
    if "quality" in part.model_fields_set:
        try:
            given["quality"] = WaterQuality(**part.quality.given())
        except SceneError as error:
            where = error.field.replace("water_quality", "water.quality")
            raise SceneError(where, error.reason, error.remedy) from error
    if "medium" in part.model_fields_set:
        given["medium"] = substance(part.medium)
    if "waves" in part.model_fields_set:
        given["waves"] = _waves(part.waves, folder, "water")
    return Water(**given)


def _waves(part: dict[str, Any], folder: Path, owner: str) -> Any:
    from pellucid.fields.waves import from_plain
    from pellucid.io.volumes import read_arrays

    arrays = part.get("arrays")
    try:
        return from_plain(part, read_arrays(folder / arrays) if isinstance(arrays, str) else {})
    except SceneError as error:
        where = error.field if error.field.startswith("waves") else f"waves.{error.field}"
        raise SceneError(f"{owner}.{where}", error.reason, error.remedy) from error


def _relief_layer(part: schema.ReliefLayerFile, folder: Path, where: str) -> ReliefLayer:
    from pellucid.io.volumes import read_arrays

    given = part.given("arrays")
    files = {name: folder / given[name] for name in MAPS if isinstance(given.get(name), str)}
    if "arrays" in part.model_fields_set:
        path = folder / part.arrays
        arrays = read_arrays(path)
        if not set(arrays) <= set(MAPS):
            raise AssetError(path, f"holds {sorted(arrays)}, not a layer of a relief", f"it may hold {', '.join(MAPS)}")
        given |= arrays
    if "heights" not in given:
        raise SceneError(f"{where}.heights", "are missing", "name a picture or a number, or arrays that hold them")
    try:
        return ReliefLayer(**(given | files))
    except SceneError as error:
        last = error.field.partition(".")[2] or error.field
        raise SceneError(f"{where}.{last}", error.reason, error.remedy) from error


def _sheet(part: schema.SheetFile, folder: Path) -> RefractiveSheet:
    from pellucid.io.volumes import read_arrays

    given = part.given("type", "mesh", "arrays", "medium")
    given |= {name: folder / given[name] for name in PICTURES if name in given}
    if "waves" in given:
        given["waves"] = _waves(part.waves, folder, "refractive_sheet")
    if "arrays" in part.model_fields_set:
        arrays = read_arrays(folder / part.arrays)
        if not arrays or not set(arrays) <= {"waves", "motion"}:
            found = f"holds {sorted(arrays)}, neither waves nor motion of a sheet"
            raise AssetError(folder / part.arrays, found, "it holds waves (H, W) or motion (T, V, 3)")
        given |= arrays
    if "mesh" in part.model_fields_set:
        given["mesh"] = _mesh(part.mesh, folder)
    if "medium" in part.model_fields_set:
        given["medium"] = substance(part.medium)
    return RefractiveSheet(**given)


def substance(part: str | float | schema.ColouredMedium) -> Medium:
    """The medium that a scene file names."""
    if not isinstance(part, schema.ColouredMedium):
        return media.resolve(part)
    colours = part.given("base", "base_e")
    if "base_e" in part.model_fields_set:
        if isinstance(part.base, str):
            raise SceneError("medium.base_e", f"is given beside the medium {part.base!r}", "give two indices")
        return media.uniaxial(float(part.base), part.base_e, **colours)
    base = media.resolve(part.base)
    if part.scattering_rgb_per_m is not None:
        return media.water_body(**colours, base=base)
    other = colours.get("absorption_e_rgb_per_m")
    return base.with_absorption(part.absorption_rgb_per_m, part.name or None, other)
