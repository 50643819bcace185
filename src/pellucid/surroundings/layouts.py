"""Memory layouts shared by NumPy and WGSL: each dtype here makes the WGSL struct of the same name."""

from __future__ import annotations

from pellucid.gpu.layout import struct
from pellucid.scene.water_outline import MOST_CORNERS

FLAG_ORTHOGRAPHIC = 1

MATERIAL_SINGLE_SIDED = 1
MATERIAL_UNSEEN = 2  # rays and lamps meet it, the picture does not show it
MATERIAL_CASTS_SHADOW = 16  # shifted left by the layer of the shadow map

DIFFUSE_ENTRIES = 32  # rows of a table of light that goes diffusely through an interface, see diffuse.py

MAX_WATERS = 4  # of which what stands in them is lit through their surface
MAX_WATER_LIGHTS = 4  # lights with caustics in each of them

OPEN_SIZE = (24, 8, 24)  # places along x, y, z of each water from which the sky is looked for, see open_sky.py

SCATTER_DOWN, SCATTER_AROUND = 33, 16  # rows and columns of what water scatters of the sky, see sky_scatter.py

LIGHT_DIRECTIONAL = 0
LIGHT_POINT = 1
LIGHT_AREA = 2

FrameParams = struct(
    [
        ("clip_from_world", "mat4x4f"),
        ("camera_position", "vec3f"),
        ("near_m", "f32"),
        ("camera_right", "vec3f"),
        ("far_m", "f32"),
        ("camera_up", "vec3f"),
        ("flags", "u32"),
        ("camera_forward", "vec3f"),
        ("pixel_footprint", "f32"),  # radians per pixel, or metres per pixel when orthographic
        ("size", "vec2f"),
        ("jitter", "vec2f"),
        ("half_extent", "vec2f"),  # tangents of the half angles, or metres when orthographic
        ("environment_rotation", "vec2f"),  # cosine, sine
        ("environment_intensity", "f32"),
        ("environment_pixel_lod", "f32"),
        ("environment_max_lod", "f32"),
        ("ray_epsilon_m", "f32"),
        ("light_count", "u32"),
        ("triangle_count", "u32"),
        ("sample_index", "u32"),
        ("environment_height", "f32"),
        ("joint_root", "u32"),  # node over all triangles, those of interfaces too; 0 where there are none
        ("environment_sh", ("vec4f", 9)),
    ]
)

BvhNode = struct([("lower", "vec3f"), ("link", "u32"), ("upper", "vec3f"), ("count", "u32")])

BvhTriangle = struct(
    [
        ("corner_0", "vec3f"),
        ("single_sided", "u32"),
        ("corner_1", "vec3f"),  # corners, not edges: neighbours must share them to the last bit, or cracks show
        ("material", "u32"),
        ("corner_2", "vec3f"),
    ]
)

TriangleAttributes = struct(
    [
        ("normal_0", "vec3f"),
        ("chart_front", "u32"),  # of the atlas of caustics, counted from 1; 0 for none
        ("normal_1", "vec3f"),
        ("chart_back", "u32"),
        ("normal_2", "vec3f"),
        ("uv_0", "vec2f"),
        ("uv_1", "vec2f"),
        ("uv_2", "vec2f"),
    ]
)

Material = struct(
    [
        ("base_color", "vec3f"),
        ("roughness", "f32"),
        ("emission", "vec3f"),
        ("specular", "f32"),
        ("base_color_layer", "i32"),  # -1 when the material has no map
        ("texels_per_m", "f32"),  # mean density of the map on the surface, at level 0
        ("flags", "u32"),
        ("inner", "vec4f"),  # of an interface, behind its faces: absorption 1/m, index over that of air; else 0
        ("outer", "vec4f"),  # before them; index 0 for whatever is around, air or water
    ]
)

Light = struct(
    [
        ("position", "vec3f"),
        ("kind", "u32"),
        ("direction", "vec3f"),  # from the surface towards a directional light; normal of an area light
        ("shadow_layer", "i32"),  # -1 for no shadow; lamps without a map have 0
        ("power", "vec3f"),  # irradiance, radiant intensity or radiance, by kind
        ("shadow_texel_m", "f32"),
        ("edge_u", "vec3f"),
        ("radius", "f32"),  # tangent of the angle of a directional light; of the disc as large as an area light, m
        ("edge_v", "vec3f"),
        ("water_layer", "i32"),  # among the maps of each water, directional lights first; -1 for none
        ("shadow_from_world", "mat4x4f"),
    ]
)

OUT_CAUSTIC = 0
OUT_BLOCKED = 1
OUT_UNTOUCHED = 2

