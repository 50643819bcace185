"""Memory layouts shared by NumPy and WGSL: each dtype here makes the WGSL struct of the same name."""

from __future__ import annotations

from pellucid.gpu.layout import struct

# A vertex of the sheet, in its own coordinates.
SheetVertex = struct([("position", "vec3f"), ("normal", "vec3f")])

SheetParams = struct(
    [
        ("world_from_object", "mat4x4f"),
        ("object_from_world", "mat4x4f"),
        ("limits_low", "vec2f"),  # x and z that the borders of the picture are taken to lie at
        ("limits_size", "vec2f"),
        ("extents_low", "vec2f"),  # of the sheet, metres of its own
        ("extents_size", "vec2f"),
        ("depth", "f32"),  # of the picture below the level
        ("scale", "f32"),  # metres of the world a metre of the sheet's own
        ("n_inside", "f32"),
        ("n_outside", "f32"),
        ("factor", "f32"),  # of the approximation, from above
        ("factor_below", "f32"),
        ("absorption", "vec3f"),  # 1/m
        ("fresnel", "f32"),  # 1: Fresnel's law, 0: `blend`
        ("diffuse_down", "vec3f"),  # share of the sky that comes down to the picture
        ("blend", "f32"),
        ("diffuse_back", "vec3f"),  # share of the picture's light that comes back to it
        ("error_scale", "f32"),  # metres or widths of the picture
    ]
)
