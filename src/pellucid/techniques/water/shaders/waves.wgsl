// The surface as a height over (x, z): the sum of its layers of waves.
//!import techniques/water/shaders/bindings

struct WavePoint {
    height: f32,      // metres over the level
    slope: vec2f,     // dh/dx, dh/dz, the mean of a footprint
    fold: f32,        // Jacobian of the horizontal displacement, 1 where the water is not folded
    variance: vec3f,  // of slopes that a footprint hides: xx, zz, xz
}

// Not the uniform alone, see light_count in surroundings/shaders/lights.wgsl
fn wave_layer_count() -> u32 {
    return min(water.wave_layers, textureNumLayers(wave_map));
}

// Where a layer is read, 0 to 1 a tile; what does not repeat goes on as it ends
fn wave_uv(layer: u32, xz: vec2f) -> vec2f {
    return wave_uv_within(layer, xz, 0.5 / vec2f(textureDimensions(wave_map)));
}

fn wave_uv_within(layer: u32, xz: vec2f, margin: vec2f) -> vec2f {
    let tile = water.wave_tiles[layer];
    let uv = (xz - water.center) / tile.xy + 0.5;
    let inner = min(margin, vec2f(0.5));
    return select(clamp(uv, inner, 1.0 - inner), fract(uv), tile.z > 0.5);
}

fn wave_height(xz: vec2f) -> f32 {
    var height = 0.0;
    for (var layer = 0u; layer < wave_layer_count(); layer++) {
        height += textureSampleLevel(wave_map, wave_sampler, wave_uv(layer, xz), layer, 0.0).r;
    }
    return height;
}

// The water that a footprint covers: beyond the width of a cell slopes and their squares are means, from levels that
// halve the cells; variance is the mean square less the squared mean [olano2010, 3]. The height stays that of the point.
fn wave_point(xz: vec2f, footprint_m: f32) -> WavePoint {
    var at = WavePoint(0.0, vec2f(0.0), 1.0, water.short_slopes);
    let size = vec2f(textureDimensions(wave_map));
    for (var layer = 0u; layer < wave_layer_count(); layer++) {
        let tile = water.wave_tiles[layer];
        let level = log2(max(footprint_m * sqrt(size.x * size.y / (tile.x * tile.y)), 1e-6));
        let here = textureSampleLevel(wave_map, wave_sampler, wave_uv(layer, xz), layer, 0.0);
        let coarse = max(level - 1.0, 0.0);
        let uv = wave_uv_within(layer, xz, exp2(min(ceil(coarse), 16.0)) / size);
        let mean = textureSampleLevel(wave_moments, wave_sampler, uv, 2u * layer, coarse);
        let square = textureSampleLevel(wave_moments, wave_sampler, uv, 2u * layer + 1u, coarse);
        let share = saturate(level);
        let slope = mix(here.gb, mean.rg, share);
        let squares = mix(vec3f(here.gb * here.gb, here.g * here.b), square.rgb, share);
        at.height += here.r;
        at.slope += slope;
        at.fold += mix(here.a, mean.b, share) - 1.0;
        at.variance += squares - vec3f(slope * slope, slope.x * slope.y);
    }
    at.variance = wave_possible(at.variance);
    return at;
}

// Rounding may leave a variance just below zero, or a product beyond what its factors allow
fn wave_possible(variance: vec3f) -> vec3f {
    let own = max(variance.xy, vec2f(0.0));
    let bound = sqrt(own.x * own.y);
    return vec3f(own, clamp(variance.z, -bound, bound));
}

fn wave_normal(slope: vec2f) -> vec3f {
    return normalize(vec3f(-slope.x, 1.0, -slope.y));
}
