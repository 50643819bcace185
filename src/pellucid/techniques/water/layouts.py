"""Memory layouts shared by NumPy and WGSL: each dtype here makes the WGSL struct of the same name."""

from __future__ import annotations

from pellucid.gpu.layout import struct
from pellucid.scene.water_outline import MOST_CORNERS

WAVE_LAYERS = 8  # most that one body of water adds up

WaterParams = struct(
    [
        ("low", "vec2f"),  # corners of the rectangle along x and z, metres
        ("high", "vec2f"),
        ("center", "vec2f"),  # of the rectangle, where tiles of waves are centred
        ("level", "f32"),  # metres
        ("wave_low", "f32"),  # lowest and highest that waves ever are over the level, metres
        ("n_water", "vec3f"),  # red, green, blue; all alike without dispersion
        ("n_outside", "f32"),
        ("absorption", "vec3f"),  # 1/m
        ("wave_high", "f32"),
        ("scattering", "vec3f"),  # 1/m
        ("asymmetry", "f32"),  # mean cosine of the scattering angle
        ("color", "vec3f"),  # of deep water [mihalik2008, eq. 4]
        ("clarity", "f32"),  # 1/m [mihalik2008, eq. 5]
        ("wave_slope", "f32"),  # steepest slope of the moment
        ("trough", "f32"),  # lowest and highest of the moment, over the level, metres
        ("crest", "f32"),
        ("wave_cell_m", "f32"),  # side of a texel of the finest layer
        ("foam", "f32"),  # 0 to 1
        ("schlick_power", "f32"),
        ("steps", "u32"),  # of the iteration [mihalik2008, 7.1]
        ("march_steps", "u32"),
        ("point_distance_m", "f32"),
        ("underside_distance_m", "f32"),
        ("short_slopes", "vec3f"),  # mean squares of slopes of waves too short for the maps: xx, zz, xz
        ("region", "u32"),  # of surroundings.submersion
        ("wave_layers", "u32"),
        ("time_s", "f32"),
        ("block", "vec2u"),  # pixels that share a ray, from left to right and from top to bottom
        ("shape", "vec4f"),  # of scene.water_outline: bend b 1/m, c 1/m^2; depth of the floor, metres
        ("middle", "vec2f"),  # x and z that it narrows towards
        ("half", "vec2f"),  # halves of its size along x and z, metres
        ("edges", ("vec4f", MOST_CORNERS)),  # of a polygon: x n_x + z n_z + s h <= d; those that are missing hold all
        ("wave_tiles", ("vec4f", WAVE_LAYERS)),  # by layer: width and depth in metres, 1 where it repeats, 0
    ]
)

# Ripples that the device makes a layer of waves from, see ripple_maps.py.
RippleMap = struct(
    [
        ("cell_m", "vec2f"),
        ("repeats", "u32"),
        ("others", "vec3f"),  # steepest slope, trough and crest of the other layers
    ]
)

# Cameras whose pictures stand for the scene: below the surface, above it.
WaterViews = struct(
    [
        ("clip_from_world", ("mat4x4f", 2)),
        ("position", ("vec4f", 2)),  # and the nearest metres
        ("forward", ("vec4f", 2)),  # and the farthest metres, 0 in perspective
        ("limit", ("vec4f", 2)),  # height that no mesh lies beyond, metres
    ]
)

# The light of one lamp through one surface, see caustics.py.
CausticParams = struct(
    [
        ("to_light", "vec3f"),  # unit, above the water
        ("layer", "u32"),  # of the maps of surroundings.submersion
        ("index", "vec3f"),  # of the water over that above, by channel
        ("reach_m", "f32"),  # of the depth maps, below the highest and above the lowest wave
        ("slope", "vec2f"),  # of the camera below the surface, horizontal way over depth
        ("slope_above", "vec2f"),  # along the light above it
        ("lamp_side", "vec2f"),  # of its picture in the water, by axis, over the depth
        ("share", "f32"),  # of the lamp that shines from there
        ("focus", "f32"),  # 1; 0 for level water instead of waves
        ("loss", "f32"),  # 1; 0 to leave out what the surface reflects
        ("shadows", "f32"),  # 1; 0 for a lamp without any
        ("reach_above_m", "f32"),
        ("channels", "u32"),  # 3 with dispersion, else 1
        ("steps", "u32"),  # of the iteration
        ("above", "f32"),  # of the depth pass: 1 for what is over the surface
        ("cells", "u32"),  # of the surface along a side, one photon each
        ("places", "u32"),  # of a lamp nearby that the level water is asked of: its middle, and four of a rectangle
        ("place", "vec3f"),  # of a lamp nearby, or of a part of it, world space
        ("near", "f32"),  # 1 for such a lamp
        ("middle", "vec3f"),  # of the whole lamp
        ("is_area", "f32"),
        ("facing", "vec3f"),  # normal of a rectangle
        ("divided", "vec2f"),  # parts along its edges
        ("edge_u", "vec3f"),  # of the whole
        ("edge_v", "vec3f"),
    ]
)

# A photon of one channel that stands for a cell of the surface.
CausticBeam = struct(
    [
        ("landed", "vec2f"),  # in texels of the map
        ("flux", "f32"),  # over that which falls on a cell of a level surface
        ("depth_m", "f32"),  # of the landing below the surface
        ("entered", "vec2f"),  # like landed, where it came through the surface; the lamp's picture, if that is nearby
        ("entered_m", "f32"),  # below the highest wave
    ]
)
