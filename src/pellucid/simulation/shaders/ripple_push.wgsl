// What floats on the water presses on it: q = depth exp(-(distance / radius)^2); fields/waves/ripples.py, push.

//!struct RipplePush from simulation.layouts

@group(0) @binding(0) var<uniform> push: RipplePush;
@group(0) @binding(1) var<storage, read_write> pressed: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= push.count)) { return; }
    let at = push.first + id.xy;
    let away = (vec2f(at) + 0.5 - 0.5 * vec2f(push.size)) * push.cell_m - push.centre_m;
    let cell = at % push.size;
    let s = dot(away, away) / (push.radius_m * push.radius_m);
    pressed[cell.y * push.size.x + cell.x] += push.depth_m * exp(-s);
}
