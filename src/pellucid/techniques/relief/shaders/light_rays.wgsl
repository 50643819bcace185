// Light of a lamp that reaches a point of the solid layer, found by rays towards the lamp.
//!import surroundings/shaders/bindings
//!import techniques/relief/shaders/light_shadow
//!import techniques/relief/shaders/light_through

override RELIEF_OCCLUSION: bool = false;  // whether the translucent layer dims it

struct ReliefLamp {
    to_ws: vec3f,      // unit, towards its middle
    tan_radius: f32,   // of the angle that its radius is seen under
    distance_m: f32,
}

// A rectangle counts as the disc of the same area. (Kinds of lamps: surroundings/layouts.py)
fn relief_lamp(light: u32, p_ws: vec3f) -> ReliefLamp {
    let lamp = lights[light];
    if lamp.kind == 0u {
        return ReliefLamp(lamp.direction, lamp.radius, RELIEF_NOWHERE);
    }
    let to_lamp = lamp.position - p_ws;
    let distance_m = max(length(to_lamp), 1e-9);
    return ReliefLamp(to_lamp / distance_m, lamp.radius / distance_m, distance_m);
}

// Share of each channel that reaches (uv, h) of the solid layer, which lies at p_ws
fn relief_light_rays(frame_at: ReliefFrame, p_ws: vec3f, uv: vec2f, h: f32, light: u32) -> vec3f {
    let lamp = relief_lamp(light, p_ws);
    let n_ws = relief_normal_at(frame_at, uv);
    let within = TWO_LAYERS && RELIEF_OCCLUSION && relief_heights(uv).y > h;
    var way = lamp.to_ws;
    if within {
        way = relief_bent(n_ws, lamp.to_ws);
    }
    let shadow = relief_shadow(relief_ray(frame_at, uv, h, way), lamp.tan_radius, lamp.distance_m);
    if !(TWO_LAYERS && RELIEF_OCCLUSION) || shadow <= 0.0 {
        return vec3f(shadow);
    }
    if RELIEF_LIGHT_STEPPED {
        return shadow * relief_stepped_through(frame_at, uv, h, within, lamp.to_ws);
    }
    return shadow * relief_through(frame_at, uv, h, within, way, lamp.to_ws);
}
