// Second pass: the radiance of what each pixel sees of the relief.
//!import surroundings/shaders/full_picture
//!import techniques/relief/shaders/enter
//!import techniques/relief/shaders/solid

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let record = textureLoad(relief_hits, vec2i(position.xy), 0);
    let layer = record.w & 3u;
    if layer == RELIEF_NONE {
        discard;
    }
    let bits = bitcast<vec3f>(record.xyz);
    let frame_at = relief_frame(record.w >> 2u, bits.yz);
    let direction_ws = camera_ray(position.xy).direction;
    let ray = relief_ray(frame_at, frame_at.uv, frame_at.h, direction_ws);
    let p_ws = frame_at.p_ws + bits.x * direction_ws;
    var uv = ray.uv + bits.x * ray.duv;
    if RELIEF_DEPTH == 1u {
        uv = relief_offset(frame_at, direction_ws);
    }
    let footprint = relief_footprint(frame_at, p_ws, direction_ws);
    var point = relief_solid_point(frame_at, uv, p_ws, footprint);
    if bits.x == 0.0 && any(frame_at.wall_ws != vec3f(0.0)) {
        point.n_ws = frame_at.wall_ws;
    }
    return vec4f(relief_solid_dry(point, -direction_ws, footprint), 1.0);
}
