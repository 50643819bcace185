// One generation of light through matter whose index varies: the corners of a patch take steps of equal optical time, so that they
// stay one front [tevs2007, eq. 4.12-4.13, 6.1-6.2, here of second order].

//!import techniques/eikonal/shaders/light_patches
//!import techniques/eikonal/shaders/light_meshes
//!import techniques/eikonal/shaders/box
//!import optics/eikonal

override SMOOTH: bool = false;         // no surfaces: rays bend through boundaries, and events tell of them
override ADAPTIVE: bool = true;

const BEND_PER_STEP = 0.4;             // radians for each voxel that a step may be long: step.wgsl
const PIECE = 0.8;                     // voxels: how far light goes before its track is written down
const BENT = 1e-5;                     // change of a momentum that tells light from light that passed undisturbed

var<private> parked: vec4<bool>;       // corners that wait at a surface
var<private> slope: vec4f;             // |force| met last by each corner, 1/m
var<private> radius: vec4f;            // around each corner in which nothing changes, object metres
// A passage through a steep part of a smooth field, as in march_smooth.wgsl, for a front
var<private> passing: bool;
var<private> p_calm: array<vec3f, 4>;
var<private> x_calm: array<vec3f, 4>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= atomicLoad(&counters.lists[generation.index + 1u].count)) { return; }
    let tube = patches[id.x];
    unpack(tube);
    end_x = corner_x;
    end_p = corner_p;
    p_calm = corner_p;
    x_calm = corner_x;
    parked = vec4<bool>(false);
    slope = vec4f(0.0);
    radius = vec4f(0.0);
    passing = false;
    var flux = tube.flux;
    var written = middle(end_x);
    var written_x = end_x;
    var since_parked = 0.0;
    var event = PAUSED;
    var signs = tube.signs;
    let of_region = extinction_of(tube.region);
    let graded = SMOOTH || is_graded(tube.region);
    for (var steps = 0u; event == PAUSED; steps++) {
        let at = middle(end_x);
        let way = normalize(middle(end_p));
        let room = intersect_box(at - light.box_center, way, light.box_half).y;
        let from_x = end_x;
        let from_edges = cut_edges(end_x, way);
        let moved = step_front(tube, signs, room, graded);
        since_parked += select(0.0, moved, any(parked));
        let to_edges = cut_edges(end_x, way);
        let from_width = max(from_edges.x, from_edges.y);
        let to_width = max(to_edges.x, to_edges.y);
        // A leap through matter that does not vary goes no farther than the front stays narrow.
        let overshoots = moved > volume.voxel && to_width > 1.01 * light.split_width && tube.is_ray == 0u && worth_dividing(flux, tube);
        let part = clamp((1.005 * light.split_width - from_width) / max(to_width - from_width, 1e-12), 0.5 * volume.voxel / moved, 1.0);
        if (overshoots && !any(parked)) { for (var k = 0u; k < 4u; k++) { end_x[k] = mix(from_x[k], end_x[k], part); } }
        let now = middle(end_x);
        let edges = cut_edges(end_x, way);
        let width = max(edges.x, edges.y);
        let left = room <= 1e-4 * volume.voxel;
        let all_parked = all(parked);
        let parted = any(parked) && !all_parked && since_parked > 2.0 * width + 0.5 * volume.voxel;
        let too_wide = width > light.split_width && worth_dividing(flux, tube) && !any(parked) && tube.is_ray == 0u;
        let opaque_here = BLOCKS && opaque_at(now).a > 0.5;
        let exhausted = steps >= volume.max_steps;
        event = select(event, EXHAUSTED, exhausted);
        event = select(event, DIVIDE, too_wide && distance(now, middle(corner_x)) > 1e-3 * volume.voxel);
        event = select(event, PARTED, parted);
        event = select(event, INTERFACE, all_parked);
        event = select(event, OPAQUE, opaque_here);
        event = select(event, LEFT, left);
        if (distance(now, written) > PIECE * volume.voxel || event != PAUSED) {
            let reach = distance(now, written);
            let stop = mesh_before(written, (now - written) / max(reach, 1e-20), reach);
            if (stop < reach) {
                event = MESH;
                let back = (now - written) * (1.0 - stop / reach);
                for (var k = 0u; k < 4u; k++) { end_x[k] -= back; }
            }
            let before = flux;
            travel(tube_between(written_x, end_x, tube), &flux, of_region);
            add_flux(TOTAL_ABSORBED, before - flux);
            written = middle(end_x);
            written_x = end_x;
        }
        // Behind a caustic the source lets a front end [tevs2007, 6.2.4].
        let turned_over = orientation(end_x, way) != orientation(corner_x, normalize(middle(corner_p)));
        if (INTENSITY && event == PAUSED && tube.is_ray == 0u && turned_over) { event = EXHAUSTED; }
        if (SMOOTH) { flux = pass_boundary(flux, tube); }
    }
    finish(event, flux, tube);
}

const DIVIDE = 7u;            // how a way can end, beside those of walk.wgsl and light_meshes.wgsl
const PARTED = 8u;

