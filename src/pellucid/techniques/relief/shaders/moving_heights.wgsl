// Heights of both layers in one map, bilinear between the texels of smaller ones (prepare.py, resized_heights).
//!import techniques/relief/shaders/moving_bindings

@group(0) @binding(1) var solid_heights: texture_2d<f32>;
@group(0) @binding(2) var translucent_heights: texture_2d<f32>;
@group(0) @binding(3) var height_map_out: texture_storage_2d<rg32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(height_map_out);
    if any(id.xy >= size) { return; }
    let place = (vec2f(id.xy) + 0.5) / vec2f(size);
    let lower = moving.solid_base_m + height_at(solid_heights, place);
    let upper = moving.translucent_base_m + height_at(translucent_heights, place);
    textureStore(height_map_out, id.xy, vec4f(lower, upper, 0.0, 0.0));
}

fn height_at(heights: texture_2d<f32>, place: vec2f) -> f32 {
    let size = vec2i(textureDimensions(heights));
    let at = place * vec2f(size) - 0.5;
    // What lies on a texel but for rounding is that texel: maps of one size are the same to the last bit.
    let nearest = round(at);
    let exact = select(at, nearest, abs(at - nearest) < vec2f(1e-4));
    let first = floor(exact);
    let share = exact - first;
    let low = moving_texel(vec2i(first), size);
    let high = moving_texel(vec2i(first) + 1, size);
    let upper = mix(textureLoad(heights, low, 0).r, textureLoad(heights, vec2i(high.x, low.y), 0).r, share.x);
    let lower = mix(textureLoad(heights, vec2i(low.x, high.y), 0).r, textureLoad(heights, high, 0).r, share.x);
    return mix(upper, lower, share.y);
}
