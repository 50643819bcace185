// Heights a part of a step after the last state; after a whole step they are the next state.

//!import simulation/shaders/ripple_bindings

@group(0) @binding(5) var heights: texture_storage_2d<r32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= ripples.size.x) { return; }
    let first = id.y * RIPPLE_STRIP;
    let columns = ripple_columns(id.x);
    var rows = ripple_rows_before(i32(first), columns);
    for (var row = first; row < min(first + RIPPLE_STRIP, ripples.size.y); row++) {
        rows = ripple_rows_next(rows, i32(row), columns);
        let cell = row * ripples.size.x + id.x;
        let before = velocity[cell];
        let after = ripple_next_velocity(rows, cell);
        let s = ripples.rest_s;
        let u = displacement[cell] + s * 0.5 * (before + after) + s * s / (2.0 * ripples.step_s) * (after - before);
        let height = ripples.level_m + clamp(u, -ripples.limit_m, ripples.limit_m);
        textureStore(heights, vec2u(id.x, row), vec4f(height, 0.0, 0.0, 0.0));
    }
}
