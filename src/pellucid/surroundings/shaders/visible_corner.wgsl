// Where the corners of the triangles lie in a view. Vertices come from the buffers that rays use.
//!import surroundings/shaders/camera

override CULL_BACK_FACES: bool = false;  // of all meshes, not only of single-sided ones
override STAND_INS: bool = false;        // whether what only rays meet is shown

const MATERIAL_UNSEEN = 2u;  // layouts.MATERIAL_UNSEEN

// Clip space, or a point that is clipped for every corner of a triangle that this view does not show
fn visible_corner(triangle: u32, p_ws: vec3f) -> vec4f {
    let unseen = !STAND_INS && (materials[bvh_triangles[triangle].material].flags & MATERIAL_UNSEEN) != 0u;
    let one_sided = CULL_BACK_FACES || bvh_triangles[triangle].single_sided != 0u;
    if unseen || (one_sided && !faces_camera(triangle)) {
        return vec4f(2.0, 2.0, 2.0, 1.0);
    }
    return frame.clip_from_world * vec4f(p_ws, 1.0);
}

// By the place of the camera, so that mirrored views are right too
fn faces_camera(triangle: u32) -> bool {
    let corner = bvh_triangles[triangle].corner_0;
    let n_face = cross(bvh_triangles[triangle].corner_1 - corner, bvh_triangles[triangle].corner_2 - corner);
    return dot(n_face, select(frame.camera_position - corner, -frame.camera_forward, camera_is_orthographic())) > 0.0;
}
