// The smooth boundary model [tevs2007, 3.1]: a presmoothed field in which rays bend, and boundary events for Fresnel.

//!import techniques/eikonal/shaders/box
//!import techniques/eikonal/shaders/step

// A passage through a steep part of the field, from where it begins to where it is over.
struct Passage {
    inside: bool,
    p_before: vec3f,     // momentum in the calm before: followed until the passage begins
    x_steepest: vec3f,
    steepest: f32,
}

fn begin_passage(walk: Walk) -> Passage {
    return Passage(false, walk.p0, walk.x, 0.0);
}

// Go on until the ray leaves, meets something opaque, has passed a boundary, or has turned by `pause`.
fn march_smooth(walk: ptr<function, Walk>, passage: ptr<function, Passage>, crossing: ptr<function, Crossing>) -> u32 {
    let p_begin = (*walk).p0 + (*walk).q;
    var event = EXHAUSTED;
    var over = false;
    while (event == EXHAUSTED && !over && (*walk).steps < volume.max_steps) {
        let p = (*walk).p0 + (*walk).q;
        let room = room_ahead(walk, p);
        let step = take_step(walk, room);
        over = note_passage(walk, passage);
        event = select(event, PAUSED, distance((*walk).p0 + (*walk).q, p_begin) > volume.pause);
        event = select(event, OPAQUE, step.opaque_at_probe);
        event = select(event, LEFT, room <= 1e-4 * volume.voxel);
    }
    // What a boundary does is worked out here, once, and not in the loop.
    if (over) { settle(walk, (*passage).p_before); }
    if (over && event == EXHAUSTED && cross_over((*passage).p_before, (*walk).p0 + (*walk).q, crossing)) { return INTERFACE; }
    return select(event, PAUSED, over && event == EXHAUSTED);
}

// Distance to where the ray leaves the box: the distance to the nearest face is enough to know that a step stays inside.
fn room_ahead(walk: ptr<function, Walk>, p: vec3f) -> f32 {
    let inside = volume.proxy_half - abs((*walk).x);
    let nearest = min(inside.x, min(inside.y, inside.z));
    let exact = intersect_box((*walk).x, normalize(p), volume.proxy_half).y;
    return select(exact, nearest, nearest > max(volume.step, (*walk).radius));
}

// True when a boundary has just been passed.
fn note_passage(walk: ptr<function, Walk>, passage: ptr<function, Passage>) -> bool {
    let gradient = (*walk).bend * length((*walk).p0 + (*walk).q);
    let begins = !(*passage).inside && gradient > volume.boundary_on;
    let steeper = begins || ((*passage).inside && gradient > (*passage).steepest);
    let over = (*passage).inside && gradient < volume.boundary_off;
    let calm = !(*passage).inside && gradient < volume.boundary_off;
    (*passage).p_before = select((*passage).p_before, (*walk).p0 + (*walk).q, calm);
    (*passage).x_steepest = select((*passage).x_steepest, (*walk).x, steeper);
    (*passage).steepest = select((*passage).steepest, gradient, steeper);
    (*passage).inside = ((*passage).inside || begins) && !over;
    return over;
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

// The indices and the normal of a boundary follow from the momenta on its two sides: a plane boundary changes p along its normal
// only, and |p| is the index. False where no light is split off: a ray that turned back (total reflection) or that only grazed.
fn cross_over(p_before: vec3f, p_after: vec3f, crossing: ptr<function, Crossing>) -> bool {
    let n_i = length(p_before);
    let n_t = length(p_after);
    let change = p_after - p_before;
    let normal = normalize(select(change, p_before, dot(change, change) < 1e-12));
    let towards = dot(p_before, normal);
    *crossing = Crossing(n_i, n_t, -sign(towards) * normal, p_before / n_i, 0u, 0u);
    return towards * dot(p_after, normal) > 0.0 && abs(n_t - n_i) >= 1e-5;
}
