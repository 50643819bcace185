// The smooth boundary model [tevs2007, 3.1]: a presmoothed field in which rays bend, and boundary events for Fresnel.

//!import techniques/eikonal/shaders/proxy
//!import techniques/eikonal/shaders/step

// A passage through a steep part of the field, from where it begins to where it is over.
struct Passage {
    inside: bool,
    p_before: vec3f,     // momentum in the calm before: followed until the passage begins
    light_before: vec3f, // transmittance in the calm before: what a mirror image at the boundary is attenuated by
    glow_before: vec3f,  // radiance picked up by then
    x_steepest: vec3f,
    steepest2: f32,
}

fn begin_passage(walk: Walk) -> Passage {
    return Passage(false, walk.p0, walk.transmittance, walk.emitted, walk.x, 0.0);
}

// Go on until the ray leaves, meets something opaque, has passed a boundary, has turned by `pause`, or is `limit` object metres away.
fn march_smooth(walk: ptr<function, Walk>, passage: ptr<function, Passage>, crossing: ptr<function, Crossing>, limit: f32) -> u32 {
    let x_begin = (*walk).x;
    let p_begin = (*walk).p0 + (*walk).q;
    var event = EXHAUSTED;
    var over = false;
    while (event == EXHAUSTED && !over && (*walk).steps < volume.max_steps) {
        // Near a face of the box a step is cut to where the ray leaves it; this needs divisions that the others are spared.
        let room = proxy_span((*walk).x, normalize((*walk).p0 + (*walk).q)).y;
        let left = select(NO_LIMIT, limit - distance((*walk).x, x_begin), MEETS_MESHES);
        var blocked = take_step(walk, max(min(room, left), 0.0)).opaque_at_probe;
        over = note_passage(walk, passage);
        var turned = has_turned(walk, p_begin);
        while (!blocked && !over && !turned && is_clear_of_faces(walk) && left >= NO_LIMIT && (*walk).steps < volume.max_steps) {
            blocked = take_step(walk, NO_LIMIT).opaque_at_probe;
            over = note_passage(walk, passage);
            turned = has_turned(walk, p_begin);
        }
        event = select(event, PAUSED, turned || left <= 1e-4 * volume.voxel);
        event = select(event, OPAQUE, blocked);
        event = select(event, LEFT, room <= 1e-4 * volume.voxel);
    }
    // What a boundary does is worked out here, once, and not in the loop.
    if (over) { settle(walk, (*passage).p_before); }
    if (over && event == EXHAUSTED && cross_over((*passage).p_before, (*walk).p0 + (*walk).q, crossing)) { return INTERFACE; }
    return select(event, PAUSED, over && event == EXHAUSTED);
}

fn is_clear_of_faces(walk: ptr<function, Walk>) -> bool {
    return proxy_clearance((*walk).x) > max(volume.step, (*walk).radius);
}

fn has_turned(walk: ptr<function, Walk>, p_begin: vec3f) -> bool {
    if (!MEETS_MESHES) { return false; }
    return distance((*walk).p0 + (*walk).q, p_begin) > volume.pause;
}

// True when a boundary has just been passed.
fn note_passage(walk: ptr<function, Walk>, passage: ptr<function, Passage>) -> bool {
    let slope2 = (*walk).slope2;
    let begins = !(*passage).inside && slope2 > volume.boundary_on * volume.boundary_on;
    let steeper = begins || ((*passage).inside && slope2 > (*passage).steepest2);
    let flat = slope2 < volume.boundary_off * volume.boundary_off;
    let over = (*passage).inside && flat;
    let calm = !(*passage).inside && flat;
    (*passage).p_before = select((*passage).p_before, (*walk).p0 + (*walk).q, calm);
    if (ABSORBS || SCATTERS) { (*passage).light_before = select((*passage).light_before, (*walk).transmittance, calm); }
    if (EMITS || SCATTERS) { (*passage).glow_before = select((*passage).glow_before, (*walk).emitted, calm); }
    (*passage).x_steepest = select((*passage).x_steepest, (*walk).x, steeper);
    (*passage).steepest2 = select((*passage).steepest2, slope2, steeper);
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
