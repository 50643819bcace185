// The next level of slopes: means over the area of each larger texel (surroundings/resample.py).

@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var slopes_out: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(slopes_out);
    if any(id.xy >= size) { return; }
    let wide = vec2f(textureDimensions(finer)) / vec2f(size);
    let low = vec2f(id.xy) * wide;
    let high = low + wide;
    let last = textureDimensions(finer) - 1u;
    let end = min(vec2u(ceil(high - 1e-3)) - 1u, last);
    var sum = vec3f(0.0);
    for (var row = u32(low.y + 1e-3); row <= end.y; row++) {
        for (var column = u32(low.x + 1e-3); column <= end.x; column++) {
            let texel = vec2f(f32(column), f32(row));
            let covered = min(high, texel + 1.0) - max(low, texel);
            let weight = covered.x * covered.y;
            sum += weight * vec3f(textureLoad(finer, vec2u(column, row), 0).rg, 1.0);
        }
    }
    textureStore(slopes_out, id.xy, vec4f(sum.xy / max(sum.z, 1e-6), 0.0, 0.0));
}
