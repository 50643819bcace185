// Where a ray ends in a picture, by the iteration of [mihalik2008, 7.1].
//!import techniques/water/shaders/picture

const ITERATION_SLACK = 1.001;  // of lengths that are equal but for rounding

// W_0 .. W_{n-1} lie on the ray, A_{i+1} on the bottom where the camera's ray through W_i ends; kept is the W_i that is
// nearest to its A_{i+1}. One look-up a step.
fn seen_iteration(layer: u32, p_ws: vec3f, direction_ws: vec3f) -> PicturePlace {
    var w = p_ws;
    var a = p_ws;
    var best = vec3f(p_ws);
    var best_a = p_ws;
    var least = 1e30;
    let steps = min(water.steps, 64u + textureNumLayers(picture_depths));  // not the uniform alone
    for (var i = 0u; i < steps; i++) {
        let clip = picture_clip(layer, w);
        let deep = picture_depth_metres(layer, clip);
        let found = picture_metres(layer, picture_depth_between(layer, picture_uv(clip)));
        let a_next = picture_point(layer, w, deep, min(found, ITERATION_FAR_M));
        let gap = distance(a_next, w);
        if gap < least {
            least = gap;
            best = w;
            best_a = a_next;
        }
        let crossed = iteration_crossing(p_ws, direction_ws, a, a_next);
        let between = distance(a, crossed) + distance(crossed, a_next) <= ITERATION_SLACK * distance(a, a_next);
        // In front of the bottom on, behind it back (figures 10 to 12); the first step always goes on.
        let onward = w + select(gap, -gap, deep > found) * direction_ws;
        w = select(onward, crossed, between && i > 0u);
        a = a_next;
    }
    let clip = picture_clip(layer, best);
    let found = select(PICTURE_UNKNOWN, PICTURE_SOMETHING, picture_shows(clip));
    return PicturePlace(picture_uv(clip), distance(best_a, p_ws), found);
}

const ITERATION_FAR_M = 1e4;  // where the picture shows nothing

// Depth of a point in metres; in front of the camera
fn picture_depth_metres(layer: u32, clip: vec4f) -> f32 {
    return picture_metres(layer, clip.z / max(clip.w, 1e-6));
}

// Point of the ray from `u` along `r` on the line through a_0 and a_1 [mihalik2008, eq. 3]
fn iteration_crossing(u: vec3f, r: vec3f, a_0: vec3f, a_1: vec3f) -> vec3f {
    let q = a_1 - a_0;
    let across = cross(r, q);
    let square = dot(across, across);
    return u + dot(cross(a_0 - u, q), across) / max(square, 1e-20) * r;
}
