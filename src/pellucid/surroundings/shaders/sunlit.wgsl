// Light that the map of a water tells of, onto what stays the same while waves move: see shading_apart.wgsl.
//!import surroundings/shaders/camera
//!import surroundings/shaders/full_picture
//!import surroundings/shaders/submerged_sun

@group(0) @binding(0) var shaded_rest: texture_2d<f32>;
@group(0) @binding(1) var shaded_sun: texture_2d<f32>;
@group(0) @binding(2) var shaded_depth: texture_2d<f32>;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let sun = textureLoad(shaded_sun, pixel, 0);
    let ray = camera_ray(position.xy);
    let metres = view_depth_m(textureLoad(shaded_depth, pixel, 0).r);
    let p_ws = ray.origin + metres / dot(ray.direction, frame.camera_forward) * ray.direction;
    let light = submerged_sun();
    let direction = submerged_direction(lights[light].direction, submersion.index[0].g);
    let share = submerged_share(light, p_ws, direction, 0u, sun.a);
    return vec4f(textureLoad(shaded_rest, pixel, 0).rgb + sun.rgb * share, 1.0);
}
