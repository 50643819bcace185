"""The shape of scene files, as pydantic models; values are judged by the scene classes themselves."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, StrictBool, StrictInt, StrictStr, Tag

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Triple = tuple[Number, Number, Number]
UNSET: Any = None
"""Default of a field that may be left out; what it then is, the scene class decides."""


class Model(BaseModel):
    """A part of a scene file; unknown fields are errors."""

    model_config = ConfigDict(extra="forbid")

    def given(self, *but: str) -> dict[str, Any]:
        """The fields that the file states, except some."""
        return {name: getattr(self, name) for name in sorted(self.model_fields_set) if name not in but}


class CameraFile(Model):
    position: Triple
    target: Triple = UNSET
    up: Triple = UNSET
    fov_deg: Number = UNSET
    orthographic_height_m: Number | None = UNSET
    near_m: Number = UNSET
    far_m: Number = UNSET


class EnvironmentBase(Model):
    intensity: Number = UNSET
    rotation_deg: Number = UNSET


class EnvironmentPicture(EnvironmentBase):
    file: StrictStr


class StudioEnvironment(EnvironmentBase):
    kind: Literal["studio"]


class SkyEnvironment(EnvironmentBase):
    kind: Literal["sky"]
    sun_elevation_deg: Number = UNSET
    sun_azimuth_deg: Number = UNSET
    turbidity: Number = UNSET
    sun_disc: StrictBool = UNSET
    sun_diameter_deg: Number = UNSET
    ground_albedo: Number | Triple = UNSET


class ConstantEnvironment(EnvironmentBase):
    kind: Literal["constant"]
    rgb: Number | Triple = UNSET


class DirectionalLightFile(Model):
    type: Literal["directional"]
    direction: Triple
    color: Triple = UNSET
    irradiance: Number = UNSET
    cast_shadow: StrictBool = UNSET
    angular_radius_deg: Number = UNSET


class PointLightFile(Model):
    type: Literal["point"]
    position: Triple
    color: Triple = UNSET
    intensity: Number = UNSET
    cast_shadow: StrictBool = UNSET


class AreaLightFile(Model):
    type: Literal["area"]
    position: Triple
    edge_u: Triple
    edge_v: Triple
    color: Triple = UNSET
    radiance: Number = UNSET
    cast_shadow: StrictBool = UNSET


class Placed(Model):
    position: Triple = UNSET
    rotation: Triple = UNSET
    scale: Number = UNSET


class MeshBase(Placed):
    type: Literal["mesh"] = "mesh"  # may be left out where nothing but a mesh can stand
    base_color: Triple = UNSET
    base_color_map: StrictStr = UNSET
    roughness: Number = UNSET
    specular: Number = UNSET
    emission: Triple = UNSET
    double_sided: StrictBool = UNSET
    shading: StrictStr = UNSET


class MeshOfFile(MeshBase):
    file: StrictStr
    part: StrictInt = UNSET


class MeshOfArrays(MeshBase):
    arrays: StrictStr


class PlaneMesh(MeshBase):
    kind: Literal["plane"]
    size_m: Number | tuple[Number, Number] = UNSET


class BoxMesh(MeshBase):
    kind: Literal["box"]
    size_m: Number | Triple = UNSET


class SphereMesh(MeshBase):
    kind: Literal["sphere"]
    radius_m: Number = UNSET
    segments: StrictInt = UNSET


class TorusMesh(MeshBase):
    kind: Literal["torus"]
    radius_m: Number = UNSET
    tube_m: Number = UNSET
    segments: StrictInt = UNSET


class CheckerboardMesh(MeshBase):
    kind: Literal["checkerboard"]
    size_m: Number | tuple[Number, Number] = UNSET
    squares: StrictInt = UNSET
    colors: tuple[Triple, Triple] = UNSET


class QualityFile(Model):
    method: StrictStr = UNSET
    step_voxels: Number = UNSET
    adaptive: StrictBool = UNSET
    max_steps: StrictInt = UNSET
    bounces: StrictInt = UNSET
    min_weight: Number = UNSET


class LightQualityFile(Model):
    fluence_voxels: Number = UNSET
    front_voxels: Number = UNSET
    split_voxels: Number = UNSET
    bounces: StrictInt = UNSET
    min_flux: Number = UNSET
    method: StrictStr = UNSET
    caustics: StrictBool = UNSET
    caustic_texels: StrictInt = UNSET


class BrdfFile(Model):
    """A table (an array of values), or else a rough boundary."""

    table: StrictStr = UNSET
    roughness: Number = UNSET
    tint: Triple = UNSET


class ColouredMedium(Model):
    """A medium of the catalogue, or an index, with a colour of its own."""

    base: StrictStr | Number
    absorption_rgb_per_m: Triple
    absorption_e_rgb_per_m: Triple = UNSET
    scattering_rgb_per_m: Triple = UNSET
    asymmetry: Number = UNSET
    base_e: Number = UNSET
    name: StrictStr = UNSET


Substance = StrictStr | Number | ColouredMedium


class VolumeBase(Placed):
    type: Literal["refractive_volume"]
    boundary: StrictStr = UNSET
    dispersion: StrictBool = UNSET
    spectral: StrictInt = UNSET
    smoothing_voxels: Number = UNSET
    gradient: StrictStr = UNSET
    surroundings: StrictStr = UNSET
    quality: QualityFile = UNSET
    light: LightQualityFile = UNSET
    brdf: BrdfFile = UNSET
    proxy: StrictStr = UNSET
    gloss: Number = UNSET


class VolumeOfMesh(VolumeBase):
    mesh: StrictStr
    medium: Substance
    resolution: StrictInt = UNSET
    ambient_n: Number = UNSET
    rounding_voxels: Number = UNSET
    optic_axis: Triple = UNSET


class VolumeOfArray(VolumeBase):
    array: StrictStr
    extent_m: Number | Triple
    ambient_n: Number = UNSET
    absorption: StrictStr = UNSET
    scattering: StrictStr = UNSET
    anisotropy: StrictStr = UNSET
    emission: StrictStr = UNSET
    opaque: StrictStr = UNSET
    reflection: StrictStr = UNSET
    center_m: Triple = UNSET


class RegionFile(Model):
    medium: Substance
    name: StrictStr = UNSET
    emission: Triple = UNSET
    scattering: Triple = UNSET
    anisotropy: Number = UNSET
    optic_axis: Triple = UNSET


class StoredVolume(VolumeBase):
    """What ``save_scene`` writes for a volume that no recipe describes."""

    volume: StrictStr
    extent_m: Triple
    ambient_n: Number = UNSET
    center_m: Triple = UNSET
    regions: list[RegionFile] = UNSET


class ReliefQualityFile(Model):
    search: StrictStr = UNSET
    linear_steps: StrictInt = UNSET
    binary_steps: StrictInt = UNSET
    linear_approximation: StrictBool = UNSET
    refraction_steps: tuple[StrictInt, StrictInt] = UNSET
    refraction: StrictStr = UNSET
    refraction_pieces: StrictInt = UNSET
    adapt_angle: StrictBool = UNSET
    adapt_distance: StrictBool = UNSET
    complexity: StrictBool = UNSET
    reflection: StrictStr = UNSET
    shadows: StrictStr = UNSET
    shadow_steps: StrictInt = UNSET
    occlusion: StrictStr = UNSET
    hue: StrictBool = UNSET
    caustics: StrictBool = UNSET
    silhouettes: StrictBool = UNSET
    environment: StrictStr = UNSET
    show: StrictStr = UNSET


class ReliefLayerFile(Model):
    """Heights and their look; ``arrays`` is an .npz with heights and perhaps normals and colors."""

    heights: StrictStr | Number = UNSET
    arrays: StrictStr = UNSET
    height_m: Number = UNSET
    base_m: Number = UNSET
    normals: StrictStr = UNSET
    colors: StrictStr | Triple = UNSET
    roughness: Number = UNSET
    specular: Number = UNSET
    normal_convention: StrictStr = UNSET


def _environment_tag(data: Any) -> str | None:
    return data.get("kind", "file" if "file" in data else None) if isinstance(data, dict) else None


def _object_tag(data: Any) -> str | None:
    """``mesh.plane``, ``mesh.file``, ``refractive_volume.array`` ...: the type and where the matter comes from."""
    if not isinstance(data, dict):
        return None
    kind = data.get("type")
    if kind == "water":
        return "water"
    if kind == "mesh" and "kind" in data:
        return f"mesh.{data['kind']}"
    sources = {
        "mesh": ("file", "arrays"),
        "refractive_volume": ("mesh", "array", "volume"),
        "relief_surface": ("solid",),
        "refractive_sheet": ("picture",),
    }.get(str(kind), ())
    return next((f"{kind}.{source}" for source in sources if source in data), None)


def _choose(tag: Any, message: str) -> Discriminator:
    return Discriminator(tag, custom_error_type="unknown_kind", custom_error_message=message)


def _mesh_tag(data: Any) -> str | None:
    return _object_tag({**data, "type": "mesh"}) if isinstance(data, dict) else None


MeshFile = Annotated[
    Annotated[MeshOfFile, Tag("mesh.file")]
    | Annotated[MeshOfArrays, Tag("mesh.arrays")]
    | Annotated[PlaneMesh, Tag("mesh.plane")]
    | Annotated[BoxMesh, Tag("mesh.box")]
    | Annotated[SphereMesh, Tag("mesh.sphere")]
    | Annotated[TorusMesh, Tag("mesh.torus")]
    | Annotated[CheckerboardMesh, Tag("mesh.checkerboard")],
    _choose(_mesh_tag, 'needs "file", or "kind" = "plane", "box", "sphere" or "torus"'),
]


class ReliefFile(Placed):
    type: Literal["relief_surface"]
    mesh: MeshFile
    solid: ReliefLayerFile
    translucent: ReliefLayerFile = UNSET
    medium: Substance = UNSET
    ambient_n: Number = UNSET
    tile_m: Number | tuple[Number, Number] = UNSET
    tiles: Number | tuple[Number, Number] = UNSET
    tiling: StrictBool = UNSET
    technique: StrictStr = UNSET
    quality: ReliefQualityFile = UNSET
    dispersion: StrictBool = UNSET
    absorption: Triple = UNSET
    scattering: Number = UNSET
    specular_factor: Number = UNSET
    edges: StrictStr = UNSET


class WaterQualityFile(Model):
    refraction: StrictStr = UNSET
    reflection: StrictStr = UNSET
    steps: StrictInt = UNSET
    march_steps: StrictInt = UNSET
    texture_size: StrictInt = UNSET
    cameras: StrictStr = UNSET
    field_of_view: Number = UNSET
    cull_back_faces: StrictBool = UNSET
    point_distance_m: Number = UNSET
    underside_distance_m: Number = UNSET
    fallback: StrictStr = UNSET
    fresnel: StrictStr = UNSET
    schlick_power: Number = UNSET
    color: StrictStr = UNSET
    underside: StrictStr = UNSET
    shading_rate: StrictInt = UNSET
    caustics: StrictStr = UNSET
    caustic_size: StrictInt = UNSET
    caustic_camera: StrictStr = UNSET
    caustic_intersection: StrictStr = UNSET
    shadows: StrictBool = UNSET
    god_rays: StrictBool = UNSET
    glow: Number = UNSET


class WaterFile(Model):
    """Water; its waves are what ``fields.waves.from_plain`` understands."""

    type: Literal["water"]
    level: Number = UNSET
    extent_m: Number | tuple[Number, Number] = UNSET
    center: tuple[Number, Number] = UNSET
    waves: dict[StrictStr, Any] = UNSET
    medium: Substance = UNSET
    ambient_n: Number = UNSET
    technique: StrictStr = UNSET
    quality: WaterQualityFile = UNSET
    foam: Number = UNSET
    color: Triple = UNSET
    clarity_per_m: Number = UNSET
    dispersion: StrictBool = UNSET
    outline: StrictStr | list[tuple[Number, Number]] = UNSET
    depth_m: Number = UNSET
    floor: StrictStr = UNSET
    floor_scale: Number = UNSET


class SheetFile(Placed):
    """A sheet over a picture; its waves are what ``fields.waves.from_plain`` understands, or an array.

    ``arrays`` is an .npz with waves (H, W) or motion (T, V, 3).
    """

    type: Literal["refractive_sheet"]
    picture: StrictStr
    depth_m: Number = UNSET
    size_m: Number | tuple[Number, Number] = UNSET
    waves: dict[StrictStr, Any] = UNSET
    arrays: StrictStr = UNSET
    segments: StrictInt = UNSET
    mesh: MeshFile = UNSET
    motion_fps: Number = UNSET
    medium: Substance = UNSET
    ambient_n: Number = UNSET
    refraction: StrictStr = UNSET
    factor: Number = UNSET
    fit_angle_deg: Number = UNSET
    per: StrictStr = UNSET
    borders: StrictStr = UNSET
    deviation_m: Number = UNSET
    reflection: StrictStr = UNSET
    sphere_map: StrictStr = UNSET
    sphere_rule: StrictStr = UNSET
    blend: Number = UNSET
    lit: StrictBool = UNSET
    meshes: StrictBool = UNSET
    absorption: Triple = UNSET
    show: StrictStr = UNSET
    error_scale: Number = UNSET


EnvironmentFile = Annotated[
    Annotated[EnvironmentPicture, Tag("file")]
    | Annotated[StudioEnvironment, Tag("studio")]
    | Annotated[SkyEnvironment, Tag("sky")]
    | Annotated[ConstantEnvironment, Tag("constant")],
    _choose(_environment_tag, 'needs "file", or "kind" = "studio", "sky" or "constant"'),
]
LightFile = Annotated[
    Annotated[DirectionalLightFile, Tag("directional")]
    | Annotated[PointLightFile, Tag("point")]
    | Annotated[AreaLightFile, Tag("area")],
    _choose(
        lambda data: data.get("type") if isinstance(data, dict) else None,
        'needs "type" = "directional", "point" or "area"',
    ),
]
ObjectFile = Annotated[
    Annotated[MeshOfFile, Tag("mesh.file")]
    | Annotated[MeshOfArrays, Tag("mesh.arrays")]
    | Annotated[PlaneMesh, Tag("mesh.plane")]
    | Annotated[BoxMesh, Tag("mesh.box")]
    | Annotated[SphereMesh, Tag("mesh.sphere")]
    | Annotated[TorusMesh, Tag("mesh.torus")]
    | Annotated[CheckerboardMesh, Tag("mesh.checkerboard")]
    | Annotated[VolumeOfMesh, Tag("refractive_volume.mesh")]
    | Annotated[VolumeOfArray, Tag("refractive_volume.array")]
    | Annotated[StoredVolume, Tag("refractive_volume.volume")]
    | Annotated[ReliefFile, Tag("relief_surface.solid")]
    | Annotated[SheetFile, Tag("refractive_sheet.picture")]
    | Annotated[WaterFile, Tag("water")],
    _choose(
        _object_tag,
        'needs "type" = "mesh" with "file" or "kind" (plane, box, sphere, torus, checkerboard), '
        '"type" = "refractive_volume" with "mesh" or "array", "type" = "relief_surface" with "solid", '
        '"type" = "refractive_sheet" with "picture", or "type" = "water"',
    ),
]


class SceneFile(Model):
    """A whole scene file."""

    camera: CameraFile
    environment: EnvironmentFile = UNSET
    lights: list[LightFile] = []
    objects: list[ObjectFile] = []
    exposure: Number = UNSET
    tone_mapping: StrictStr = UNSET
    glow: Number = UNSET


KNOWN_FIELDS = tuple(
    sorted(
        {
            name
            for model in list(globals().values())
            if isinstance(model, type) and issubclass(model, Model)
            for name in model.model_fields
        }
    )
)
