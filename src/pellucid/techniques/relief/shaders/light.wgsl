// Which share of a lamp's light reaches a point of the solid layer: looked up, found by rays, or as if all were level.
//!import techniques/relief/shaders/light_rays

override RELIEF_LIGHT_MAPS: bool = false;  // whether some lamp has its layer of the maps
override RELIEF_LIGHT_RAYS: bool = false;  // whether some lamp needs rays at every fragment
override RELIEF_CAUSTICS: bool = false;

// By channel, of the light that comes straight from the lamp
fn relief_light_share(point: ReliefPoint, light: u32) -> vec3f {
    if point.is_cut {
        return vec3f(1.0);  // before it there is nothing of the relief
    }
    if RELIEF_LIGHT_MAPS && relief_light_is_mapped(light) {
        let at = relief_map_uv(point.uv);
        return textureSampleLevel(light_map, surface_sampler, at, i32(light), 0.0).rgb;
    }
    var share = vec3f(1.0);
    if !RELIEF_OCCLUSION {
        share = relief_light_above(point, light);
    }
    if RELIEF_LIGHT_RAYS {
        share *= relief_light_rays(point.frame, point.p_ws, point.uv, point.h, light);
    }
    return share;
}

// Irradiance of light that matter has gathered, over that of a level surface in the open
fn relief_caustic(point: ReliefPoint, light: u32) -> vec3f {
    if !RELIEF_CAUSTICS || !relief_light_is_mapped(light) {
        return vec3f(0.0);
    }
    return textureSampleLevel(relief_caustic_map, surface_sampler, relief_map_uv(point.uv), i32(light), 0.0).rgb;
}

fn relief_light_is_mapped(light: u32) -> bool {
    return (relief.mapped_lights >> (light & 31u) & 1u) != 0u && light < 32u;
}

// Without occlusion: through the interface above the point, and through as much of the translucent layer as lies on
// the refracted way.
fn relief_light_above(point: ReliefPoint, light: u32) -> vec3f {
    let depth_m = relief_heights(point.uv).y - point.h;
    if !TWO_LAYERS || depth_m <= 0.0 {
        return vec3f(1.0);
    }
    let to_lamp_ws = relief_lamp(light, point.p_ws).to_ws;
    let n_ws = relief_normal(point.frame, point.uv, relief_translucent_slopes(point.uv, 0.0));
    let cos_i = dot(n_ws, to_lamp_ws);
    let inside = refract(-to_lamp_ws, n_ws, relief.n_outside, relief.n_layer.g);
    let path_m = depth_m / max(-dot(inside.direction, point.frame.N), 1e-3);
    let through = 1.0 - fresnel_dielectric(max(cos_i, 0.0), relief.n_outside, relief.n_layer.g);
    return select(0.0, through, cos_i > 0.0) * exp(-relief.absorption * path_m);
}
