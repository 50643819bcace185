// What refracted rays see, by the iteration of [mihalik2008, 7.1].
//!import techniques/water/shaders/seen_rays

fn seen_iteration(p_ws: vec3f, direction_ws: vec3f) -> Seen {
    return seen_rays(p_ws, direction_ws, true);
}
