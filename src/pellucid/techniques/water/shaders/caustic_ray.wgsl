// A refracted ray under the camera of a caustic map. Depths count downwards from the highest wave; `seen` is the place
// on the level where the camera shows a point.
//!import techniques/water/shaders/caustic_bindings

struct CausticRay {
    origin: vec3f,      // world space
    direction: vec3f,   // unit
    seen: vec2f,        // of the origin, metres
    drift: vec2f,       // change of `seen` with depth
    depth_m: f32,       // of the origin
}

fn caustic_ray(origin: vec3f, direction: vec3f) -> CausticRay {
    let drift = direction.xz / max(-direction.y, 1e-4) + caustic.slope;
    let seen = origin.xz + caustic.slope * (water.level - origin.y);
    return CausticRay(origin, direction, seen, drift, water.level + water.wave_high - origin.y);
}

fn caustic_seen(ray: CausticRay, depth_m: f32) -> vec2f {
    return ray.seen + ray.drift * (depth_m - ray.depth_m);
}

// Depth of the first mesh that the camera sees at a place, metres; the reach of the map where there is none
fn caustic_floor(seen: vec2f) -> f32 {
    let size = vec2f(textureDimensions(caustic_below));
    let at = clamp((seen - water.low) / (water.high - water.low) * size, vec2f(0.0), size - 1.0);
    return caustic.reach_m * textureLoad(caustic_below, vec2i(at), caustic.layer, 0);
}
