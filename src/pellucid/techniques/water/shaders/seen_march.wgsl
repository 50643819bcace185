// What rays see, from a picture with depth and a march through it.
//!import techniques/water/shaders/seen_rays

fn seen_march(p_ws: vec3f, direction_ws: vec3f, below: bool) -> Seen {
    return seen_rays(p_ws, direction_ws, below);
}
