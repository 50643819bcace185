// First pass: what each pixel sees of the relief, and how deep.
//!import techniques/relief/shaders/hull
//!import techniques/relief/shaders/enter
//!import techniques/relief/shaders/footprint

struct Found {
    @location(0) record: vec4u,  // bits of t and of two barycentric weights; triangle * 4 + layer
    @builtin(frag_depth) depth: f32,
}

// A software driver also runs the shader beside a triangle, in whole blocks of pixels: searches would go astray there
const FIND_SLACK = 1e-3;

@fragment
fn fs_main(in: HullVarying) -> Found {
    var found = Found(vec4u(0u), 0.0);
    let b = in.barycentric;
    if all(b > vec2f(-FIND_SLACK)) && b.x + b.y < 1.0 + FIND_SLACK {
        found = found_in(in.triangle, b, camera_ray(in.clip.xy).direction);
    }
    if (found.record.w & 3u) == RELIEF_NONE {
        discard;
    }
    return found;
}

fn found_in(triangle: u32, b: vec2f, direction_ws: vec3f) -> Found {
    let frame_at = relief_frame(triangle, b);
    let ray = relief_ray(frame_at, frame_at.uv, frame_at.h, direction_ws);
    relief_pixel_tiles = relief_footprint(frame_at, frame_at.p_ws, direction_ws);
    let hit = relief_enter(frame_at, ray);
    let bits = bitcast<vec3u>(vec3f(hit.t, b));
    return Found(vec4u(bits, triangle * 4u + hit.layer), depth_of(frame_at.p_ws + hit.t * direction_ws));
}
