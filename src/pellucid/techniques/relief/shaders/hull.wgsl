// The outer hull: the mesh moved outwards by the height of the layers, with walls at open borders.
//!import surroundings/shaders/camera
//!import techniques/relief/shaders/frame

struct HullVarying {
    @builtin(position) clip: vec4f,
    @location(0) barycentric: vec2f,
    @location(1) @interpolate(flat) triangle: u32,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> HullVarying {
    let corner = vertex % 3u;
    let b = vec2f(select(0.0, 1.0, corner == 1u), select(0.0, 1.0, corner == 2u));
    return HullVarying(frame.clip_from_world * vec4f(relief_vertex_ws(relief_vertex(vertex)), 1.0), b, vertex / 3u);
}
