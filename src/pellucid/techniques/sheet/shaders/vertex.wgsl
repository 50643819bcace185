// Vertices of the sheet; where everything is worked out per vertex, what they see.
//!import techniques/sheet/shaders/look
//!import techniques/sheet/shaders/sphere_map

override SHEET_PER_VERTEX: bool = false;
override SHEET_BALL: bool = true;  // rule of the sphere map

struct SheetVarying {
    @builtin(position) clip: vec4f,
    @location(0) p_os: vec3f,
    @location(1) n_os: vec3f,
    @location(2) seen_xz: vec2f,
    @location(3) seen_uv: vec2f,
    @location(4) share_way: vec2f,
    @location(5) outward: vec3f,
    @location(6) sphere_uv: vec2f,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> SheetVarying {
    let p = sheet_vertices[vertex].position;
    let n = sheet_vertices[vertex].normal;
    let clip = frame.clip_from_world * (sheet.world_from_object * vec4f(p, 1.0));
    var out = SheetVarying(clip, p, n, vec2f(0.0), vec2f(0.0), vec2f(0.0), vec3f(0.0), vec2f(0.0));
    if SHEET_PER_VERTEX {
        let direction = sheet_view(p);
        let look = sheet_look(p, n, direction, dot(direction, n) > 0.0, SHEET_EXACT);
        out.seen_xz = look.hit.xz;
        out.seen_uv = sheet_uv(look.hit.xz, sheet.limits_low, sheet.limits_size);
        out.share_way = vec2f(look.share, look.way);
        out.outward = look.outward;
        out.sphere_uv = sheet_sphere_uv(look.outward);
    }
    return out;
}

fn sheet_to_world(direction: vec3f) -> vec3f {
    return normalize((sheet.world_from_object * vec4f(direction, 0.0)).xyz);
}

fn sheet_sphere_uv(outward: vec3f) -> vec2f {
    let direction_ws = sheet_to_world(outward);
    if SHEET_BALL {
        return sphere_map_ball(direction_ws);
    }
    return sphere_map_linear(direction_ws);
}
