// A point of a triangle with all that shading needs. Rays and pictures both come through here.
//!import surroundings/shaders/bindings

struct SurfacePoint {
    p_ws: vec3f,
    n_ws: vec3f,  // unit shading normal, on the viewer's side
    uv: vec2f,
    material: u32,
}

fn triangle_corner(triangle: u32, corner: u32) -> vec3f {
    switch corner {
        case 1u: { return bvh_triangles[triangle].corner_1; }
        case 2u: { return bvh_triangles[triangle].corner_2; }
        default: { return bvh_triangles[triangle].corner_0; }
    }
}

fn surface_at(triangle: u32, barycentric: vec2f, view_ws: vec3f) -> SurfacePoint {
    let corner = bvh_triangles[triangle].corner_0;
    let e1 = bvh_triangles[triangle].corner_1 - corner;
    let e2 = bvh_triangles[triangle].corner_2 - corner;
    let p_ws = corner + barycentric.x * e1 + barycentric.y * e2;
    let w = vec3f(1.0 - barycentric.x - barycentric.y, barycentric);
    let n_face = cross(e1, e2);
    let n_smooth = w.x * triangle_attributes[triangle].normal_0 + w.y * triangle_attributes[triangle].normal_1
        + w.z * triangle_attributes[triangle].normal_2;
    let uv = w.x * triangle_attributes[triangle].uv_0 + w.y * triangle_attributes[triangle].uv_1
        + w.z * triangle_attributes[triangle].uv_2;
    let n_ws = towards_viewer(n_smooth, n_face, view_ws);
    return SurfacePoint(p_ws, n_ws, uv, bvh_triangles[triangle].material);
}

// The side is decided by the face; an interpolated normal can lean away from the viewer near a silhouette
fn towards_viewer(n_smooth: vec3f, n_face: vec3f, view_ws: vec3f) -> vec3f {
    let length_2 = dot(n_smooth, n_smooth);
    let n = select(n_face, n_smooth, length_2 > 1e-8);
    let outward = select(n, -n, dot(n, n_face) < 0.0);
    let facing = select(outward, -outward, dot(n_face, view_ws) < 0.0);
    return normalize(facing);
}

// Unit normal of the plane of a triangle, on the side that a direction points to
fn face_normal(triangle: u32, side_ws: vec3f) -> vec3f {
    let corner = bvh_triangles[triangle].corner_0;
    let n = cross(bvh_triangles[triangle].corner_1 - corner, bvh_triangles[triangle].corner_2 - corner);
    return normalize(select(n, -n, dot(n, side_ws) < 0.0));
}
