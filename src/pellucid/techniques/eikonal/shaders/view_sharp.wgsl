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
    let pixel = pixel_of(group.xy, lane);
    if (any(pixel >= draw.size)) { return; }
    let ray = camera_ray(vec2f(draw.corner + pixel) + 0.5);
    let entry = to_object(ray);
    var seen = Seen(vec3f(0.0), 0.0, false);
    if (entry.meets) { seen = look_into(entry); }
    keep(pixel, ray, seen);
}

fn look_into(entry: ViewRay) -> Seen {
    var walk = begin_walk(entry.x, entry.d, volume.ambient_n);
    enter_sharp(&walk);
    var stack: array<Branch, STACK>;
    var waiting = 0u;
    var crossing = Crossing();
    var radiance = vec3f(0.0);
    var weight = vec3f(1.0);
    var generation = 0u;
    var first = -1.0;
    if (walk.region < AMBIENT) { first = entry.distance; }
    loop {
        let from_x = walk.x;
        walk.emitted = vec3f(0.0);
        walk.transmittance = vec3f(1.0);
        walk.steps = 0u;
        let event = march_sharp(&walk, &crossing);
        // A last piece that is straight is looked along as a whole: a mesh may lie just where it leaves the box.
        let straight_out = event == LEFT && !is_graded(walk.region);
        var blocked = SurfaceHit();
        if (!straight_out) { blocked = mesh_between(from_x, walk.x); }
        var done = true;
        if (blocked.valid) {
            if (first < 0.0) { return Seen(vec3f(0.0), 0.0, false); }
            // The piece was homogeneous, or short: the part of it up to the mesh keeps its share of the exponent.
            let part = blocked.t / max(distance(from_x, walk.x) * volume.scale, 1e-20);
            let kept = pow(max(walk.transmittance, vec3f(1e-30)), vec3f(part));
            radiance += weight * (walk.emitted * part + kept * shade_hit(blocked, to_world(from_x), direction_to_world(walk.x - from_x)));
        } else {
            radiance += weight * walk.emitted;
            weight *= walk.transmittance;
            if (event == INTERFACE) {
                if (first < 0.0) { first = entry.distance + distance(entry.x, walk.x) * volume.scale; }
                done = false;
                generation += 1u;
                let split = split_at(crossing);
                let heavier_refracts = split.reflectance < 0.5;
                let light = weight * select(1.0 - split.reflectance, split.reflectance, heavier_refracts);
                // Both directions as branches; the heavier goes on, the lighter waits, or ends in the environment.
                let through = Branch(walk.x, crossing.n_t * split.refracted, light, crossing.region, crossing.signs, generation);
                let back = Branch(walk.x, crossing.n_i * split.reflected, light, walk.region, walk.signs, generation);
                var lighter = through;
                if (heavier_refracts) { lighter = back; }
                if (!split.total) {
                    if (largest(light) > volume.min_weight && waiting < STACK && generation <= volume.bounces) {
                        stack[waiting] = lighter;
                        waiting += 1u;
                    } else {
                        radiance += light * far_radiance(normalize(lighter.p));
                    }
                }
                weight -= select(light, vec3f(0.0), split.total);
                if (heavier_refracts) {
                    pass_through(&walk, crossing, split.refracted);
                } else {
                    redirect(&walk, split.reflected, crossing.n_i);
                }
                if (generation > volume.bounces || largest(weight) <= volume.min_weight) {
                    radiance += weight * far_radiance(normalize(walk.p0));
                    done = true;
                }
            } else if (event == PAUSED) {
                done = false;
            } else if (event == OPAQUE) {
                if (first < 0.0) { first = entry.distance + distance(entry.x, walk.x) * volume.scale; }
                radiance += weight * opaque_radiance(walk.x, normalize(walk.p0 + walk.q));
            } else {
                if (first < 0.0) { return Seen(vec3f(0.0), 0.0, false); }
                radiance += weight * outside_radiance(select(walk.x, from_x, straight_out), normalize(walk.p0 + walk.q));
            }
        }
        if (done) {
            if (waiting == 0u) { break; }
            waiting -= 1u;
            let next = stack[waiting];
            walk.x = next.x;
            walk.p0 = next.p;
            walk.q = vec3f(0.0);
            walk.bend = 0.0;
            walk.radius = 0.0;
            walk.region = next.region;
            walk.signs = next.signs;
            weight = next.weight;
            generation = next.generation;
        }
    }
    return Seen(radiance, first, true);
}

fn largest(v: vec3f) -> f32 {
    return max(v.x, max(v.y, v.z));
}
