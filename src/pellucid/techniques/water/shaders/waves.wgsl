// The surface as a height over (x, z): the sum of its layers of waves.
//!import techniques/water/shaders/bindings

struct WavePoint {
    height: f32,      // metres over the level
    slope: vec2f,     // dh/dx, dh/dz
    fold: f32,        // Jacobian of the horizontal displacement, 1 where the water is not folded
    variance: vec3f,  // of slopes that a footprint hides: xx, zz, xz
}

// Not the uniform alone, see light_count in surroundings/shaders/lights.wgsl
fn wave_layer_count() -> u32 {
    return min(water.wave_layers, textureNumLayers(wave_map));
}

// Where a layer is read, 0 to 1 a tile; what does not repeat goes on as it ends
fn wave_uv(layer: u32, xz: vec2f) -> vec2f {
    let tile = water.wave_tiles[layer];
    let uv = (xz - water.center) / tile.xy + 0.5;
    let half = 0.5 / vec2f(textureDimensions(wave_map));
    return select(clamp(uv, half, 1.0 - half), fract(uv), tile.z > 0.5);
}

fn wave_height(xz: vec2f) -> f32 {
    var height = 0.0;
    for (var layer = 0u; layer < wave_layer_count(); layer++) {
        height += textureSampleLevel(wave_map, wave_sampler, wave_uv(layer, xz), layer, 0.0).r;
    }
    return height;
}

fn wave_point(xz: vec2f, footprint_m: f32) -> WavePoint {
    var at = WavePoint(0.0, vec2f(0.0), 1.0, vec3f(0.0));
    for (var layer = 0u; layer < wave_layer_count(); layer++) {
        let texel = textureSampleLevel(wave_map, wave_sampler, wave_uv(layer, xz), layer, 0.0);
        at.height += texel.r;
        at.slope += texel.gb;
        at.fold += texel.a - 1.0;
    }
    return at;
}
