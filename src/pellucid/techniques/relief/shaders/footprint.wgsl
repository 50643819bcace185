// How much of the relief a pixel covers.
//!import surroundings/shaders/camera
//!import techniques/relief/shaders/frame

// Tiles that a pixel covers at a point
fn relief_footprint(frame_at: ReliefFrame, p_ws: vec3f, direction_ws: vec3f) -> f32 {
    let cosine = clamp(-dot(frame_at.N, direction_ws), 0.05, 1.0);
    return footprint_m(p_ws) * inverseSqrt(cosine) / relief_side_m(frame_at);
}

// Shorter side of a tile in metres
fn relief_side_m(frame_at: ReliefFrame) -> f32 {
    return max(min(length(frame_at.T), length(frame_at.B)), 1e-9);
}
