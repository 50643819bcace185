// A picture of a sharp volume with crystals: the tree of `view_sharp`, in which light in a crystal goes as two kinds of rays.

//!import techniques/eikonal/shaders/march_crystal
//!import techniques/eikonal/shaders/view

const STACK = 12u;

struct Branch {
    x: vec3f,
    wave: Wave,
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
    var wave = Wave(walk.p0, ORDINARY);
    var stack: array<Branch, STACK>;
    var waiting = 0u;
    var crossing = Crossing();
    var radiance = vec3f(0.0);
    var weight = entry.weight;
    var generation = 0u;
    var first = select(-1.0, entry.distance, walk.region < AMBIENT);
    // A camera inside a crystal looks along both of its rays.
    let around = crystal_at(walk.region, walk.x, entry.d);
    if (around.splits) {
        weight *= 0.5;
        let other = Wave(momentum_of_ray(entry.d, around.axis, around.n_o, around.n_e), EXTRAORDINARY);
        stack[0] = Branch(walk.x, other, weight, walk.region, walk.signs, 0u);
        waiting = 1u;
    }
    var going = true;
    while (going) {
        let from_x = walk.x;
        walk.emitted = vec3f(0.0);
        walk.transmittance = vec3f(1.0);
        walk.steps = 0u;
        set_out(&walk, wave);
        let straight = !bends(walk.region, wave.mode) && !is_graded(walk.region);
        let event = march_crystal(&walk, &wave, &crossing);
        let d = normalize(walk.p0 + walk.q);
        // From here to the split as in view_sharp, which says why.
        let straight_out = event == LEFT && straight;
        let hit = mesh_between(from_x, walk.x);
        let blocked = hit.valid && !straight_out;
        let piece = distance(from_x, walk.x);
        let seen_piece = select(piece, min(hit.t / volume.scale + contact(), piece), hit.valid);
        if (straight) { gather_straight(&walk, from_x, seen_piece); }
        let meets_body = !blocked && (event == INTERFACE || event == OPAQUE);
        let unchanged = all(walk.transmittance == vec3f(1.0)) && all(walk.emitted == vec3f(0.0));
        if (first < 0.0 && !meets_body && unchanged) { return Seen(vec3f(0.0), -1.0, false); }
        first = select(first, entry.distance + distance(entry.x, walk.x) * volume.scale, first < 0.0 && meets_body);

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
            var leaving = leave_interface(wave, walk.x, walk.region, crossing);
            let coat = reflection_at(walk.x);
            let spreads = walk.region >= AMBIENT && is_rough(coat);
            if (spreads || (GLINTS && generation == 0u && walk.region >= AMBIENT)) {
                let mirrored = normalize(leaving.waves[0].p);
                radiance += end_lobe(walk.x, crossing.normal, mirrored, coat, weight * leaving.powers.x * coat.rgb);
            }
            if (spreads) { leaving.powers.x = 0.0; }
            generation += 1u;
            let within = generation <= volume.bounces;
            // The heaviest branch goes on; the others wait, or end in the environment.
            let most = max(max(leaving.powers.x, leaving.powers.y), max(leaving.powers.z, leaving.powers.w));
            let arrived = weight;
            let from_region = walk.region;
            let from_signs = walk.signs;
            var chosen = false;
            for (var k = 0u; k < 4u; k++) {
                let power = leaving.powers[k];
                let goes_through = k >= 2u;
                let region = select(from_region, crossing.region, goes_through);
                let signs = select(from_signs, crossing.signs, goes_through);
                let own = arrived * power * select(coat.rgb, vec3f(1.0), goes_through);
                let strong = within && largest(own) > volume.min_weight;
                if (power == most && !chosen) {
                    chosen = true;
                    weight = own;
                    wave = leaving.waves[k];
                    walk.region = region;
                    walk.signs = signs;
                } else if (strong && waiting < STACK) {
                    stack[waiting] = Branch(walk.x, leaving.waves[k], own, region, signs, generation);
                    waiting += 1u;
                } else if (power > 0.0) {
                    radiance += own * far_radiance(normalize(leaving.waves[k].p));
                }
            }
            if (!within || largest(weight) <= volume.min_weight) {
                radiance += weight * far_radiance(normalize(wave.p));
                weight = vec3f(0.0);
            }
        }
        if (!goes_on || largest(weight) <= 0.0) {
            going = waiting > 0u;
            if (going) {
                waiting -= 1u;
                let next = stack[waiting];
                walk.x = next.x;
                walk.region = next.region;
                walk.signs = next.signs;
                wave = next.wave;
                weight = next.weight;
                generation = next.generation;
            }
        }
    }
    return Seen(radiance, first, true);
}
