// First pass: what each pixel sees of the relief, and how deep.
//!import techniques/relief/shaders/hull
//!import techniques/relief/shaders/enter

struct Found {
    @location(0) record: vec4u,  // bits of t and of two barycentric weights; triangle * 4 + layer
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_main(in: HullVarying) -> Found {
    let frame_at = relief_frame(in.triangle, in.barycentric);
    let direction_ws = camera_ray(in.clip.xy).direction;
    let ray = relief_ray(frame_at, frame_at.uv, frame_at.h, direction_ws);
    let hit = relief_enter(frame_at, ray);
    if hit.layer == RELIEF_NONE {
        discard;
    }
    let bits = bitcast<vec3u>(vec3f(hit.t, in.barycentric));
    return Found(vec4u(bits, in.triangle * 4u + hit.layer), depth_of(frame_at.p_ws + hit.t * direction_ws));
}
