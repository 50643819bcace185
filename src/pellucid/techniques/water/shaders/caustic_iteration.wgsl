// Where a refracted ray meets a mesh, by the iteration of [mihalik2008, 7.1].
//!import techniques/water/shaders/caustic_ray

// Depth of the best of all steps, metres. The camera is orthographic: the point A that it sees in the direction of W
// lies on a parallel to the light.
fn caustic_iteration(ray: CausticRay) -> f32 {
    let u = ray.origin;
    let r = ray.direction;
    let steps = min(caustic.steps, arrayLength(&caustic_beams));
    var a = caustic_point_of(u);
    var w = u + distance(a, u) * r;
    var best = u;
    var nearest = distance(a, u);
    for (var k = 0u; k < steps; k++) {
        let next = caustic_point_of(w);
        let error = distance(next, w);
        if error < nearest {
            nearest = error;
            best = w;
        }
        let q = next - a;
        let across = cross(r, q);
        let crossing = u + dot(cross(a - u, q), across) / max(dot(across, across), 1e-12) * r;
        // Between A and the next A it is taken [mihalik2008, eq. 3]; else W moves by how far it is off, up or down.
        let between = distance(crossing, a) + distance(next, crossing) <= 1.001 * length(q);
        let moved = w + select(error, -error, w.y < next.y) * r;
        w = select(moved, crossing, between);
        a = next;
    }
    return water.level + water.wave_high - best.y;
}

fn caustic_point_of(p_ws: vec3f) -> vec3f {
    let seen = p_ws.xz + caustic.slope * (water.level - p_ws.y);
    let depth = caustic_floor(seen);
    return vec3f(seen + caustic.slope * (water.wave_high - depth), water.level + water.wave_high - depth).xzy;
}
