// A picture of a sharp volume: a tree of rays, split by Snell and Fresnel at every interface, heaviest branch first.

//!import techniques/eikonal/shaders/march_sharp
//!import techniques/eikonal/shaders/view

const STACK = 8u;

struct Branch {
    x: vec3f,
    p: vec3f,
    weight: vec3f,
    region: u32,
    signs: u32,
    generation: u32,
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var entry = first_ray(group.xy, lane);
    if (!entry.exists) { return; }
    loop {
        var seen = Seen(vec3f(0.0), 0.0, false);
        if (entry.meets) { seen = look_into(entry); }
        keep(entry, seen);
        if (!RELAYED) { break; }
        entry = next_ray();
        if (!entry.exists) { break; }
    }
    finish_pixel();
}

fn look_into(entry: ViewRay) -> Seen {
    var walk = begin_walk(entry.x, entry.d, volume.ambient_n);
    enter_sharp(&walk);
    var stack: array<Branch, STACK>;
    var waiting = 0u;
    var crossing = Crossing();
    var radiance = vec3f(0.0);
    var weight = entry.weight;
    var generation = 0u;
    var first = select(-1.0, entry.distance, walk.region < AMBIENT);
    var going = true;
    while (going) {
        let from_x = walk.x;
        walk.emitted = vec3f(0.0);
        walk.transmittance = vec3f(1.0);
        walk.steps = 0u;
        let straight = !is_graded(walk.region);
        let event = march_sharp(&walk, &crossing);
        let d = normalize(walk.p0 + walk.q);
        // A last piece that is straight is looked along as a whole: a mesh may lie just where it leaves the box.
        let straight_out = event == LEFT && straight;
        let hit = mesh_between(from_x, walk.x);
        let blocked = hit.valid && !straight_out;
        let piece = distance(from_x, walk.x);
        let seen_piece = select(piece, min(hit.t / volume.scale + contact(), piece), hit.valid);
        if (straight) { gather_straight(&walk, from_x, seen_piece); }
        // Outside of all bodies up to here: smoke is seen, but has no surface.
        let meets_body = !blocked && (event == INTERFACE || event == OPAQUE);
        let unchanged = all(walk.transmittance == vec3f(1.0)) && all(walk.emitted == vec3f(0.0));
        if (first < 0.0 && !meets_body && unchanged) { return Seen(vec3f(0.0), -1.0, false); }
        first = select(first, entry.distance + distance(entry.x, walk.x) * volume.scale, first < 0.0 && meets_body);

        // A curved piece up to a mesh was short: it keeps its share of the exponent.
        let part = select(1.0, seen_piece / max(piece, 1e-20), blocked && !straight);
        radiance += weight * walk.emitted * part;
        weight *= pow(max(walk.transmittance, vec3f(1e-30)), vec3f(part));

        let along = select(select(walk.x, from_x + contact() * d, blocked), from_x - contact() * d, straight_out);
        var ending = Ending(LOOK_ALONG, along, d, weight);
        if (event == OPAQUE && !blocked) { ending = opaque_ending(walk.x, d, weight); }
        let goes_on = !blocked && (event == INTERFACE || event == PAUSED);
        if (goes_on) { ending.weight = vec3f(0.0); }
        radiance += end_ray(ending);

        if (goes_on && event == INTERFACE) {
            let split = split_at(crossing);
            let coat = reflection_at(walk.x);
            let mirrored = weight * split.reflectance * coat.rgb;
            // From outside a rough boundary spreads what it mirrors, and where the pixel first meets it, lamps glint.
            let spreads = walk.region >= AMBIENT && is_rough(coat);
            if (spreads || (GLINTS && generation == 0u && walk.region >= AMBIENT)) {
                radiance += end_lobe(walk.x, crossing.normal, split.reflected, coat, mirrored);
            }
            generation += 1u;
            let refracts = spreads || split.reflectance < 0.5;
            let back = Branch(
                walk.x, crossing.n_i * split.reflected, select(mirrored, vec3f(0.0), spreads), walk.region, walk.signs, generation);
            let through = Branch(
                walk.x, crossing.n_t * split.refracted, weight * (1.0 - split.reflectance), crossing.region, crossing.signs, generation);
            // The heavier branch goes on; the lighter waits, or ends in the environment.
            var heavier = back;
            var lighter = through;
            if (refracts) { heavier = through; lighter = back; }
            let within = generation <= volume.bounces;
            if (within && largest(lighter.weight) > volume.min_weight && waiting < STACK) {
                stack[waiting] = lighter;
                waiting += 1u;
            } else {
                radiance += lighter.weight * far_radiance(normalize(lighter.p));
            }
            follow(&walk, heavier);
            weight = heavier.weight;
            if (!within || largest(weight) <= volume.min_weight) {
                radiance += weight * far_radiance(normalize(walk.p0));
                weight = vec3f(0.0);
            }
        }
        if (!goes_on || largest(weight) <= 0.0) {
            going = waiting > 0u;
            if (going) {
                waiting -= 1u;
                let next = stack[waiting];
                follow(&walk, next);
                weight = next.weight;
                generation = next.generation;
            }
        }
    }
    return Seen(radiance, first, true);
}

fn follow(walk: ptr<function, Walk>, branch: Branch) {
    redirect(walk, branch.p, 1.0);
    (*walk).x = branch.x;
    (*walk).region = branch.region;
    (*walk).signs = branch.signs;
}
