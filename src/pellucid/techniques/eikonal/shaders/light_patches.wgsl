// Patches of a wavefront: four corner rays and the flux between them; how they divide, and where they go next.

//!import techniques/eikonal/shaders/light_corners
//!import techniques/eikonal/shaders/splitting

const SMALLEST_TORN = 0.3;         // voxels: narrower patches whose corners part ways become single rays
const TURNED_NORMALS = 0.9;        // cosine: normals that differ by more tear a patch
const OUT_CAUSTIC = 0u;
const OUT_BLOCKED = 1u;
const OUT_UNTOUCHED = 2u;

const UNTOUCHED = 0u;
const TOUCHED = 1u;                // the light is no longer where it would be without the volume

// Light of one patch relative to what it had when it was undisturbed, however often it was divided since.
fn relative(flux: vec3f, of_patch: LightPatch) -> f32 {
    return largest_of(abs(weighed(flux))) * exp2(f32(of_patch.level)) / max(of_patch.begun, 1e-30);
}

fn largest_of(v: vec3f) -> f32 {
    return max(v.x, max(v.y, v.z));
}

// Worth dividing: a patch that carries little is left wide, since its streaks cannot be seen. A front that only spreads, as from a
// near lamp, is all the light there is, and is always divided.
fn worth_dividing(flux: vec3f, of_patch: LightPatch) -> bool {
    return of_patch.touched == UNTOUCHED || largest_of(abs(weighed(flux))) > light.divide_above * of_patch.begun;
}

// The same before a surface, where a patch may be stretched without bounds.
fn worth_stretching(flux: vec3f) -> bool {
    return largest_of(abs(weighed(flux))) > light.divide_above * light.patch_flux;
}

fn emit(place: u32, x: array<vec3f, 4>, p: array<vec3f, 4>, flux: vec3f, from_patch: LightPatch) {
    next_patches[place] = LightPatch(
        x[0], from_patch.region, x[1], from_patch.signs, x[2], from_patch.level, x[3], from_patch.bounces,
        p[0], from_patch.touched, p[1], from_patch.is_ray, p[2], from_patch.breadth, p[3], from_patch.begun, flux, from_patch.stuck);
}

// Two children of what lies between these corners, cut across the longer of its edges. False when there is no room for them.
fn divide(x: array<vec3f, 4>, p: array<vec3f, 4>, edges: vec2f, flux: vec3f, spreads: bool, from_patch: LightPatch) -> bool {
    let place = reserve(generation.index + 2u, 2u, light.capacity);
    if (place == NO_ROOM) { return false; }
    var child = from_patch;
    // Undisturbed light that only spreads begins anew; what a surface is about to tear or stretch does not.
    let whole = spreads && from_patch.touched == UNTOUCHED;
    child.level += select(1u, 0u, whole);
    child.begun *= select(1.0, 0.5, whole);
    let half = select(vec2f(1.0, 0.5), vec2f(0.5, 1.0), edges.x >= edges.y);
    let n = vec4f(length(p[0]), length(p[1]), length(p[2]), length(p[3]));
    for (var k = 0u; k < 2u; k++) {
        let corner = f32(k) * (1.0 - half);
        var xs = array<vec3f, 4>();
        var ps = array<vec3f, 4>();
        for (var c = 0u; c < 4u; c++) {
            let at = corner + half * vec2f(f32(c & 1u), f32(c >> 1u));
            xs[c] = between_corners(x, at);
            // Directions are blended; the length of the momentum is the index, which is blended by itself.
            let index = mix(mix(n[0], n[1], at.x), mix(n[2], n[3], at.x), at.y);
            ps[c] = index * normalize(between_corners(p, at));
        }
        emit(place + k, xs, ps, 0.5 * flux, child);
    }
    return true;
}

// A ray stands for a tube as broad as the one that it came from.
fn breadth_of(x: array<vec3f, 4>, p: array<vec3f, 4>, from_patch: LightPatch) -> f32 {
    let edges = cut_edges(x, normalize(middle(p)));
    return select(min(max(edges.x, edges.y), light.voxel), from_patch.breadth, from_patch.is_ray != 0u);
}

// One ray for the whole tube: it is narrow, or weak, and its corners do not stay together.
fn collapse(x: array<vec3f, 4>, p: array<vec3f, 4>, flux: vec3f, from_patch: LightPatch) -> bool {
    let place = reserve(generation.index + 2u, 1u, light.capacity);
    if (place == NO_ROOM) { return false; }
    var ray = from_patch;
    ray.is_ray = 1u;
    ray.breadth = breadth_of(x, p, from_patch);
    let at = middle(x);
    let way = 0.25 * (length(p[0]) + length(p[1]) + length(p[2]) + length(p[3])) * normalize(middle(p));
    emit(place, array<vec3f, 4>(at, at, at, at), array<vec3f, 4>(way, way, way, way), flux, ray);
    return true;
}

// Four single rays, a quarter of the flux each: corners that do not stay together go on alone.
fn scatter_corners(x: array<vec3f, 4>, p: array<vec3f, 4>, flux: vec3f, from_patch: LightPatch) -> bool {
    let rays = select(4u, 1u, from_patch.is_ray != 0u);
    let place = reserve(generation.index + 2u, rays, light.capacity);
    if (place == NO_ROOM) { return false; }
    var ray = from_patch;
    ray.level += select(2u, 0u, from_patch.is_ray != 0u);
    ray.is_ray = 1u;
    ray.breadth = breadth_of(x, p, from_patch);
    for (var k = 0u; k < rays; k++) {
        emit(place + k, array<vec3f, 4>(x[k], x[k], x[k], x[k]), array<vec3f, 4>(p[k], p[k], p[k], p[k]), flux / f32(rays), ray);
    }
    return true;
}

