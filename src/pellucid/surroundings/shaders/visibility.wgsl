// Which triangle each pixel shows, and how deep.
//!import surroundings/shaders/surface
//!import surroundings/shaders/visible_corner

struct VisibilityVarying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> VisibilityVarying {
    let triangle = vertex / 3u;
    return VisibilityVarying(visible_corner(triangle, triangle_corner(triangle, vertex % 3u)), triangle);
}

// 0 is kept for pixels that show nothing
@fragment
fn fs_main(in: VisibilityVarying) -> @location(0) u32 {
    return in.triangle + 1u;
}
