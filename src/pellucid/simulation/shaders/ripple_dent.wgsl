// A dent with a rim around it: u -= strength (k - s) exp(-s), s = (distance / radius)^2; fields/waves/ripples.py, dent.

//!struct RippleDent from simulation.layouts

@group(0) @binding(0) var<uniform> dent: RippleDent;
@group(0) @binding(1) var<storage, read_write> displacement: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= dent.size)) { return; }
    let pool = vec2f(dent.size) * dent.cell_m;
    var away = (vec2f(id.xy) + 0.5) * dent.cell_m - 0.5 * pool - dent.centre_m;
    away -= select(vec2f(0.0), pool * round(away / pool), dent.periodic != 0u);
    let s = dot(away, away) / (dent.radius_m * dent.radius_m);
    displacement[id.y * dent.size.x + id.x] -= dent.strength_m * (dent.balance - s) * exp(-s);
}
