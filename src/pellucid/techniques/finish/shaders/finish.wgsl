// Radiance to a picture for a screen: exposure, tone mapping, sRGB.
//!import optics/colour
//!struct FinishParams from techniques.finish.passes

@group(0) @binding(0) var<uniform> finish_params: FinishParams;
@group(0) @binding(1) var radiance: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let exposed = finish_params.exposure * textureLoad(radiance, vec2i(position.xy), 0).rgb;
    return vec4f(srgb_encode(saturate(tone_mapped(max(exposed, vec3f(0.0))))), 1.0);
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
