// Which triangle each pixel shows, and how deep, of what lies outside of a box whose faces something else covers.
//!import surroundings/shaders/surface
//!import surroundings/shaders/visible_corner

struct HiddenBox {
    low: vec3f,  // metres
    high: vec3f,
}

@group(0) @binding(0) var<uniform> hidden_box: HiddenBox;

struct VisibilityVarying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
    @location(1) p_ws: vec3f,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> VisibilityVarying {
    let triangle = vertex / 3u;
    let p_ws = triangle_corner(triangle, vertex % 3u);
    return VisibilityVarying(visible_corner(triangle, p_ws), triangle, p_ws);
}

@fragment
fn fs_main(in: VisibilityVarying) -> @location(0) u32 {
    if all(in.p_ws > hidden_box.low) && all(in.p_ws < hidden_box.high) {
        discard;
    }
    return in.triangle + 1u;
}
