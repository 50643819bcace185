// Light that the map of a water tells of, onto what stays the same while waves move: see shading_apart.wgsl.
//!import surroundings/shaders/camera
//!import surroundings/shaders/full_picture
//!import surroundings/shaders/submerged_sky
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
    let rest = textureLoad(shaded_rest, pixel, 0);
    return vec4f(rest.rgb * mix(vec3f(1.0), sunlit_depth(p_ws), rest.a) + sun.rgb * share, 1.0);
}

// What waves take from the light of the sky, which was worked out for level water; 1 where there is none
fn sunlit_depth(p_ws: vec3f) -> vec3f {
    let level = submersion.level[0];
    let bounds = submersion.bounds[0];
    let inside = all(p_ws.xz >= bounds.xy) && all(p_ws.xz <= bounds.zw) && p_ws.y < level.x + level.y;
    let at_rest_m = level.x - p_ws.y;
    let more_m = max(at_rest_m + submerged_wave(0u, p_ws.xz), 0.0) - max(at_rest_m, 0.0);
    return select(vec3f(1.0), exp(-submerged_attenuation(0u) * more_m), inside);
}
