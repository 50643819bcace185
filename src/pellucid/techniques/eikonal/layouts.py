"""Memory layouts that the eikonal shaders and this package share."""

from __future__ import annotations

import numpy as np

from pellucid.gpu.layout import struct
from pellucid.surroundings.layouts import LookCount as LookCount

MAX_REGIONS = 4

VolumeParams = struct(
    [
        ("world_from_object", "mat4x4f"),
        ("object_from_world", "mat4x4f"),
        ("half_extent", "vec3f"),  # of the sampled fields, object metres
        ("ambient_n", "f32"),
        ("proxy_half", "vec3f"),  # of the box where rays begin, object metres
        ("scale", "f32"),  # world metres per object metre
        ("proxy_center", "vec3f"),
        ("voxel", "f32"),  # shortest voxel edge, object metres
        ("step", "f32"),  # longest step in inhomogeneous matter, object metres
        ("force_scale", "f32"),  # stored force times this is grad(n^2)/2 per object metre
        ("index_scale", "f32"),  # stored index times this is n - ambient_n
        ("boundary_on", "f32"),  # |grad n| that begins a boundary event, 1/m
        ("boundary_off", "f32"),  # |grad n| that ends it
        ("min_weight", "f32"),  # lighter branches end in the environment
        (
            "pause",
            "f32",
        ),  # change of momentum after which the march hands back, so that the caller may look along the chord
        ("max_steps", "u32"),
        ("bounces", "u32"),
        ("region_count", "u32"),  # 0: the box itself is the surface
        ("writes_depth", "u32"),  # 0 for matter without a surface, such as hot air
        ("coat", "vec4f"),  # tint and roughness of boundaries without reflection data
        ("gloss", "f32"),  # roughness in which smooth boundaries show lamps; 0: not at all
        ("brdf_layer", "u32"),  # which of the tabulated BRDFs is this volume's
        ("region_n", "vec4f"),
        ("region_absorption", ("vec4f", MAX_REGIONS)),  # 1/m of the world
        ("region_emission", ("vec4f", MAX_REGIONS)),  # radiance per world metre
        ("region_scattering", ("vec4f", MAX_REGIONS)),  # rgb in 1/m of the world, anisotropy
        ("matter_half", "vec3f"),  # of the box that the fields of matter fill, object metres
    ]
)

# The rectangle of the picture that one draw covers, and what its colours are worth (wavelengths.py);
# the first draw starts every pixel anew.
DrawParams = struct([("corner", "vec2u"), ("size", "vec2u"), ("weights", "mat3x3f"), ("first", "u32")])

# A ray that has left the refractive matter and still has to find out what it sees. The last two are for lobes.
LookRay = struct(
    [
        ("origin", "vec3f"),
        ("slot", "u32"),
        ("direction", "vec3f"),
        ("kind", "u32"),
        ("normal", "vec3f"),
        ("roughness", "f32"),
    ]
)

TraceParams = struct([("count", "u32")])

# One ray of `pl.trace`, object space. Results overwrite it.
TraceRay = struct(
    [
        ("position", "vec3f"),
        ("optical_path", "f32"),
        ("momentum", "vec3f"),  # in: unit direction; out: deviation of the optical momentum from the start
        ("status", "u32"),
        ("transmittance", "vec3f"),
        ("steps", "u32"),
        ("base", "vec3f"),  # out: optical momentum that `momentum` deviates from
        ("n", "f32"),
    ]
)


def blank_params() -> np.ndarray:
    """A zeroed VolumeParams record."""
    return np.zeros((), VolumeParams)
