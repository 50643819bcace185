// Where a ray ends in a picture: a fixed way along it [mihalik2008, eqs. 6, 13, 15].
//!import techniques/water/shaders/picture

fn seen_point(layer: u32, p_ws: vec3f, direction_ws: vec3f, way_m: f32) -> PicturePlace {
    let clip = picture_clip(layer, p_ws + way_m * direction_ws);
    let uv = picture_uv(clip);
    // From what the picture's camera sees there, less its way to the surface [mihalik2008, 7.5]
    let found = picture_metres(layer, picture_depth(layer, uv));
    let p_metres = picture_metres(layer, clip.z / max(clip.w, 1e-6));
    let shown = picture_point(layer, p_ws + way_m * direction_ws, p_metres, found);
    let camera = water_views.position[layer].xyz;
    let beyond = max(distance(shown, camera) - distance(p_ws, camera), 0.0);
    return PicturePlace(uv, beyond, select(PICTURE_UNKNOWN, PICTURE_SOMETHING, picture_shows(clip)));
}
