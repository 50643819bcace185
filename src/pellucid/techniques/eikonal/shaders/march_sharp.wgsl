// The sharp boundary model: straight or curved pieces between surfaces, which are found by sphere tracing of signed distances.

//!import techniques/eikonal/shaders/box
//!import techniques/eikonal/shaders/surface
//!import techniques/eikonal/shaders/step

override GRADED: bool = false;     // the first region (or the whole box) has an index that varies

const AMBIENT = 4u;
const FIRST_STRIDE = 0.25;         // voxels: leaves the surface that the ray stands on
const SHORTEST_STRIDE = 0.3;       // voxels
const CAUTION = 0.9;               // of the sampled distance, whose interpolation is not exactly a distance

fn region_index(region: u32, x: vec3f) -> f32 {
    if (region >= AMBIENT) { return volume.ambient_n; }
    if (GRADED && region == 0u) { return index_at(x); }
    return volume.region_n[region];
}

fn is_graded(region: u32) -> bool {
    return GRADED && region == 0u;
}

// Where a walk begins, it must know what it is in.
fn enter_sharp(walk: ptr<function, Walk>) {
    (*walk).signs = signs_of(distances_at((*walk).x));
    (*walk).region = owner_of((*walk).signs);
    let n = region_index((*walk).region, (*walk).x);
    redirect(walk, normalize((*walk).p0), n);
}

// Go on until the ray leaves the box, stands at an interface, meets something opaque, or has turned by `pause`.
fn march_sharp(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    if (is_graded((*walk).region)) { return march_graded(walk, crossing); }
    return march_straight(walk, crossing);
}

// Sphere tracing along a straight line. Only the distance along it is carried from step to step; surfaces are worked out and
// matter acts once, behind the loop.
fn march_straight(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    let start = (*walk).x;
    let d = normalize((*walk).p0);
    let room = intersect_box(start, d, volume.proxy_half).y;
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
    gather_region(walk, t);
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

fn stride_from(distances: vec4f, x: vec3f) -> f32 {
    let nearest = min(min(abs(distances.x), abs(distances.y)), min(abs(distances.z), abs(distances.w)));
    let stride = max(CAUTION * nearest, SHORTEST_STRIDE) * volume.voxel;
    if (!BLOCKS) { return stride; }
    return min(stride, max(force_at(x).radius, 0.5 * volume.voxel));
}

fn gather_region(walk: ptr<function, Walk>, length_os: f32) {
    let n = length((*walk).p0);
    if ((*walk).region >= AMBIENT) {
        (*walk).optical_path += n * length_os * volume.scale;
    } else {
        gather(walk, volume.region_absorption[(*walk).region].xyz, volume.region_emission[(*walk).region].xyz, n, length_os);
    }
}

// The same along a curve: steps of the integrator, no longer than the distance to the surface.
fn march_graded(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    let p_begin = (*walk).p0 + (*walk).q;
    var stride = FIRST_STRIDE * volume.voxel;
    while ((*walk).steps < volume.max_steps) {
        let room = intersect_box((*walk).x, normalize((*walk).p0 + (*walk).q), volume.proxy_half).y;
        if (room <= 1e-4 * volume.voxel) { return LEFT; }
        var before = *walk;
        let step = take_step(walk, min(stride, room));
        if (step.opaque_at_probe) { return OPAQUE; }
        let distances = distances_at((*walk).x);
        let signs = signs_of(distances);
        stride = stride_from(distances, (*walk).x);
        if (signs != before.signs) {
            let hit = surface_between(before.x, (*walk).x - before.x, before.signs, distances);
            *walk = before;
            _ = take_step(walk, hit.part * step.length);
            let flipped = before.signs ^ (1u << hit.region);
            if (owner_of(flipped) != before.region) {
                *crossing = crossing_at((*walk).x, (*walk).p0 + (*walk).q, hit.normal, flipped);
                return INTERFACE;
            }
            (*walk).signs = flipped;
            stride = FIRST_STRIDE * volume.voxel;
        }
        if (MEETS_MESHES && distance((*walk).p0 + (*walk).q, p_begin) > volume.pause) { return PAUSED; }
    }
    return EXHAUSTED;
}

// p: optical momentum of arrival; the normal may point to either side.
fn crossing_at(x: vec3f, p: vec3f, facing: vec3f, signs: u32) -> Crossing {
    let n_i = length(p);
    let far = owner_of(signs);
    let normal = select(facing, -facing, dot(facing, p) > 0.0);
    return Crossing(n_i, region_index(far, x), normal, p / n_i, far, signs);
}

struct Met {
    region: u32,
    part: f32,        // of the chord
    normal: vec3f,    // unit, out of the region
}

// The first surface on a chord between whose ends signs change: found by linear interpolation, then put on the exact distances by
// one step of Newton; where the ray grazes, the linear guess stands.
fn surface_between(from_x: vec3f, chord: vec3f, signs: u32, distances: vec4f) -> Met {
    let a = distances_at(from_x);
    let changed = signs ^ signs_of(distances);
    var region = 0u;
    var part = 2.0;
    for (var k = 0u; k < 4u; k++) {
        if ((changed & (1u << k)) == 0u) { continue; }
        // A start on the surface may round to the wrong side of it.
        let from_value = select(max(a[k], 1e-4), min(a[k], -1e-4), (signs & (1u << k)) != 0u);
        let guess = clamp(from_value / (from_value - distances[k]), 0.0, 1.0);
        if (guess < part) { region = k; part = guess; }
    }
    let boundary = boundary_at(from_x + part * chord, region);
    let slope = dot(per_metre(boundary), chord);
    let correction = select(0.0, boundary.distance / slope, abs(slope) > 0.05 * length(chord) / volume.voxel);
    return Met(region, clamp(part - correction, 0.0, 1.0), normalize(per_metre(boundary)));
}
