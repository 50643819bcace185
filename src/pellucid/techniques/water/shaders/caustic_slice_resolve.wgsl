// Sums of flux in slices of the water become light over that under a level surface.
//!import optics/fresnel
//!import techniques/water/shaders/caustic_cells

@group(0) @binding(28) var caustic_slice_out: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let side = textureDimensions(caustic_slice_out).x;
    if id.x >= side {
        return;
    }
    let units = atomicLoad(&caustic_sums[(id.z * side + id.y) * side + id.x]);
    let passed = 1.0 - caustic.loss * fresnel_dielectric(caustic.to_light.y, 1.0, caustic.index.r);
    let light = f32(units) / (CAUSTIC_UNITS * passed);
    textureStore(caustic_slice_out, vec3i(id), vec4f(light, light, light, 1.0));
}
