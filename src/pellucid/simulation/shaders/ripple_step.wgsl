// One step of the wave equation: w += dt (c^2 L' u - 2 d w), u += dt w.

//!import simulation/shaders/ripple_bindings

@group(0) @binding(4) var<storage, read_write> following: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= ripples.size.x) { return; }
    let first = id.y * RIPPLE_STRIP;
    let columns = ripple_columns(id.x);
    var rows = ripple_rows_before(i32(first), columns);
    for (var row = first; row < min(first + RIPPLE_STRIP, ripples.size.y); row++) {
        rows = ripple_rows_next(rows, i32(row), columns);
        let cell = row * ripples.size.x + id.x;
        let w = ripple_next_velocity(rows, cell);
        velocity[cell] = w;
        following[cell] = displacement[cell] + ripples.step_s * w;
    }
}
