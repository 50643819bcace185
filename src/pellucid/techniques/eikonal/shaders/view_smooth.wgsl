// A picture of a smooth volume [tevs2007, 5.2]: one bent ray a pixel, split at each boundary that it passes.

//!import techniques/eikonal/shaders/march_smooth
//!import techniques/eikonal/shaders/view

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = pixel_of(group.xy, lane);
    if (any(pixel >= draw.size)) { return; }
    let ray = camera_ray(vec2f(draw.corner + pixel) + 0.5);
    let entry = to_object(ray);
    var seen = Seen(vec3f(0.0), 0.0, false);
    if (entry.meets) { seen = look_through(entry); }
    keep(pixel, ray, seen);
}

fn look_through(entry: ViewRay) -> Seen {
    var walk = begin_walk(entry.x, entry.d, index_at(entry.x));
    var crossing = Crossing();
    var passage = Passage();
    var radiance = vec3f(0.0);
    var weight = vec3f(1.0);
    var first = -1.0;        // distance to the first boundary
    var changed = -1.0;      // distance to where the volume first does anything
    var event = PAUSED;
    while (event == PAUSED || event == INTERFACE) {
        let from_x = walk.x;
        event = march_smooth(&walk, &passage, &crossing);
        let blocked = mesh_between(from_x, walk.x);
        if (changed < 0.0 && has_changed(walk)) { changed = entry.distance + distance(entry.x, from_x) * volume.scale; }
        radiance += weight * walk.emitted;
        weight *= walk.transmittance;
        walk.emitted = vec3f(0.0);
        walk.transmittance = vec3f(1.0);
        if (blocked.valid) {
            radiance += weight * shade_hit(blocked, to_world(from_x), direction_to_world(walk.x - from_x));
            weight = vec3f(0.0);
            break;
        }
        if (event == INTERFACE) {
            let split = split_at(crossing);
            var mirrored = far_radiance(split.reflected);
            if (first < 0.0) {
                first = entry.distance + distance(entry.x, passage.x_steepest) * volume.scale;
                mirrored = outside_radiance(passage.x_steepest, split.reflected);
            }
            radiance += weight * split.reflectance * mirrored;
            weight *= 1.0 - split.reflectance;
        }
        if (max(weight.x, max(weight.y, weight.z)) < 1e-4) { break; }
    }
    let d = normalize(walk.p0 + walk.q);
    if (event == OPAQUE) {
        radiance += weight * opaque_radiance(walk.x, d);
    } else {
        // A little back: a mesh may lie just where the ray leaves the box.
        radiance += weight * outside_radiance(walk.x - 0.01 * volume.voxel * d, d);
    }
    let depth = select(select(entry.distance, changed, changed >= 0.0), first, first >= 0.0);
    return Seen(radiance, depth, changed >= 0.0 || event == OPAQUE);
}

fn has_changed(walk: Walk) -> bool {
    return any(walk.q != vec3f(0.0)) || any(walk.transmittance != vec3f(1.0)) || any(walk.emitted != vec3f(0.0));
}
