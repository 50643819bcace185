// Light in the water at some depths: each photon is spread where its ray passes, unless a mesh has stopped it before.
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/caustic_spread

@group(0) @binding(28) var caustic_slice_out: texture_storage_3d<rgba16float, write>;

const SLICE_CELLS = 2u;  // along a side, of photons to one texel of a slice

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let side = textureDimensions(caustic_slice_out).x;
    if id.x >= side {
        return;
    }
    let depth_m = (f32(id.z) + 0.5) / f32(textureDimensions(caustic_slice_out).z) * caustic.reach_m;
    let beam = slice_beam(SLICE_CELLS * id.xy, depth_m);
    if beam.z <= 0.0 {
        return;
    }
    let right = slice_beam(SLICE_CELLS * id.xy + vec2u(SLICE_CELLS, 0u), depth_m).xy - beam.xy;
    let down = slice_beam(SLICE_CELLS * id.xy + vec2u(0u, SLICE_CELLS), depth_m).xy - beam.xy;
    caustic_spread(beam.xy, right, down, vec2f(0.0), beam.z, vec3u(side, side, id.z * side));
}

// Place at a depth in texels of a slice, and flux that gets there
fn slice_beam(cell: vec2u, depth_m: f32) -> vec3f {
    let beam = caustic_beams[caustic_cell(min(cell, vec2u(caustic_side() - 1u)), 0u)];
    let share = (depth_m - beam.entered_m) / max(beam.depth_m, 1e-6);
    let at = mix(beam.entered, beam.landed, share) / f32(SLICE_CELLS);
    return vec3f(at, select(0.0, beam.flux, share <= 1.0 + 1e-3));
}
