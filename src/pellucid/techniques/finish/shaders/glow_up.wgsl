// The blur of one level and all coarser ones: weights fall by GLOW_SPREAD from level to level and sum to 1.
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var narrow: texture_2d<f32>;
@group(0) @binding(1) var coarser: texture_2d<f32>;
@group(0) @binding(2) var glow_sampler: sampler;

const GLOW_SPREAD = 0.65;  // share of the coarser levels, 0 to 1; a larger one glows wider

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let sharp = textureLoad(narrow, vec2i(position.xy), 0);
    return mix(sharp, magnified(0.5 * position.xy), GLOW_SPREAD);
}

// Tent of 3 x 3 texels over the bilinear filter, against the grid that plain magnification would show
fn magnified(texel: vec2f) -> vec4f {
    let size = vec2f(textureDimensions(coarser));
    var sum = vec4f(0.0);
    for (var k = 0; k < 9; k++) {
        let offset = vec2f(f32(k % 3), f32(k / 3)) - 1.0;
        let weight = (2.0 - abs(offset.x)) * (2.0 - abs(offset.y)) / 16.0;
        sum += weight * textureSampleLevel(coarser, glow_sampler, (texel + offset) / size, 0.0);
    }
    return sum;
}
