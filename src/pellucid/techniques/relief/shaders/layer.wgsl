// The translucent layer where a ray of the camera meets it: reflected and refracted looks with their weights.
//!import optics/fresnel
//!import techniques/relief/shaders/reflection
//!import techniques/relief/shaders/refraction
//!import techniques/relief/shaders/solid

override RELIEF_DISPERSION: bool = false;  // whether red, green and blue are refracted apart

// Where a ray of the camera is on the translucent layer
struct LayerPoint {
    uv: vec2f,
    h: f32,
    p_ws: vec3f,
    n_ws: vec3f,
    direction_ws: vec3f,
    footprint: f32,
    reflected: vec3f,  // Fresnel's reflectance by channel
}

fn relief_layer_reflectance(cos_i: f32) -> vec3f {
    if !RELIEF_DISPERSION {
        return vec3f(fresnel_dielectric(cos_i, relief.n_outside, relief.n_layer.g));
    }
    return vec3f(
        fresnel_dielectric(cos_i, relief.n_outside, relief.n_layer.r),
        fresnel_dielectric(cos_i, relief.n_outside, relief.n_layer.g),
        fresnel_dielectric(cos_i, relief.n_outside, relief.n_layer.b),
    );
}

fn relief_reflect(frame_at: ReliefFrame, at: LayerPoint, outside: ptr<function, OutsideLooks>) -> SolidLook {
    let direction_ws = reflect(at.direction_ws, at.n_ws);
    let ray = relief_ray(frame_at, at.uv, at.h, direction_ws);
    let hit = relief_mirrored(ray);
    let alpha = relief.translucent_roughness * relief.translucent_roughness;
    let meets = hit.layer == RELIEF_SOLID;
    let away = select(at.reflected, vec3f(0.0), meets);
    (*outside).mirrored = OutsideLook(at.p_ws, direction_ws, alpha, away);
    let p_there = at.p_ws + hit.t * direction_ws;
    return SolidLook(at.uv + hit.t * ray.duv, at.footprint, false, p_there, -direction_ws, at.reflected - away);
}

// A lossless ray keeps L / n^2: radiance of the layer below leaves the matter divided by the squared relative index
// [born1999, 4.8.3]; a ray that passes right through sees the surroundings as they are.
fn relief_refract(frame_at: ReliefFrame, at: LayerPoint, k: u32, outside: ptr<function, OutsideLooks>) -> SolidLook {
    let n = select(relief.n_layer.g, relief.n_layer[k], RELIEF_DISPERSION);
    let one = vec3f(vec3u(k) == vec3u(0u, 1u, 2u));
    let share = select(vec3f(1.0), one, RELIEF_DISPERSION) * (1.0 - at.reflected);
    let inside = refract(at.direction_ws, at.n_ws, relief.n_outside, n);
    let end = relief_refracted(frame_at, at.uv, at.p_ws, at.h, inside.direction, n);
    let weight = share * exp(-relief.absorption * end.path_m);
    let scattered = 1.0 - exp(-relief.scattering * end.path_m);
    let spread = at.footprint + scattered * end.path_m / relief_side_m(frame_at);
    if !end.solid {
        (*outside).passed = OutsideLook(end.p_ws, end.direction_ws, scattered, (*outside).passed.weight + weight);
    }
    let denser = relief.n_outside / relief.n_layer;
    let seen = select(vec3f(0.0), weight * select(vec3f(1.0), denser * denser, end.wet), end.solid);
    return SolidLook(end.uv, spread, end.wet, end.p_ws, -end.direction_ws, seen);
}
