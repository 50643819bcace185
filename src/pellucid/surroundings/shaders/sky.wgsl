// The environment behind everything.
//!import surroundings/shaders/camera
//!import surroundings/shaders/environment
//!import surroundings/shaders/full_picture

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(environment_radiance(camera_ray(position.xy).direction), 1.0);
}
