// The next level of bounds: two nodes to one along each axis; an odd one at the end belongs to the last.

@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var bounds_out: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(bounds_out);
    if any(id.xy >= size) { return; }
    let last = textureDimensions(finer) - 1u;
    let first = min(2u * id.xy, last);
    let end = select(min(first + 1u, last), last, id.xy == size - 1u);
    var highest = vec2f(-1e38);
    var lowest = vec2f(1e38);
    for (var row = first.y; row <= end.y; row++) {
        for (var column = first.x; column <= end.x; column++) {
            let node = textureLoad(finer, vec2u(column, row), 0);
            highest = max(highest, node.xz);
            lowest = min(lowest, node.yw);
        }
    }
    textureStore(bounds_out, id.xy, vec4f(highest.x, lowest.x, highest.y, lowest.y));
}
