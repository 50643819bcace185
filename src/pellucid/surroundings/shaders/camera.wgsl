// The camera: pixels to rays and points to depth. Camera space looks along -Z; depth is reversed.
//!import surroundings/shaders/bindings

struct CameraRay {
    origin: vec3f,     // metres, world space
    direction: vec3f,  // unit
}

fn camera_is_orthographic() -> bool {
    return (frame.flags & 1u) != 0u;
}

// Ray through a point of the picture, in pixels from its upper left corner; the centre of pixel (i, j) is
// (i + 0.5, j + 0.5). The frame's jitter is added here.
fn camera_ray(pixel: vec2f) -> CameraRay {
    let ndc = 2.0 * (pixel + frame.jitter) / frame.size - 1.0;
    let across = ndc.x * frame.half_extent.x * frame.camera_right - ndc.y * frame.half_extent.y * frame.camera_up;
    let parallel = camera_is_orthographic();
    let origin = frame.camera_position + select(vec3f(0.0), across, parallel);
    return CameraRay(origin, normalize(frame.camera_forward + select(across, vec3f(0.0), parallel)));
}

// Point that a pixel shows at a depth along the view axis, metres
fn camera_point(pixel: vec2f, depth_m: f32) -> vec3f {
    let ndc = 2.0 * (pixel + frame.jitter) / frame.size - 1.0;
    let across = ndc.x * frame.half_extent.x * frame.camera_right - ndc.y * frame.half_extent.y * frame.camera_up;
    let widened = across * select(depth_m, 1.0, camera_is_orthographic());
    return frame.camera_position + depth_m * frame.camera_forward + widened;
}

// Value of the depth buffer at a point: near / depth, or linear from 1 (near) to 0 (far) when orthographic
fn depth_of(p_ws: vec3f) -> f32 {
    let clip = frame.clip_from_world * vec4f(p_ws, 1.0);
    return clip.z / clip.w;
}

// Inverse of depth_of along the view axis, metres; what was never drawn (0) lies at 1e30
fn view_depth_m(depth: f32) -> f32 {
    if depth <= 0.0 {
        return 1e30;
    }
    return select(frame.near_m / depth, frame.far_m - depth * (frame.far_m - frame.near_m), camera_is_orthographic());
}

// Width in metres of what one pixel covers at a point
fn footprint_m(p_ws: vec3f) -> f32 {
    return frame.pixel_footprint * select(distance(p_ws, frame.camera_position), 1.0, camera_is_orthographic());
}
