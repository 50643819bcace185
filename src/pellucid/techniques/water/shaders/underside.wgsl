// The surface from below as [mihalik2008, 7.5] has it, where no ray is totally reflected.
//!import optics/fresnel
//!import techniques/water/shaders/bindings

override WATER_UNDERSIDE: u32 = 0u;  // water_quality.UNDERSIDES

// What stands for the refracted ray, no unit vector; `n` faces the viewer, as the source's does not
// [mihalik2008, eq. 12]
fn underside_way(direction: vec3f, n: vec3f, n_i: f32, n_t: f32) -> vec3f {
    let eta = n_i / n_t;
    return eta * (direction + n) - n;
}

// With the cosine in the water, whatever the angle [mihalik2008, eqs. 7, 8]
fn underside_reflectance(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    return schlick(normal_reflectance(n_i, n_t), cos_i, water.schlick_power);
}