// One patch goes on, or its light is given up: too weak, too many bounces, no room. Of weak patches a few go on with the flux of
// all [arvo1990]; what this adds and takes is accounted for, so that sums stay exact.
fn go_on(x: array<vec3f, 4>, p: array<vec3f, 4>, flux: vec3f, from_patch: LightPatch) {
    let strength = relative(flux, from_patch);
    if (strength <= 0.0) { return; }
    var place = NO_ROOM;
    let chance = clamp(strength / light.follow_above, 0.0, 1.0);
    let drawn = random_pair(bitcast<vec2u>(x[0].xy) ^ vec2u(bitcast<u32>(x[0].z), generation.index)).x;
    let strong = strength > light.min_flux && drawn <= chance && from_patch.bounces <= light.bounces;
    if (strong) { place = reserve(generation.index + 2u, 1u, light.capacity); }
    if (place == NO_ROOM) {
        add_flux(TOTAL_ENDED, flux);
    } else {
        add_flux(TOTAL_LENT, flux / chance - flux);
        emit(place, x, p, flux / chance, from_patch);
    }
}

// Hand a bundle over to the surroundings, in world space. Other bodies follow the light itself, not what it is worth.
fn put_out(kind: u32, x: array<vec3f, 4>, p: array<vec3f, 4>, flux: vec3f, from_patch: LightPatch) {
    if (!OUTGOING) { return; }
    let place = reserve(0u, 1u, light.out_capacity);
    if (place == NO_ROOM) {
        add_flux(TOTAL_UNSENT, flux);
        return;
    }
    var out = OutPatch();
    out.kind = kind;
    out.corner_0 = point_to_world(x[0]);
    out.corner_1 = point_to_world(x[1]);
    out.corner_2 = point_to_world(x[2]);
    out.corner_3 = point_to_world(x[3]);
    out.way_0 = way_to_world(p[0]);
    out.way_1 = way_to_world(p[1]);
    out.way_2 = way_to_world(p[2]);
    out.way_3 = way_to_world(p[3]);
    out.flux = select(weighed(flux), flux, HANDS_ON);
    out.level = from_patch.level;
    out.begun = from_patch.begun;
    out.is_ray = from_patch.is_ray;
    out.breadth = from_patch.breadth * volume.scale;
    outgoing[place] = out;
}

fn point_to_world(x: vec3f) -> vec3f {
    return (volume.world_from_object * vec4f(x, 1.0)).xyz;
}

fn way_to_world(p: vec3f) -> vec3f {
    return normalize((volume.world_from_object * vec4f(p, 0.0)).xyz);
}

// What all corners met alike: they stay together. Surfaces must agree in what lies behind them and, about, in their normal.
fn is_torn(touches_surface: bool) -> bool {
    let same_event = all(vec3u(end_event[1], end_event[2], end_event[3]) == vec3u(end_event[0]));
    if (!same_event || !touches_surface) { return !same_event; }
    var torn = false;
    for (var k = 1u; k < 4u; k++) {
        let facing = dot(end_crossing[k].normal, end_crossing[0].normal) > TURNED_NORMALS;
        torn = torn || !facing || end_crossing[k].signs != end_crossing[0].signs;
    }
    return torn;
}

// All four corners stand at one surface: what is refracted and what is reflected [tevs2007, 3.2.5].
// False when light is totally reflected at some corners only.
fn split_front(flux: vec3f, from_patch: LightPatch) -> bool {
    var through = array<vec3f, 4>();
    var back = array<vec3f, 4>();
    var reflectance = 0.0;
    var totals = 0u;
    for (var k = 0u; k < 4u; k++) {
        let crossing = end_crossing[k];
        let split = split_at(crossing);
        through[k] = crossing.n_t * split.refracted;
        back[k] = crossing.n_i * split.reflected;
        reflectance += 0.25 * split.reflectance;
        totals += u32(split.total);
    }
    if (totals != 0u && totals != 4u) { return false; }
    if (from_patch.touched == UNTOUCHED) { put_out(OUT_BLOCKED, corner_x, corner_p, flux, from_patch); }
    var next = from_patch;
    next.touched = TOUCHED;
    next.bounces += 1u;
    go_on(end_x, back, flux * reflectance, next);
    next.region = end_crossing[0].region;
    next.signs = end_crossing[0].signs;
    go_on(end_x, through, flux * (1.0 - reflectance), next);
    return true;
}

// Light leaves the box; if the volume has changed it, the surroundings are told, and other bodies in any case.
fn leave(flux: vec3f, from_patch: LightPatch) {
    add_flux(TOTAL_OUT, flux);
    let touched = from_patch.touched != UNTOUCHED;
    if (touched || HANDS_ON) { put_out(select(OUT_UNTOUCHED, OUT_CAUSTIC, touched), end_x, end_p, flux, from_patch); }
}

// Of the matter that fills a region, 1/world metre.
fn region_extinction(region: u32) -> vec3f {
    let owner = min(region, AMBIENT - 1u);
    return select(volume.region_absorption[owner].xyz + volume.region_scattering[owner].xyz, vec3f(0.0), region >= AMBIENT);
}
