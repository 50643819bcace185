"""Memory layouts shared by NumPy and WGSL: each dtype here makes the WGSL struct of the same name."""

from __future__ import annotations

from pellucid.gpu.layout import struct
from pellucid.surroundings.layouts import DIFFUSE_ENTRIES

NEAREST = ("height_bounds", "cone_map", "relief_vertices")  # textures of 32 bits that are read texel by texel
VERTEX_TEXELS = 5  # of four numbers, that a ReliefVertex takes

# A corner of a triangle of the hull: where it lies on the mesh, and the frame there. Directions are those of the
# object; tangents are metres of the object a tile.
ReliefVertex = struct(
    [
        ("position", "vec3f"),
        ("u", "f32"),
        ("normal", "vec3f"),  # unit
        ("v", "f32"),
        ("tangent", "vec3f"),  # dP/du
        ("level", "f32"),  # 1 at the top of the hull, 0 at its bottom
        ("bitangent", "vec3f"),  # dP/dv
        ("wall", "f32"),  # 1 where the triangle stands on an open border
        ("curvature", "vec3f"),  # second fundamental form: dN/du.T, dN/du.B, dN/dv.B, metres a tile^2
    ]
)

ReliefParams = struct(
    [
        ("world_from_object", "mat4x4f"),  # without the scale, which vertices have already
        ("texels", "vec2u"),  # of the height map
        ("tiling", "u32"),
        ("technique", "u32"),
        ("solid_low", "f32"),  # metres
        ("solid_high", "f32"),
        ("translucent_low", "f32"),
        ("translucent_high", "f32"),
        ("hull_low", "f32"),
        ("hull_high", "f32"),
        ("tile_m", "vec2f"),  # metres a tile in the mean
        ("clip_low", "vec2f"),  # rectangle of texture coordinates outside of which there is nothing
        ("clip_high", "vec2f"),
        ("n_layer", "vec3f"),  # index of the translucent layer, red, green, blue
        ("n_outside", "f32"),
        ("absorption", "vec3f"),  # 1/m
        ("scattering", "f32"),  # 1/m
        ("specular_factor", "f32"),  # 0 for light as it is
        ("solid_roughness", "f32"),
        ("solid_specular", "f32"),
        ("translucent_roughness", "f32"),
        ("linear_steps", "u32"),
        ("binary_steps", "u32"),
        ("linear_approximation", "u32"),
        ("refraction_linear", "u32"),
        ("refraction_binary", "u32"),
        ("adapt_angle", "f32"),  # 0 or 1
        ("adapt_distance", "f32"),
        ("complexity", "f32"),
        ("mapped_lights", "u32"),  # bit k: light k has a layer of light_map
        ("silhouettes", "f32"),  # 0 or 1
        ("color", "vec3f"),  # multiplies the map
        ("color_texels", "f32"),  # a tile
        ("diffuse_down", ("vec4f", DIFFUSE_ENTRIES)),
        ("diffuse_back", ("vec4f", DIFFUSE_ENTRIES)),
    ]
)

# A ray of the caller: at t world metres it is at uv + t duv, h + t dh + t^2 bend
ReliefAsked = struct(
    [("uv", "vec2f"), ("duv", "vec2f"), ("h", "f32"), ("dh", "f32"), ("bend", "f32"), ("reach", "f32")]
)

# The plane that a relief lies on, world; and the light and the channels that a pass is about.
ReliefPlane = struct(
    [
        ("origin", "vec3f"),  # of texture coordinates and heights
        ("light", "u32"),
        ("tangent", "vec3f"),
        ("n_layer", "f32"),  # index of the translucent layer for these channels
        ("bitangent", "vec3f"),
        ("normal", "vec3f"),
        ("channels", "vec3f"),  # 1 for those that count
    ]
)

# A ray of a lamp that has entered the translucent layer at the centre of a texel.
ReliefBeam = struct(
    [
        ("flux", "vec3f"),  # that reaches the solid layer; 1 is what a texel of a level surface receives
        ("kind", "u32"),  # see shaders/caustic_bindings.wgsl
        ("landed", "vec2f"),  # where, texels
    ]
)

# What the maps of heights that move are made with.
ReliefMoving = struct(
    [
        ("tile_m", "vec2f"),  # metres a tile in the mean
        ("solid_base_m", "f32"),  # added to the heights of a layer
        ("translucent_base_m", "f32"),
        ("tiling", "u32"),
    ]
)
