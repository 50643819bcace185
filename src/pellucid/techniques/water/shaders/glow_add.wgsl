// The picture with the glow of lamps that water mirrors.
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var before: texture_2d<f32>;
@group(0) @binding(1) var glow_map: texture_2d<f32>;
@group(0) @binding(2) var glow_sampler: sampler;
@group(0) @binding(3) var<uniform> glow_strength: vec4f;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let uv = position.xy / vec2f(textureDimensions(before));
    let glow = glow_strength.x * textureSampleLevel(glow_map, glow_sampler, uv, 0.0).rgb;
    return vec4f(textureLoad(before, vec2i(position.xy), 0).rgb + glow, 1.0);
}
