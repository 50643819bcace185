// Share of the sky's light that meshes leave to a surface in water, with what they throw back; see open_sky.py.
//!import surroundings/shaders/submersion

const OPEN_CELLS = vec3f(24.0, 8.0, 24.0);  // layouts.OPEN_SIZE
const OPEN_AWAY = 0.5;                      // cells off the surface that is lit
const OPEN_LEAST = 1e-3;                    // of the sky, so that what is white and closed in divides by something

fn submerged_sky_left(p_ws: vec3f, n_ws: vec3f, water: u32) -> vec3f {
    let bounds = submersion.bounds[water];
    let depth_m = submersion.absorption[water].w;
    let level = submersion.level[water];
    let low = vec3f(bounds.x, level.x + level.y - depth_m, bounds.y);
    let size = vec3f(bounds.z - bounds.x, depth_m, bounds.w - bounds.y);
    let at = clamp((p_ws - low) / size * OPEN_CELLS + OPEN_AWAY * n_ws, vec3f(0.5), OPEN_CELLS - 0.5) - 0.5;
    let first = min(floor(at), OPEN_CELLS - 2.0);
    let share = at - first;
    var sides = vec4f(0.0);  // +x, -x, +y, +z
    var rest = vec4f(0.0);   // -z, albedo
    for (var k = 0u; k < select(0u, 8u, depth_m > 0.0); k++) {
        let corner = vec3f(f32(k & 1u), f32((k >> 1u) & 1u), f32(k >> 2u));
        let cell = vec3u(first + corner);
        let weight = mix(1.0 - share, share, corner);
        let packed = submerged_open[((water * 24u + cell.z) * 8u + cell.y) * 24u + cell.x];
        let one = vec4f(unpack2x16float(packed.x), unpack2x16float(packed.y));
        let other = vec4f(unpack2x16float(packed.z), unpack2x16float(packed.w));
        sides += weight.x * weight.y * weight.z * one;
        rest += weight.x * weight.y * weight.z * other;
    }
    let n = vec3f(n_ws.x, max(n_ws.y, 0.0), n_ws.z);
    let parts = n * n / max(dot(n, n), 1e-6);
    let x = select(sides.y, sides.x, n.x > 0.0);
    let z = select(rest.x, sides.w, n.z > 0.0);
    let seen = saturate(dot(parts, vec3f(x, sides.z, z)));
    let kept = (seen + OPEN_LEAST) / (1.0 - rest.yzw * (1.0 - seen) + OPEN_LEAST);
    return select(vec3f(1.0), kept, depth_m > 0.0);
}