# A bundle of rays that leaves a volume: four corner rays and the flux that flows between them. Corners in the order
# (0, 0), (1, 0), (0, 1), (1, 1) of the bundle. OUT_CAUSTIC adds its light to what it lands on; OUT_BLOCKED is light
# that would have passed had the volume not been there, its flux positive. OUT_UNTOUCHED is light that goes on as it
# came: other volumes want to know of it, meshes have it already.
OutPatch = struct(
    [
        ("corner_0", "vec3f"),  # metres, world space
        ("kind", "u32"),
        ("corner_1", "vec3f"),
        ("level", "u32"),  # how often it has been divided
        ("corner_2", "vec3f"),
        ("is_ray", "u32"),  # all corners in one place
        ("corner_3", "vec3f"),
        ("breadth", "f32"),  # of what a ray stands for, metres
        ("way_0", "vec3f"),  # unit directions in which the light goes
        ("body", "u32"),  # that it enters next
        ("way_1", "vec3f"),
        ("begun", "f32"),  # flux that the patch began with at the lamp
        ("way_2", "vec3f"),
        ("way_3", "vec3f"),
        ("flux", "vec3f"),  # radiant power of the bundle
    ]
)

# How many records wait, preceded by the workgroups that they fill: the arguments of an indirect dispatch.
LookCount = struct([("groups_x", "u32"), ("groups_y", "u32"), ("groups_z", "u32"), ("count", "u32")])

LandParams = struct([("units_per_flux", "f32"), ("width", "u32"), ("height", "u32")])

QueryRay = struct([("origin", "vec3f"), ("t_max", "f32"), ("direction", "vec3f")])

QueryHit = struct(
    [
        ("value", "vec3f"),  # by kernel: radiance, irradiance, or barycentric weights and depth value
        ("t", "f32"),
        ("direction", "vec3f"),
        ("valid", "u32"),
        ("triangle", "u32"),
        ("blocked", "u32"),
    ]
)

# Places from which the sky is looked for.
OpenSky = struct([("low", "vec3f"), ("level", "f32"), ("high", "vec3f"), ("index", "f32")])

# Water that opaque surfaces stand in, see submersion.py. Arrays have one entry for each water, tables DIFFUSE_ENTRIES.
SubmersionParams = struct(
    [
        ("bounds", ("vec4f", MAX_WATERS)),  # lowest and highest x, z, metres; empty where there is no water
        (
            "level",
            ("vec4f", MAX_WATERS),
        ),  # level; highest wave over it; first layer of maps; reach of their depth, m
        (
            "shape",
            ("vec4f", MAX_WATERS),
        ),  # of scene.water_outline: kind; bend b 1/m, c 1/m^2; depth of the floor, metres
        ("middle", ("vec4f", MAX_WATERS)),  # x and z that it narrows towards; halves of its size along them
        ("edges", ("vec4f", MAX_WATERS * MOST_CORNERS)),  # x n_x + z n_z + s h <= d
        ("index", ("vec4f", MAX_WATERS)),  # over that above, for red, green, blue
        ("absorption", ("vec4f", MAX_WATERS)),  # 1/m; how deep meshes hide the sky, m
        ("scattering", ("vec4f", MAX_WATERS)),  # 1/m; mean cosine
        ("sky", ("vec4f", MAX_WATERS)),  # irradiance of the sky just below a level surface, over its intensity
        ("sky_axis", ("vec4f", MAX_WATERS)),  # unit, where that comes from; space of the environment
        ("ground", ("vec4f", MAX_WATERS)),  # irradiance from below, likewise
        ("air_sky", ("vec4f", MAX_WATERS)),  # the same three in air
        ("air_axis", ("vec4f", MAX_WATERS)),
        ("air_ground", ("vec4f", MAX_WATERS)),
        ("window", ("vec4f", MAX_WATERS)),  # share of matt light that the surface throws back; sine^2 of Snell's window
        (
            "slope",
            ("vec4f", MAX_WATERS * MAX_WATER_LIGHTS),
        ),  # of the camera of each map, horizontal way over depth; 1 for shadows; 1 for the map of a lamp nearby
        (
            "down",
            ("vec4f", MAX_WATERS * DIFFUSE_ENTRIES),
        ),  # share of the sky left at a depth
        ("back", ("vec4f", MAX_WATERS * DIFFUSE_ENTRIES)),  # share of matt light that comes back
        ("scatter", ("vec4f", MAX_WATERS * SCATTER_DOWN * SCATTER_AROUND)),  # of the sky's light, by direction of view
    ]
)
