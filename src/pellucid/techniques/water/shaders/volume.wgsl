// What water takes from and adds to light along a straight way through it.
//!import optics/attenuation
//!import surroundings/shaders/environment
//!import techniques/water/shaders/bindings

struct WaterPath {
    transmittance: vec3f,
    inscatter: vec3f,  // radiance within the water
}

override WATER_COLOR: u32 = 0u;  // 0 what the water holds, 1 towards one colour [mihalik2008, eqs. 4, 5]

fn water_path(p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> WaterPath {
    if WATER_COLOR == 1u {
        let kept = transmittance(vec3f(water.clarity), length_m);
        return WaterPath(kept, (1.0 - kept) * water.color);
    }
    let extinction = water.absorption + water.scattering;
    let kept = transmittance(extinction, length_m);
    let albedo = water.scattering / max(extinction, vec3f(1e-9));
    return WaterPath(kept, (1.0 - kept) * albedo * environment_mean_radiance());
}
