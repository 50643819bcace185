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
    let p_begin = (*walk).p0 + (*walk).q;
    var stride = FIRST_STRIDE * volume.voxel;
    while ((*walk).steps < volume.max_steps) {
        let room = intersect_box((*walk).x, normalize((*walk).p0 + (*walk).q), volume.proxy_half).y;
        if (room <= 1e-4 * volume.voxel) { return LEFT; }
        let before = *walk;
        let step = advance(walk, min(stride, room));
        if (step.opaque_at_probe) { return OPAQUE; }
        let distances = distances_at((*walk).x);
        let signs = signs_of(distances);
        let nearest = min(min(abs(distances.x), abs(distances.y)), min(abs(distances.z), abs(distances.w)));
        stride = max(CAUTION * nearest, SHORTEST_STRIDE) * volume.voxel;
        if (has(HAS_OPAQUE)) { stride = min(stride, max(force_at((*walk).x).radius, 0.5 * volume.voxel)); }
        if (signs != before.signs) {
            if (reach_surface(walk, before, step.length, signs, crossing)) { return INTERFACE; }
            stride = FIRST_STRIDE * volume.voxel;
        }
        if (distance((*walk).p0 + (*walk).q, p_begin) > volume.pause) { return PAUSED; }
    }
    return EXHAUSTED;
}

fn advance(walk: ptr<function, Walk>, reach: f32) -> Step {
    if (is_graded((*walk).region)) { return take_step(walk, reach); }
    let p = (*walk).p0;
    let n = length(p);
    (*walk).x += p * (reach / n);
    (*walk).steps += 1u;
    if ((*walk).region >= AMBIENT) {
        gather(walk, vec3f(0.0), vec3f(0.0), n, reach);
    } else {
        gather(walk, volume.region_absorption[(*walk).region].xyz, volume.region_emission[(*walk).region].xyz, n, reach);
    }
    return Step(reach, has(HAS_OPAQUE) && opaque_at((*walk).x).a > 0.5);
}

// The step from `before` changed sides: put the walk on the surface that it met first. False when the far side belongs to the
// same region (a surface hidden inside a region that goes first): nothing happens there, and the walk goes on behind it.
fn reach_surface(walk: ptr<function, Walk>, before: Walk, reach: f32, signs: u32, crossing: ptr<function, Crossing>) -> bool {
    var start = before;
    let met = first_met(&start, walk, signs);
    let chord = (*walk).x - before.x;
    var part = met.part;
    var surface = boundary_at(before.x + part * chord, met.region);
    for (var i = 0; i < 2; i++) {
        // Newton along the chord; where the ray grazes, the linear guess stands.
        let slope = dot(per_metre(surface), chord);
        part = clamp(part - select(0.0, surface.distance / slope, abs(slope) > 0.05 * length(chord) / volume.voxel), 0.0, 1.0);
        surface = boundary_at(before.x + part * chord, met.region);
    }
    *walk = before;
    _ = advance(walk, part * reach);
    let flipped = before.signs ^ (1u << met.region);
    let far = owner_of(flipped);
    if (far == before.region) {
        (*walk).signs = flipped;
        return false;
    }
    let p = (*walk).p0 + (*walk).q;
    let n_i = length(p);
    let facing = normalize(per_metre(surface));
    let normal = select(facing, -facing, dot(facing, p) > 0.0);
    *crossing = Crossing(n_i, region_index(far, (*walk).x), normal, p / n_i, far, flipped);
    return true;
}

struct Met { region: u32, part: f32 }

// Of the regions whose sign changed, the one whose surface comes first, with its share of the step (by linear interpolation).
fn first_met(before: ptr<function, Walk>, after: ptr<function, Walk>, signs: u32) -> Met {
    let a = distances_at((*before).x);
    let b = distances_at((*after).x);
    let changed = signs ^ (*before).signs;
    var met = Met(0u, 2.0);
    for (var region = 0u; region < 4u; region++) {
        if ((changed & (1u << region)) == 0u) { continue; }
        let inside_before = ((*before).signs & (1u << region)) != 0u;
        // A start on the surface may round to the wrong side of it.
        let from_value = select(max(a[region], 1e-4), min(a[region], -1e-4), inside_before);
        let part = clamp(from_value / (from_value - b[region]), 0.0, 1.0);
        if (part < met.part) { met = Met(region, part); }
    }
    return met;
}
