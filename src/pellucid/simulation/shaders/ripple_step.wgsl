// One step of the wave equation: w += dt (c^2 L' u - 2 d w), u += dt w.

//!import simulation/shaders/ripple_bindings

@group(0) @binding(4) var<storage, read_write> following: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= ripples.size)) { return; }
    let cell = id.y * ripples.size.x + id.x;
    let w = ripple_next_velocity(vec2i(id.xy), cell);
    velocity[cell] = w;
    following[cell] = displacement[cell] + ripples.step_s * w;
}
