// Which share of a lamp's light reaches a point of the solid layer.
//!import optics/fresnel
//!import optics/snell
//!import surroundings/shaders/lights
//!import techniques/relief/shaders/search

// By channel, for light that arrives from a unit direction: through the interface above the point, and through as much
// of the translucent layer as lies on the refracted way.
fn relief_light_share(point: ReliefPoint, light: u32, direction_ws: vec3f) -> vec3f {
    let both = relief_heights(point.uv);
    let depth_m = both.y - point.h;
    if !TWO_LAYERS || depth_m <= 0.0 {
        return vec3f(1.0);
    }
    let n_ws = relief_normal(point.frame, point.uv, relief_translucent_slopes(point.uv, 0.0));
    let cos_i = dot(n_ws, direction_ws);
    let n = relief.n_layer.g;
    let inside = refract(-direction_ws, n_ws, relief.n_outside, n);
    let path_m = depth_m / max(-dot(inside.direction, point.frame.N), 1e-3);
    let through = 1.0 - fresnel_dielectric(max(cos_i, 0.0), relief.n_outside, n);
    return select(0.0, through, cos_i > 0.0) * exp(-relief.absorption * path_m);
}
