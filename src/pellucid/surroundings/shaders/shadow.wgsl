// How much of a directional light reaches a point, from its shadow map.
//!import surroundings/shaders/bindings

override SHADOW_MAPS: bool = true;  // whether some lamp has one

const SHADOW_REACH_TEXELS = 2.2;  // half the diagonal of the filter below

// Mean of 3 x 3 texels by four bilinear comparisons [reeves1987]. The point is moved along the normal by just as
// much as the filter's reach can lie before a tilted surface, which leaves no acne and the least possible gap.
fn shadow_visibility(light: u32, p_ws: vec3f, n_ws: vec3f) -> f32 {
    let layer = lights[light].shadow_layer;
    if !SHADOW_MAPS || layer < 0 {
        return 1.0;
    }
    let cosine = dot(n_ws, lights[light].direction);
    let sine = sqrt(saturate(1.0 - cosine * cosine));
    let offset_m = lights[light].shadow_texel_m * (0.05 + SHADOW_REACH_TEXELS * sine);
    let clip = lights[light].shadow_from_world * vec4f(p_ws + n_ws * offset_m, 1.0);
    if any(abs(clip.xy) > vec2f(1.0)) {
        return 1.0;
    }
    let uv = vec2f(0.5, -0.5) * clip.xy + 0.5;
    let depth = min(clip.z, 1.0);
    let half_texel = 0.5 / f32(textureDimensions(shadow_maps).x);
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let corner = vec2f(f32(k & 1), f32(k >> 1)) * 2.0 - 1.0;
        sum += textureSampleCompareLevel(shadow_maps, shadow_sampler, uv + corner * half_texel, layer, depth);
    }
    return 0.25 * sum;
}
