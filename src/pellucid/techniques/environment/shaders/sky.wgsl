// The environment behind everything: one triangle over the picture, at the depth of infinity.
//!import surroundings/shaders/camera
//!import surroundings/shaders/environment

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(environment_radiance(camera_ray(position.xy).direction), 1.0);
}
