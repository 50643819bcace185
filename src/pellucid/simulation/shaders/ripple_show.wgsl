// Heights a part of a step after the last state; after a whole step they are the next state.

//!import simulation/shaders/ripple_bindings

@group(0) @binding(5) var heights: texture_storage_2d<r32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= ripples.size)) { return; }
    let cell = id.y * ripples.size.x + id.x;
    let before = velocity[cell];
    let after = ripple_next_velocity(vec2i(id.xy), cell);
    let s = ripples.rest_s;
    let u = displacement[cell] + s * 0.5 * (before + after) + s * s / (2.0 * ripples.step_s) * (after - before);
    let height = ripples.level_m + clamp(u, -ripples.limit_m, ripples.limit_m);
    textureStore(heights, id.xy, vec4f(height, 0.0, 0.0, 0.0));
}
