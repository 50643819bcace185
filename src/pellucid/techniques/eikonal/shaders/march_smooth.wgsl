// The smooth boundary model [tevs2007, 3.1]: a presmoothed field in which rays bend, and boundary events for Fresnel.

//!import techniques/eikonal/shaders/box
//!import techniques/eikonal/shaders/step

// A passage through a steep part of the field, from where it begins to where it is over.
struct Passage {
    inside: bool,
    p_before: vec3f,     // momentum in the calm before
    x_steepest: vec3f,
    steepest: f32,
}

// Go on until the ray leaves, meets something opaque, has passed a boundary, or has turned by `pause`.
// The indices and the normal of a passed boundary follow from the momenta on its two sides: a plane boundary
// changes p along its normal only, and |p| is the index.
fn march_smooth(walk: ptr<function, Walk>, passage: ptr<function, Passage>, crossing: ptr<function, Crossing>) -> u32 {
    let p_begin = (*walk).p0 + (*walk).q;
    while ((*walk).steps < volume.max_steps) {
        let p = (*walk).p0 + (*walk).q;
        // The distance to the nearest face is enough to know that a step stays inside.
        let inside = volume.proxy_half - abs((*walk).x);
        var room = min(inside.x, min(inside.y, inside.z));
        if (room < max(volume.step, (*walk).radius)) {
            room = intersect_box((*walk).x, normalize(p), volume.proxy_half).y;
            if (room <= 1e-4 * volume.voxel) { return LEFT; }
        }
        let step = take_step(walk, room);
        if (step.opaque_at_probe) { return OPAQUE; }
        if (note_passage(walk, passage, p, crossing)) { return INTERFACE; }
        if (distance((*walk).p0 + (*walk).q, p_begin) > volume.pause) { return PAUSED; }
    }
    return EXHAUSTED;
}

// True when a boundary has just been passed and light was split there. A ray that turned back (total reflection) or that only
// grazed has the same index on both sides and loses nothing.
fn note_passage(walk: ptr<function, Walk>, passage: ptr<function, Passage>, p: vec3f, crossing: ptr<function, Crossing>) -> bool {
    let p_now = (*walk).p0 + (*walk).q;
    let gradient = (*walk).bend * length(p_now);
    if ((*passage).inside) {
        if (gradient > (*passage).steepest) {
            (*passage).steepest = gradient;
            (*passage).x_steepest = (*walk).x;
        }
        if (gradient < volume.boundary_off) {
            (*passage).inside = false;
            settle(walk, (*passage).p_before);
            return cross_over((*passage).p_before, (*walk).p0 + (*walk).q, crossing);
        }
    } else if (gradient > volume.boundary_on) {
        *passage = Passage(true, p, (*walk).x, gradient);
    }
    return false;
}

// |p| = n holds along a ray, but sampled forces are not exactly the gradient of anything: make it hold again behind a boundary,
// by the component along its normal, since the tangential one is what Snell's law keeps.
fn settle(walk: ptr<function, Walk>, p_before: vec3f) {
    let p = (*walk).p0 + (*walk).q;
    let change = p - p_before;
    let normal = normalize(select(change, p, dot(change, change) < 1e-12));
    let along = dot(p, normal);
    let n = index_at((*walk).x);
    let wanted = along * along + n * n - dot(p, p);
    if (wanted > 0.0) { (*walk).q += (sign(along) * sqrt(wanted) - along) * normal; }
}

fn cross_over(p_before: vec3f, p_after: vec3f, crossing: ptr<function, Crossing>) -> bool {
    let n_i = length(p_before);
    let n_t = length(p_after);
    let change = p_after - p_before;
    let normal = normalize(select(change, p_before, dot(change, change) < 1e-12));
    let towards = dot(p_before, normal);
    if (towards * dot(p_after, normal) <= 0.0 || abs(n_t - n_i) < 1e-5) { return false; }
    *crossing = Crossing(n_i, n_t, -sign(towards) * normal, p_before / n_i, 0u, 0u);
    return true;
}
