// Sums of flux become what comes to a texel over what falls on a level surface, with the height of the surface beside
// it.
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/waves

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let side = textureDimensions(caustic_map_out).x;
    if id.x >= side {
        return;
    }
    // In cells; without rounding where these are the texels.
    let at = (vec2f(id.xy) + 0.5) * f32(caustic_side()) / f32(side);
    var units = vec3f(0.0);
    for (var channel = 0u; channel < min(caustic.channels, arrayLength(&caustic_sums)); channel++) {
        units[channel] = caustic_between(at - 0.5, channel);
    }
    let all_channels = select(units.rrr, units, caustic.channels == 3u);
    let height = caustic.focus * wave_height(caustic_place(at));
    textureStore(caustic_map_out, vec2i(id.xy), caustic.layer, vec4f(all_channels / CAUSTIC_UNITS, height));
}

// Units of flux between the middles of four cells
fn caustic_between(at: vec2f, channel: u32) -> f32 {
    let first = floor(at);
    let share = at - first;
    var sum = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let corner = vec2f(f32(k & 1u), f32(k >> 1u));
        let cell = vec2u(clamp(first + corner, vec2f(0.0), vec2f(f32(caustic_side() - 1u))));
        let weight = mix(1.0 - share, share, corner);
        sum += weight.x * weight.y * f32(atomicLoad(&caustic_sums[caustic_cell(cell, channel)]));
    }
    return sum;
}
