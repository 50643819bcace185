// One generation of light through matter that is homogeneous between sharp surfaces: corners go straight to what they meet next.

//!import techniques/eikonal/shaders/light_patches
//!import techniques/eikonal/shaders/light_meshes
//!import techniques/eikonal/shaders/march_straight

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= atomicLoad(&counters.lists[generation.index + 1u].count)) { return; }
    unpack(patches[id.x]);
    let tube = free(patches[id.x]);
    for (var k = 0u; k < 4u; k++) {
        // A single ray has four corners in one place.
        if (k == 0u || tube.is_ray == 0u) {
            find_end(k, tube);
        } else {
            end_x[k] = end_x[0];
            end_p[k] = end_p[0];
            end_event[k] = end_event[0];
            end_crossing[k] = end_crossing[0];
        }
    }
    let d = normalize(middle(corner_p));
    let torn = is_torn(end_event[0] == INTERFACE);
    let from_edges = cut_edges(corner_x, d);
    let to_edges = cut_edges(end_x, d);
    let from_width = max(from_edges.x, from_edges.y);
    let to_width = max(to_edges.x, to_edges.y);
    let narrow = max(from_width, to_width) <= SMALLEST_TORN * light.voxel;
    var flux = tube.flux;
    if (torn) {
        var parted = false;
        if (narrow || !worth_dividing(flux, tube)) {
            parted = collapse(corner_x, corner_p, flux, tube);
        } else {
            parted = divide(corner_x, corner_p, from_edges, flux, false, tube);
        }
        if (!parted) { add_flux(TOTAL_ENDED, flux); }
        return;
    }
    // Where on the way the tube gets too wide: widths of straight rays grow no faster than linearly between two of them.
    let limit = light.split_width;
    let fans_out = ways_differ(corner_p);
    let widens = too_wide(to_width, fans_out) && worth_dividing(flux, tube);
    var part = vec4f(select(1.0, clamp((limit - from_width) / max(to_width - from_width, 1e-12), 0.0, 1.0), widens));
    // What a surface stretches is divided before it: there a bundle is still straight, and its children meet the true surface.
    let stretched = edges_behind();
    let stretches = !widens && end_event[0] == INTERFACE && tube.is_ray == 0u && worth_stretching(flux)
        && too_wide(max(stretched.x, stretched.y) / STRETCHED, fans_out || normals_differ());
    if (stretches) { part = before_surface(); }
    var at = array<vec3f, 4>();
    for (var k = 0u; k < 4u; k++) { at[k] = mix(corner_x[k], end_x[k], part[k]); }
    let before = flux;
    travel(tube_between(corner_x, at, tube), &flux, region_extinction(tube.region));
    add_flux(TOTAL_ABSORBED, before - flux);
    var next = tube;
    if (AMBIENT_MATTER && tube.touched == UNTOUCHED) {
        put_out(OUT_BLOCKED, corner_x, corner_p, before, tube);
        next.touched = TOUCHED;
    }
    // Behind a caustic the source lets a front end [tevs2007, 6.2.4].
    if (INTENSITY && tube.is_ray == 0u && orientation(at, d) != orientation(corner_x, d)) {
        add_flux(TOTAL_ENDED, flux);
        return;
    }
    if (widens || stretches) {
        if (!divide(at, corner_p, select(cut_edges(at, d), stretched, stretches), flux, widens, next)) { add_flux(TOTAL_ENDED, flux); }
        return;
    }
    switch end_event[0] {
        case INTERFACE: {
            next.stuck = select(0u, tube.stuck + 1u, is_stuck());
            if (!split_front(flux, next) && !collapse(end_x_before(), corner_p, flux, next)) { add_flux(TOTAL_ENDED, flux); }
        }
        case OPAQUE: { add_flux(TOTAL_ABSORBED, flux); }
        case EXHAUSTED: { add_flux(TOTAL_ENDED, flux); }
        default: { leave(flux, next); }
    }
}

// Corners a little before the surface that they stand at, so that a single ray meets it by itself.
fn end_x_before() -> array<vec3f, 4> {
    var x = array<vec3f, 4>();
    for (var k = 0u; k < 4u; k++) { x[k] = end_x[k] - 1e-3 * volume.voxel * normalize(corner_p[k]); }
    return x;
}

// Edges of the cut of the patch behind the surface that its corners stand at.
fn edges_behind() -> vec2f {
    let first = split_at(end_crossing[0]);
    let last = split_at(end_crossing[3]);
    let through = first.refracted + last.refracted;
    let back = first.reflected + last.reflected;
    return cut_edges(end_x, normalize(select(through, back, first.total || last.total)));
}

const BEFORE_SURFACE = 0.25;   // voxels

// Shares of the ways of all corners up to one front a little before the surface.
fn before_surface() -> vec4f {
    let ways = vec4f(
        distance(corner_x[0], end_x[0]), distance(corner_x[1], end_x[1]),
        distance(corner_x[2], end_x[2]), distance(corner_x[3], end_x[3]));
    let shortest = min(min(ways.x, ways.y), min(ways.z, ways.w)) - BEFORE_SURFACE * volume.voxel;
    return max(shortest, 0.0) / max(ways, vec4f(1e-12));
}

const NO_WAY = 0.02;          // voxels
const MOST_STUCK = 2u;

// In a wall thinner than a voxel a ray may believe to be on the wrong side of a surface, and be turned back at once for ever. After
// some ways of no length it takes the side that the distances say, and goes straight on.
fn free(tube: LightPatch) -> LightPatch {
    var freed = tube;
    if (tube.stuck < MOST_STUCK) { return freed; }
    let ahead = middle(corner_x) + 2.0 * FIRST_STRIDE * volume.voxel * normalize(middle(corner_p));
    freed.signs = signs_of(distances_at(ahead));
    freed.region = owner_of(freed.signs);
    for (var k = 0u; k < 4u; k++) { corner_p[k] = region_index(freed.region, corner_x[k]) * normalize(corner_p[k]); }
    freed.stuck = 0u;
    return freed;
}

fn is_stuck() -> bool {
    return end_event[0] == INTERFACE && distance(middle(corner_x), middle(end_x)) < NO_WAY * volume.voxel;
}

// Follow corner k to a surface, an opaque voxel, a mesh, or out of the box.
fn find_end(k: u32, tube: LightPatch) {
    let start = corner_x[k];
    let d = normalize(corner_p[k]);
    let room = max(intersect_box(start - light.box_center, d, light.box_half).y, 0.0);
    var signs = tube.signs;
    var steps = 0u;
    var t = 0.0;
    var event = PAUSED;
    while (event == PAUSED) {
        let found = next_change(start, d, t, room, signs, &steps);
        t = found.t;
        event = select(LEFT, EXHAUSTED, steps >= volume.max_steps);
        if (found.blocked) { event = OPAQUE; }
        if (found.changed) {
            let hit = surface_between(start + t * d, found.ahead * d, signs, found.distances);
            t += hit.part * found.ahead;
            let flipped = signs ^ (1u << hit.region);
            event = select(INTERFACE, PAUSED, owner_of(flipped) == tube.region);
            if (event == PAUSED) { signs = flipped; }
            end_crossing[k] = crossing_at(start + t * d, corner_p[k], hit.normal, flipped);
        }
    }
    let stop = mesh_before(start, d, t);
    end_x[k] = start + select(t, stop, stop < t) * d;
    end_p[k] = corner_p[k];
    end_event[k] = select(event, MESH, stop < t);
}