fn finish(event: u32, flux: vec3f, tube: LightPatch) {
    var next = tube;
    var turn = 0.0;
    for (var k = 0u; k < 4u; k++) { turn = max(turn, distance(end_p[k], corner_p[k])); }
    let changed = turn > BENT || any(flux != tube.flux);
    if (changed && tube.touched == UNTOUCHED) {
        put_out(OUT_BLOCKED, corner_x, corner_p, tube.flux, tube);
        next.touched = TOUCHED;
    }
    for (var k = 0u; k < 4u; k++) { end_event[k] = event; }
    switch event {
        case INTERFACE: {
            if (is_torn(true) || !split_front(flux, next)) {
                if (!scatter_corners(end_x_before(), end_p, flux, next)) { add_flux(TOTAL_ENDED, flux); }
            }
        }
        case PARTED: { if (!scatter_corners(end_x_before(), end_p, flux, next)) { add_flux(TOTAL_ENDED, flux); } }
        case DIVIDE: { if (!divide(end_x, end_p, cut_edges(end_x, normalize(middle(end_p))), flux, true, next)) { add_flux(TOTAL_ENDED, flux); } }
        case OPAQUE: { add_flux(TOTAL_ABSORBED, flux); }
        case EXHAUSTED: { add_flux(TOTAL_ENDED, flux); }
        default: { leave(flux, next); }
    }
}

// Corners a little before the surface that they wait at, so that single rays meet it by themselves.
fn end_x_before() -> array<vec3f, 4> {
    var x = end_x;
    for (var k = 0u; k < 4u; k++) { if (parked[k]) { x[k] -= 1e-3 * volume.voxel * normalize(end_p[k]); } }
    return x;
}

// All corners that do not wait advance by the same optical time; returns the way of the longest, object metres.
fn step_front(tube: LightPatch, signs: u32, room: f32, graded: bool) -> f32 {
    var time = 1e30;
    for (var k = 0u; k < 4u; k++) {
        if (parked[k]) { continue; }
        let n = length(end_p[k]);
        var stride = min(volume.step, BEND_PER_STEP * (volume.step / volume.voxel) * n * n / max(slope[k], 1e-10));
        if (!graded) { stride = 1e30; }
        if (ADAPTIVE) { stride = max(stride, radius[k]); }
        if (!SMOOTH) { stride = min(stride, stride_from(distances_at(end_x[k]), end_x[k])); }
        time = min(time, n * min(stride, max(room, 1e-3 * volume.voxel)));
    }
    var longest = 0.0;
    for (var k = 0u; k < 4u; k++) {
        if (parked[k]) { continue; }
        let from_x = end_x[k];
        let n = length(end_p[k]);
        let sigma = time / (n * n);
        let probe = drift(from_x, end_p[k], 0.5 * sigma);
        let here = force_at(probe);
        let jumps = !graded || (ADAPTIVE && radius[k] >= sigma * n * 0.999);
        let force = select(here.force, vec3f(0.0), jumps);
        end_p[k] += sigma * force;
        end_x[k] = drift(probe, end_p[k], 0.5 * sigma);
        slope[k] = length(force);
        radius[k] = max(here.radius - 0.5 * sigma * n, 0.0);
        if (!SMOOTH) { park(k, from_x, tube, signs); }
        longest = max(longest, sigma * n);
    }
    return longest;
}

// Stop corner k where it meets a surface behind which something else begins.
fn park(k: u32, from_x: vec3f, tube: LightPatch, signs: u32) {
    let distances = distances_at(end_x[k]);
    if (signs_of(distances) == signs) { return; }
    let hit = surface_between(from_x, end_x[k] - from_x, signs, distances);
    let flipped = signs ^ (1u << hit.region);
    if (owner_of(flipped) == tube.region) { return; }
    end_x[k] = mix(from_x, end_x[k], hit.part);
    end_crossing[k] = crossing_at(end_x[k], end_p[k], hit.normal, flipped);
    parked[k] = true;
}

// What a boundary of a smooth field reflects, when the front has just passed it: the normal is where the momentum turned to. The
// mirrored front begins in the calm before, since a ray that begins inside the boundary would be bent by the rest of it.
fn pass_boundary(flux: vec3f, tube: LightPatch) -> vec3f {
    let n = length(end_p[0]);
    let steep = max(max(slope.x, slope.y), max(slope.z, slope.w)) / n;
    let begins = !passing && steep > volume.boundary_on;
    let flat = steep < volume.boundary_off;
    let over = passing && flat;
    if (!passing && flat) {
        p_calm = end_p;
        x_calm = end_x;
    }
    passing = (passing || begins) && !over;
    if (!over) { return flux; }
    var back = array<vec3f, 4>();
    var reflectance = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let change = end_p[k] - p_calm[k];
        let normal = normalize(select(change, p_calm[k], dot(change, change) < 1e-12));
        let towards = dot(p_calm[k], normal);
        let passes = towards * dot(end_p[k], normal) > 0.0;
        let n_i = length(p_calm[k]);
        let cosine = abs(towards) / n_i;
        reflectance += select(0.0, 0.25 * fresnel_dielectric(cosine, n_i, length(end_p[k])), passes);
        back[k] = n_i * reflect(p_calm[k] / n_i, -sign(towards) * normal);
    }
    let mirrored = x_calm;
    p_calm = end_p;
    x_calm = end_x;
    if (reflectance <= 0.0) { return flux; }
    var next = tube;
    next.touched = TOUCHED;
    next.bounces += 1u;
    go_on(mirrored, back, flux * reflectance, next);
    return flux * (1.0 - reflectance);
}

fn extinction_of(region: u32) -> vec3f {
    if (SMOOTH) { return vec3f(0.0); }
    return region_extinction(region);
}
