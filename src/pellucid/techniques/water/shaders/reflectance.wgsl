// What the surface of water mirrors, and the normal that it is seen with.
//!import optics/fresnel
//!import techniques/water/shaders/bindings

override WATER_FRESNEL: u32 = 0u;  // 0 exact, 1 Schlick's curve

const WATER_GRAZING = 1e-4;  // least cosine between normal and view

fn water_reflectance(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    if WATER_FRESNEL == 1u {
        let c = saturate(cos_i);
        let q_squared = (n_t - n_i) * (n_t + n_i) + n_i * c * (n_i * c);
        let cosine = select(c, sqrt(max(q_squared, 0.0)) / n_t, n_i > n_t);
        return schlick(normal_reflectance(n_i, n_t), cosine, water.schlick_power);
    }
    return fresnel_dielectric(cos_i, n_i, n_t);
}

// A normal that leans away from the viewer is turned until it just faces them: slopes are those of a whole pixel
fn water_towards(n_ws: vec3f, direction_ws: vec3f) -> vec3f {
    let facing = -dot(n_ws, direction_ws);
    return select(n_ws, normalize(n_ws - (WATER_GRAZING - facing) * direction_ws), facing < WATER_GRAZING);
}
