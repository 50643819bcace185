// Adds a picture to the sum of the pictures before it.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> sum: array<vec4f>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(picture);
    if (any(id.xy >= size)) { return; }
    sum[id.y * size.x + id.x] += textureLoad(picture, id.xy, 0);
}
