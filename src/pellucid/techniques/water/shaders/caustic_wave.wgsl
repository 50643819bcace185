// The surface where a photon comes through it: without what wave_point knows of footprints, which costs twice as much.
//!import techniques/water/shaders/waves

// Height over the level, metres, and slopes dh/dx, dh/dz
fn caustic_wave(xz: vec2f) -> vec3f {
    var sum = vec3f(0.0);
    for (var layer = 0u; layer < wave_layer_count(); layer++) {
        sum += textureSampleLevel(wave_map, wave_sampler, wave_uv(layer, xz), layer, 0.0).rgb;
    }
    return sum;
}
