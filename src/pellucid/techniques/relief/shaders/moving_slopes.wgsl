// Slopes of one layer at its own size, by central differences, one-sided at a border that does not repeat
// (fields/heightfield.py, slopes_of).
//!import techniques/relief/shaders/moving_bindings

@group(0) @binding(1) var layer_heights: texture_2d<f32>;
@group(0) @binding(2) var slopes_out: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2i(textureDimensions(layer_heights));
    let at = vec2i(id.xy);
    if any(at >= size) { return; }
    let before = moving_texel(at - 1, size);
    let after = moving_texel(at + 1, size);
    let along = textureLoad(layer_heights, vec2i(after.x, at.y), 0).r - textureLoad(layer_heights, vec2i(before.x, at.y), 0).r;
    let across = textureLoad(layer_heights, vec2i(at.x, before.y), 0).r - textureLoad(layer_heights, vec2i(at.x, after.y), 0).r;
    let texels = select(max(vec2f(after - before), vec2f(1.0)), vec2f(2.0), moving.tiling != 0u);
    // Rows grow downwards, v upwards.
    let slopes = vec2f(along, across) * vec2f(size) / (texels * moving.tile_m);
    textureStore(slopes_out, id.xy, vec4f(slopes, 0.0, 0.0));
}
