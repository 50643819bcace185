// Shadow of the solid layer in equal steps, as in [timonen2006].
//!import techniques/relief/shaders/heights
//!import techniques/relief/shaders/reach

override RELIEF_SHADOWS: u32 = 1u;  // 0 none, 1 hard, 2 soft, 3 horizon map
override RELIEF_SHADOW_STEPS: u32 = 16u;

const SHADOW_LEAST_TAN = 1e-5;      // a lamp that is a point

// The thesis's: steps up to the top of the layer; clamp(h/d l/r + 1/2) [timonen2006, eq. 4], where r is to be read as
// the diameter: at w = r/2 of eq. 3 the light is full, which its text says of w = r.
fn relief_stepped_shadow(ray: ReliefRay, radius: f32, distance_m: f32) -> f32 {
    let reach = min(min(relief_rising(ray, relief.solid_high), relief_reach(ray)), distance_m);
    let step = reach / f32(RELIEF_SHADOW_STEPS);
    var least = 1e30;
    for (var k = 1u; k <= RELIEF_SHADOW_STEPS; k++) {
        let t = f32(k) * step;
        let gap = relief_height_along(ray, t) - relief_heights(ray.uv + t * ray.duv).x;
        least = min(least, gap / max(t, 1e-20));
    }
    if RELIEF_SHADOWS == 1u || step <= 0.0 {
        return select(1.0, 0.0, least < 0.0);
    }
    return saturate(least / max(2.0 * radius, SHADOW_LEAST_TAN) + 0.5);
}
