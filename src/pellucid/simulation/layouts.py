"""Memory shared with the shaders of the simulations."""

from __future__ import annotations

from pellucid.gpu.layout import struct

# Weights of c^2 L' of the wave equation by how far a neighbour is along both axes: (0,0) (1,0) (1,1) (2,0) (2,1) (2,2).
RippleParams = struct(
    [
        ("size", "vec2u"),
        ("periodic", "u32"),
        ("step_s", "f32"),
        ("near", "vec4f"),
        ("far", "vec2f"),
        ("rest_s", "f32"),
        ("level_m", "f32"),
        ("limit_m", "f32"),
    ]
)

RippleDent = struct(
    [
        ("centre_m", "vec2f"),
        ("size", "vec2u"),
        ("cell_m", "f32"),
        ("radius_m", "f32"),
        ("strength_m", "f32"),
        ("balance", "f32"),  # k: makes the sum of the displacement zero
        ("periodic", "u32"),
    ]
)

RipplePush = struct(
    [
        ("centre_m", "vec2f"),
        ("size", "vec2u"),
        ("first", "vec2u"),  # column and row of the cells that it reaches
        ("count", "vec2u"),  # they go on beyond the last column and row with the first
        ("cell_m", "f32"),
        ("radius_m", "f32"),
        ("depth_m", "f32"),
    ]
)
