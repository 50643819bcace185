// Highest and lowest corner of each cell of both layers: the first level of fields/heightfield.py, bounds_pyramid.
//!import techniques/relief/shaders/moving_bindings

@group(0) @binding(1) var height_map: texture_2d<f32>;
@group(0) @binding(2) var bounds_out: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2i(textureDimensions(height_map));
    let at = vec2i(id.xy);
    if any(at >= size) { return; }
    let ahead = moving_texel(at + 1, size);
    let a = textureLoad(height_map, at, 0).rg;
    let b = textureLoad(height_map, vec2i(ahead.x, at.y), 0).rg;
    let c = textureLoad(height_map, vec2i(at.x, ahead.y), 0).rg;
    let d = textureLoad(height_map, ahead, 0).rg;
    let highest = max(max(a, b), max(c, d));
    let lowest = min(min(a, b), min(c, d));
    textureStore(bounds_out, id.xy, vec4f(highest.x, lowest.x, highest.y, lowest.y));
}
