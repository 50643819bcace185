// What mirrored rays see, a fixed way along them [mihalik2008, eq. 6].
//!import techniques/water/shaders/seen_rays

fn seen_point(p_ws: vec3f, direction_ws: vec3f) -> Seen {
    return seen_rays(p_ws, direction_ws, false);
}
