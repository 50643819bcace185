// Which triangle each pixel shows, and how deep. Vertices come from the buffers that rays use.
//!import surroundings/shaders/camera
//!import surroundings/shaders/surface

const MATERIAL_UNSEEN = 2u;  // layouts.MATERIAL_UNSEEN

struct VisibilityVarying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> VisibilityVarying {
    let triangle = vertex / 3u;
    let unseen = (materials[bvh_triangles[triangle].material].flags & MATERIAL_UNSEEN) != 0u;
    if unseen || (bvh_triangles[triangle].single_sided != 0u && !faces_camera(triangle)) {
        return VisibilityVarying(vec4f(2.0, 2.0, 2.0, 1.0), triangle);  // clipped
    }
    let p_ws = triangle_corner(triangle, vertex % 3u);
    return VisibilityVarying(frame.clip_from_world * vec4f(p_ws, 1.0), triangle);
}

// 0 is kept for pixels that show nothing
@fragment
fn fs_main(in: VisibilityVarying) -> @location(0) u32 {
    return in.triangle + 1u;
}

fn faces_camera(triangle: u32) -> bool {
    let corner = bvh_triangles[triangle].corner_0;
    let n_face = cross(bvh_triangles[triangle].corner_1 - corner, bvh_triangles[triangle].corner_2 - corner);
    return dot(n_face, select(frame.camera_position - corner, -frame.camera_forward, camera_is_orthographic())) > 0.0;
}
