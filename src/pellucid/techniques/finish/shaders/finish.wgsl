// Radiance to a picture for a screen: glow, exposure, colours of the screen, tone mapping, sRGB.
//!import optics/colour
//!import techniques/finish/shaders/agx_encoded
//!import surroundings/shaders/full_picture
//!struct FinishParams from techniques.finish.passes

@group(0) @binding(0) var<uniform> finish_params: FinishParams;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var blurred: texture_2d<f32>;
@group(0) @binding(3) var blurred_sampler: sampler;

override FINISH_GLOW: bool = false;
override FINISH_TONE: u32 = 3u;  // place in passes.TONE_MAPPINGS

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var light = textureLoad(radiance, vec2i(position.xy), 0).rgb;
    if FINISH_GLOW {
        let uv = 0.5 * position.xy / vec2f(textureDimensions(blurred));
        light = mix(light, textureSampleLevel(blurred, blurred_sampler, uv, 0.0).rgb, finish_params.glow);
    }
    return vec4f(shown(into_gamut(finish_params.exposure * light)), 1.0);
}

fn shown(rgb: vec3f) -> vec3f {
    switch FINISH_TONE {
        case 1u: { return srgb_encode(tone_reinhard(rgb)); }
        case 2u: { return srgb_encode(tone_aces(rgb)); }
        case 3u: { return agx_encoded(rgb); }
        case 4u: { return srgb_encode(tone_khronos_neutral(rgb)); }
        default: { return srgb_encode(saturate(rgb)); }
    }
}
