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
        ("proxy_plane_count", "u32"),
        ("proxy_sphere", "vec4f"),  # centre and radius; hull.wgsl
        ("proxy_planes", ("vec4f", 32)),  # outward normal n and offset w: n.x <= w inside
        ("brdf_layer", "u32"),  # which of the tabulated BRDFs is this volume's
        ("region_n", "vec4f"),
        ("region_absorption", ("vec4f", MAX_REGIONS)),  # 1/m of the world
        ("region_emission", ("vec4f", MAX_REGIONS)),  # radiance per world metre
        ("region_scattering", ("vec4f", MAX_REGIONS)),  # rgb in 1/m of the world, anisotropy
        ("matter_half", "vec3f"),  # of the box that the fields of matter fill, object metres
        ("body", "u32"),  # its number among the bodies that rays go between
        ("body_count", "u32"),
        ("wet_low", "vec2f"),  # of a water that the volume reaches into: corners of its rectangle along x and z, metres
        ("wet_high", "vec2f"),
        ("wet_level_m", "f32"),  # far below everything where there is none
        ("wet_n", "f32"),  # index in it, and of what is around it
        ("dry_n", "f32"),
    ]
)

# Of the crystals among the regions of a volume, at one wavelength.
CrystalParams = struct(
    [
        ("axis", ("vec4f", MAX_REGIONS)),  # unit, object space; w: 1 for a crystal, 0 for an isotropic region
        ("absorption_e", ("vec4f", MAX_REGIONS)),  # of the extraordinary ray across the axis, 1/m of the world
        ("n_e", "vec4f"),
    ]
)

# The rectangle of the picture that one draw covers, and what its colours are worth (wavelengths.py);
# the first draw starts every pixel anew.
DrawParams = struct([("corner", "vec2u"), ("size", "vec2u"), ("weights", "mat3x3f"), ("first", "u32")])

# A ray that has left the refractive matter and still has to find out what it sees. body: which one it has left,
# or enters next (shaders/looks.wgsl); normal and roughness are for lobes.
LookRay = struct(
    [
        ("origin", "vec3f"),
        ("kind", "u32"),
        ("direction", "vec3f"),
        ("body", "u32"),
        ("normal", "vec3f"),
        ("roughness", "f32"),
    ]
)

# One light of the simulator and one batch of its front, object space.
LightParams = struct(
    [
        ("position", "vec3f"),
        ("kind", "u32"),  # 0 parallel, 1 from a point, 2 from a point of a face
        ("direction", "vec3f"),  # of travel; or the normal of the face, unit
        ("inside", "u32"),  # the lamp stands inside the box
        ("weights", "mat3x3f"),  # what flux is worth at the wavelength that is followed
        ("power", "vec3f"),  # irradiance, or radiant intensity
        ("casts", "u32"),  # meshes stop it before it arrives
        ("box_half", "vec3f"),  # of the box that the front begins on, object metres
        ("face_count", "u32"),
        ("box_center", "vec3f"),
        ("faces", ("vec4u", 6)),  # face (2 axis + side), tiles along both edges, number of the first tile
        ("grid", "vec3u"),  # voxels of the fluence
        ("batch_first", "u32"),
        ("cells", "vec3u"),  # of the direction of light
        ("batch_count", "u32"),
        ("capacity", "u32"),
        ("out_capacity", "u32"),
        ("bounces", "u32"),
        ("most_layers", "u32"),  # of voxels that a straight piece can cross
        ("patch_flux", "f32"),  # largest of the front, at this wavelength
        ("min_flux", "f32"),
        ("divide_above", "f32"),  # patches with less than this share of `patch_flux` stay wide
        ("follow_above", "f32"),  # and of those with less than this only some are followed
        ("split_width", "f32"),  # object metres
        ("voxel", "f32"),  # of the fluence, object metres
        ("quanta_per_flux_m", "f32"),
        ("fluence_per_quantum", "f32"),
        ("total_quanta", "f32"),
        ("intensity_quanta", "f32"),
    ]
)

# A patch of a wavefront: four corners, their optical momenta, and the flux between them.
LightPatch = struct(
    [
        ("x_0", "vec3f"),
        ("region", "u32"),
        ("x_1", "vec3f"),
        ("signs", "u32"),
        ("x_2", "vec3f"),
        ("level", "u32"),  # how often it has been divided
        ("x_3", "vec3f"),
        ("bounces", "u32"),
        ("p_0", "vec3f"),
        ("touched", "u32"),
        ("p_1", "vec3f"),
        ("is_ray", "u32"),  # all corners in one place
        ("p_2", "vec3f"),
        ("breadth", "f32"),  # of what a ray stands for, object metres
        ("p_3", "vec3f"),
        ("begun", "f32"),  # what it carried, brightest channel, when it was last undisturbed
        ("flux", "vec3f"),
        ("stuck", "u32"),  # ways of no length in a row
    ]
)

Generation = struct([("index", "u32")])

# Where a body's proxy stands, for rays that look for the next one.
BodyBox = struct([("object_from_world", "mat4x4f"), ("center", "vec3f"), ("scale", "f32"), ("half", "vec3f")])

# The boxes of the other bodies, for the light that goes from one to another.
MOST_OTHERS = 15
OtherBodies = struct(
    [
        ("object_from_world", ("mat4x4f", MOST_OTHERS)),
        ("center", ("vec4f", MOST_OTHERS)),  # w: world metres per object metre
        ("half", ("vec4f", MOST_OTHERS)),
        ("number", ("vec4u", MOST_OTHERS)),  # x: among all bodies
        ("count", "u32"),
    ]
)

# mode: of rays through crystals, 0 ordinary, 1 extraordinary.
TraceParams = struct([("count", "u32"), ("mode", "u32")])

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
