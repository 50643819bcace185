// A picture of a smooth volume [tevs2007, 5.2]: one bent ray a pixel, split at each boundary that it passes.

//!import techniques/eikonal/shaders/march_smooth
//!import techniques/eikonal/shaders/view

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = pixel_of(group.xy, lane);
    if (any(pixel >= draw.size)) { return; }
    let ray = camera_ray(vec2f(draw.corner + pixel) + 0.5);
    let entry = enter(pixel, ray);
    var seen = Seen(vec3f(0.0), 0.0, false);
    if (entry.meets) { seen = look_through(entry); }
    keep(pixel, ray, seen);
}

fn look_through(entry: ViewRay) -> Seen {
    var walk = begin_walk(entry.x, entry.d, index_at(entry.x));
    var crossing = Crossing();
    var passage = begin_passage(walk);
    var radiance = vec3f(0.0);
    var mirrored = Ending();  // at the first boundary; it is looked along like the ray that goes through
    var first = -1.0;         // distance to the first boundary
    var changed = -1.0;       // distance to where the volume first does anything
    var event = PAUSED;
    var from_x = entry.x;
    var blocked = false;
    while ((event == PAUSED || event == INTERFACE) && largest(walk.transmittance) > 1e-4 && !blocked) {
        from_x = walk.x;
        event = march_smooth(&walk, &passage, &crossing);
        blocked = mesh_between(from_x, walk.x).valid;
        if (changed < 0.0 && has_changed(walk)) { changed = entry.distance + distance(entry.x, from_x) * volume.scale; }
        let split = split_at(crossing);
        let reflectance = select(0.0, split.reflectance, event == INTERFACE && !blocked);
        // Without absorption what has been split off so far is all that dims the light.
        let reflected = reflectance * select(walk.transmittance, passage.light_before, ABSORBS);
        if (reflectance > 0.0 && first < 0.0) {
            first = entry.distance + distance(entry.x, passage.x_steepest) * volume.scale;
            mirrored = Ending(LOOK_ALONG, passage.x_steepest, split.reflected, reflected);
        } else {
            radiance += reflected * far_radiance(split.reflected);
        }
        walk.transmittance *= 1.0 - reflectance;
        passage.light_before = walk.transmittance;
    }
    radiance += walk.emitted;
    let d = normalize(select(walk.p0 + walk.q, walk.x - from_x, blocked));
    // A little back where it leaves the box: a mesh may lie just there.
    let along = select(walk.x - contact() * d, from_x + contact() * d, blocked);
    var ending = Ending(LOOK_ALONG, along, d, walk.transmittance);
    if (event == OPAQUE && !blocked) { ending = opaque_ending(walk.x, d, walk.transmittance); }
    let touched = changed >= 0.0 || first >= 0.0 || event == OPAQUE;
    if (touched) { radiance += end_ray(mirrored) + end_ray(ending); }
    let depth = select(select(entry.distance, changed, changed >= 0.0), first, first >= 0.0);
    return Seen(radiance, depth, touched);
}

fn has_changed(walk: Walk) -> bool {
    return any(walk.q != vec3f(0.0)) || any(walk.transmittance != vec3f(1.0)) || any(walk.emitted != vec3f(0.0));
}
