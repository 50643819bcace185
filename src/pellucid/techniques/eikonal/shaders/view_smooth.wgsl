// A picture of a smooth volume [tevs2007, 5.2]: one bent ray a pixel, split at each boundary that it passes.

//!import techniques/eikonal/shaders/march_smooth
//!import techniques/eikonal/shaders/view

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var entry = first_ray(group.xy, lane);
    if (!entry.exists) { return; }
    loop {
        var seen = Seen(vec3f(0.0), 0.0, false);
        if (entry.meets) { seen = look_through(entry); }
        keep(entry, seen);
        if (!RELAYED) { break; }
        entry = next_ray();
        if (!entry.exists) { break; }
    }
    finish_pixel();
}

fn look_through(entry: ViewRay) -> Seen {
    var walk = begin_walk(entry.x, entry.d, index_at(entry.x));
    var crossing = Crossing();
    var passage = begin_passage(walk);
    var radiance = vec3f(0.0);
    var mirrored = Ending();  // at the first boundary; it is looked along like the ray that goes through
    var first = -1.0;         // distance to the first boundary
    var bent = -1.0;          // distance to where the ray is first bent
    var event = PAUSED;
    var from_x = entry.x;
    var towards = vec3f(0.0); // from there to a mesh
    var limit = NO_LIMIT;     // object metres from there to a mesh
    var blocked = false;
    while ((event == PAUSED || event == INTERFACE) && largest(walk.transmittance) > 1e-4 && !blocked) {
        let before = walk;
        let passage_before = passage;
        event = march_smooth(&walk, &passage, &crossing, limit);
        blocked = limit < NO_LIMIT;
        let hit = mesh_between(before.x, walk.x);
        if (hit.valid && !blocked) {
            // Once more, up to the mesh only: what matter does behind it is not seen.
            from_x = before.x;
            towards = walk.x - before.x;
            limit = hit.t / volume.scale + contact();
            walk = before;
            passage = passage_before;
            event = PAUSED;
        } else {
            if (bent < 0.0 && any(walk.q != vec3f(0.0))) { bent = entry.distance + distance(entry.x, before.x) * volume.scale; }
            let split = split_at(crossing);
            let reflectance = select(0.0, split.reflectance, event == INTERFACE && !blocked);
            // Without extinction what has been split off so far is all that dims the light.
            let coat = reflection_at(passage.x_steepest);
            let reflected = reflectance * coat.rgb * select(walk.transmittance, passage.light_before, ABSORBS || SCATTERS);
            if (reflectance > 0.0 && first < 0.0) {
                first = entry.distance + distance(entry.x, passage.x_steepest) * volume.scale;
                let alone = select(reflected, vec3f(0.0), is_rough(coat));
                mirrored = Ending(LOOK_ALONG, passage.x_steepest, split.reflected, alone);
                radiance += end_lobe(passage.x_steepest, crossing.normal, split.reflected, coat, reflected);
            } else {
                radiance += reflected * far_radiance(split.reflected);
            }
            walk.transmittance *= 1.0 - reflectance;
            if (EMITS || SCATTERS) { walk.emitted = mix(walk.emitted, passage.glow_before, reflectance); }
            passage.light_before = walk.transmittance;
            passage.glow_before = walk.emitted;
        }
    }
    radiance += walk.emitted;
    let d = normalize(select(walk.p0 + walk.q, towards, blocked));
    // A little back where it leaves the box: a mesh may lie just there.
    let along = select(walk.x - contact() * d, from_x + contact() * d, blocked);
    var ending = Ending(LOOK_ALONG, along, d, walk.transmittance);
    let meets_voxel = event == OPAQUE && !blocked;
    if (meets_voxel) { ending = opaque_ending(walk.x, d, walk.transmittance); }
    let touched = first >= 0.0 || meets_voxel || has_changed(walk);
    mirrored.weight *= entry.weight;
    ending.weight *= entry.weight;
    radiance *= entry.weight;
    if (touched) { radiance += end_ray(mirrored) + end_ray(ending); }
    // Smoke and hot air have no surface, an opaque voxel in them has.
    var surface = select(-1.0, bent, volume.writes_depth != 0u);
    if (meets_voxel && surface < 0.0) { surface = entry.distance + distance(entry.x, walk.x) * volume.scale; }
    return Seen(radiance, select(surface, first, first >= 0.0), touched);
}

fn has_changed(walk: Walk) -> bool {
    return any(walk.q != vec3f(0.0)) || any(walk.transmittance != vec3f(1.0)) || any(walk.emitted != vec3f(0.0));
}
