// Sums of flux become what comes to a texel over what falls on a level surface, with the height of the surface beside
// it.
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/waves

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= caustic_side() {
        return;
    }
    var units = vec3u(0u);
    for (var channel = 0u; channel < min(caustic.channels, arrayLength(&caustic_sums)); channel++) {
        units[channel] = atomicLoad(&caustic_sums[caustic_cell(id.xy, channel)]);
    }
    let all_channels = select(units.rrr, units, caustic.channels == 3u);
    let height = wave_height(caustic_place(vec2f(id.xy) + 0.5));
    textureStore(caustic_map_out, vec2i(id.xy), caustic.layer, vec4f(vec3f(all_channels) / CAUSTIC_UNITS, height));
}
