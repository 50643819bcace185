// First pass: what each pixel shows of the water, and how deep.
//!import surroundings/shaders/full_picture
//!import techniques/water/shaders/first

struct WaterFound {
    @location(0) record: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> WaterFound {
    let ray = camera_ray(position.xy);
    let drawn = textureLoad(opaque_depth, vec2i(position.xy), 0);
    let t_max = view_depth_m(drawn) / dot(ray.direction, frame.camera_forward);
    let hit = water_first(ray.origin, ray.direction, t_max);
    if hit.kind == WATER_NONE {
        discard;
    }
    let depth = clamp(depth_of(ray.origin + hit.t * ray.direction), drawn, 1.0);
    return WaterFound(water_record(hit, 0u), select(depth, drawn, hit.kind >= WATER_FOG));
}
