// One triangle that covers the picture, at depth 0, which is infinity.

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return full_picture(vertex);
}

fn full_picture(vertex: u32) -> vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}
