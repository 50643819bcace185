// Straight pieces between sharp surfaces, by sphere tracing of signed distances.

//!import techniques/eikonal/shaders/proxy
//!import techniques/eikonal/shaders/interfaces
//!import techniques/eikonal/shaders/gather

// Sphere tracing along a straight line. Only the distance along it is carried from step to step; surfaces are worked out
// once, behind the loop. Matter does not act here: how much of the piece counts is the caller's to say (`gather_straight`).
fn march_straight(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    let start = (*walk).x;
    let d = normalize((*walk).p0);
    let room = proxy_span(start, d).y;
    var steps = (*walk).steps;
    var event = PAUSED;
    var t = 0.0;
    while (event == PAUSED) {
        let found = next_change(start, d, t, room, (*walk).signs, &steps);
        t = found.t;
        event = select(LEFT, EXHAUSTED, steps >= volume.max_steps);
        if (found.blocked) { event = OPAQUE; }
        if (found.changed) {
            let hit = surface_between(start + t * d, found.ahead * d, (*walk).signs, found.distances);
            t += hit.part * found.ahead;
            let flipped = (*walk).signs ^ (1u << hit.region);
            // A surface hidden inside a region that goes first: nothing happens there.
            event = select(INTERFACE, PAUSED, owner_of(flipped) == (*walk).region);
            if (event == PAUSED) { (*walk).signs = flipped; }
            *crossing = crossing_at(start + t * d, (*walk).p0, hit.normal, flipped);
        }
    }
    (*walk).steps = steps;
    (*walk).x = start + t * d;
    return event;
}

// A step in which a sign changes, from t to t + ahead; or where the search ended without one.
struct Change {
    t: f32,
    ahead: f32,
    changed: bool,
    blocked: bool,          // an opaque voxel lies at t
    distances: vec4f,       // at t + ahead
}

fn next_change(start: vec3f, d: vec3f, from_t: f32, room: f32, signs: u32, steps: ptr<function, u32>) -> Change {
    var found = Change(from_t, 0.0, false, false, vec4f(0.0));
    var stride = FIRST_STRIDE * volume.voxel;
    while (found.t < room && !found.changed && !found.blocked && *steps < volume.max_steps) {
        let last = stride >= room - found.t;
        found.ahead = min(stride, room - found.t);
        let x = start + (found.t + found.ahead) * d;
        found.distances = distances_at(x);
        found.changed = signs_of(found.distances) != signs;
        found.t = select(select(found.t + found.ahead, room, last), found.t, found.changed);
        found.blocked = BLOCKS && opaque_at(x).a > 0.5 && !found.changed;
        stride = stride_from(found.distances, x);
        *steps += 1u;
    }
    return found;
}

// What matter does along the first `length_os` object metres of a straight piece that began at `start`.
fn gather_straight(walk: ptr<function, Walk>, start: vec3f, length_os: f32) {
    let n = length((*walk).p0);
    if (ABSORBS || EMITS || SCATTERS) {
        gather_fields(walk, start, length_os);
    } else if ((*walk).region < AMBIENT) {
        gather(walk, region_absorption_at((*walk).region), volume.region_emission[(*walk).region].xyz, n, length_os);
    } else {
        (*walk).optical_path += n * length_os * volume.scale;
    }
}

// By the midpoint rule, a voxel at a time, and in one step where matter stays the same and scatters nothing. Fields end where
// the box of the volume ends, which is before the margin that a body cut off there has got.
fn gather_fields(walk: ptr<function, Walk>, start: vec3f, length_os: f32) {
    let n = length((*walk).p0);
    let d = (*walk).p0 / n;
    let span = intersect_box(start, d, volume.matter_half);
    let from_t = clamp(span.x, 0.0, length_os);
    let to_t = clamp(span.y, from_t, length_os);
    (*walk).optical_path += n * (length_os - (to_t - from_t)) * volume.scale;
    var t = from_t;
    while (t < to_t) {
        let stride = min(volume.voxel, to_t - t);
        let x = start + (t + 0.5 * stride) * d;
        let matter = matter_at(x, (*walk).region);
        let glow = in_scattered(x, d, n, matter.scattering);
        let alike = select(matter_radius_at(x), 0.0, any(matter.scattering.rgb > vec3f(0.0)));
        let reach = min(0.5 * stride + max(0.5 * stride, alike), to_t - t);
        gather(walk, matter.extinction, matter.emission + glow, n, reach);
        t += reach;
    }
}

// Radius around x in which matter stays the same, object metres; see `force_field`.
fn matter_radius_at(x: vec3f) -> f32 {
    if (!(ABSORBS || EMITS || SCATTER_VARIES)) { return 0.0; }
    let here = force_at(x);
    if (GRADED) { return here.radius; }
    return here.force.x * volume.voxel;
}
