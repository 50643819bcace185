// What water takes from and adds to light along a straight way through it.
//!import optics/attenuation
//!import techniques/water/shaders/volume_light

struct WaterPath {
    transmittance: vec3f,
    inscatter: vec3f,  // radiance within the water
}

override WATER_COLOR: u32 = 0u;  // 0 what the water holds, 1 towards one colour [mihalik2008, eqs. 4, 5]

const LONGEST_PATH_M = 1e6;

// C_w + exp(-k d)(C - C_w) [mihalik2008, eqs. 4, 5, 10], which knows of no n^2 at the surface (dilution.wgsl); or
// exp(-(a + b) d), and what is scattered into the way.
fn water_path(p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> WaterPath {
    let way_m = min(length_m, LONGEST_PATH_M);
    if WATER_COLOR == 1u {
        let kept = transmittance(vec3f(water.clarity), way_m);
        return WaterPath(kept, (1.0 - kept) * water.color);
    }
    let extinction = water.absorption + water.scattering;
    return WaterPath(transmittance(extinction, way_m), water_inscatter(p_ws, direction_ws, way_m));
}
