// Radiance to a picture for a screen: glow, exposure, colours of the screen, tone mapping, sRGB.
//!import optics/colour
//!import surroundings/shaders/full_picture
//!struct FinishParams from techniques.finish.passes

@group(0) @binding(0) var<uniform> finish_params: FinishParams;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var blurred: texture_2d<f32>;
@group(0) @binding(3) var blurred_sampler: sampler;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var light = textureLoad(radiance, vec2i(position.xy), 0).rgb;
    let uv = 0.5 * position.xy / vec2f(textureDimensions(blurred));
    let scattered = mix(light, textureSampleLevel(blurred, blurred_sampler, uv, 0.0).rgb, finish_params.glow);
    light = select(light, scattered, finish_params.glow > 0.0);
    let exposed = into_gamut(finish_params.exposure * light);
    return vec4f(srgb_encode(saturate(tone_mapped(exposed))), 1.0);
}

// The order of passes.TONE_MAPPINGS
fn tone_mapped(rgb: vec3f) -> vec3f {
    switch finish_params.tone_mapping {
        case 1u: { return tone_reinhard(rgb); }
        case 2u: { return tone_aces(rgb); }
        case 3u: { return tone_agx(rgb); }
        case 4u: { return tone_khronos_neutral(rgb); }
        default: { return rgb; }
    }
}
