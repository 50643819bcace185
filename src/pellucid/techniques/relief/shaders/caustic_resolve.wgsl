// Sums of flux become irradiance, over that of a level surface; the sums begin anew.
//!import techniques/relief/shaders/caustic_bindings
//!import techniques/relief/shaders/light_plane

@group(0) @binding(17) var caustic_map_out: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relief.texels) {
        return;
    }
    let place = 3u * caustic_index(id.xy);
    let units = vec3u(
        atomicExchange(&caustic_sums[place], 0u),
        atomicExchange(&caustic_sums[place + 1u], 0u),
        atomicExchange(&caustic_sums[place + 2u], 0u),
    );
    textureStore(caustic_map_out, vec2i(id.xy), plane.light, vec4f(vec3f(units) / CAUSTIC_UNITS, 1.0));
}
