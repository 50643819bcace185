// Which triangle each pixel shows, and how deep, of what lies on one side of a plane.
//!import surroundings/shaders/surface
//!import surroundings/shaders/visible_corner

@group(0) @binding(0) var<uniform> clip_plane: vec4f;  // kept is where dot(clip_plane, (p, 1)) >= 0

struct VisibilityVarying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
    @location(1) kept_m: f32,  // distance from the plane
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> VisibilityVarying {
    let triangle = vertex / 3u;
    let p_ws = triangle_corner(triangle, vertex % 3u);
    return VisibilityVarying(visible_corner(triangle, p_ws), triangle, dot(clip_plane, vec4f(p_ws, 1.0)));
}

@fragment
fn fs_main(in: VisibilityVarying) -> @location(0) u32 {
    if in.kept_m < 0.0 {
        discard;
    }
    return in.triangle + 1u;
}
