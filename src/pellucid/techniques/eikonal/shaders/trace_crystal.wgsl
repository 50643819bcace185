// Rays of the caller through a volume with crystals, of one kind wherever there are two (`pellucid.trace` with a mode).

//!import techniques/eikonal/shaders/march_crystal
//!struct TraceParams from techniques.eikonal.layouts
//!struct TraceRay from techniques.eikonal.layouts

@group(0) @binding(8) var<uniform> trace_params: TraceParams;
@group(0) @binding(9) var<storage, read_write> trace_rays: array<TraceRay>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = id.x + id.y * groups.x * 64u;
    if (index >= trace_params.count) { return; }
    var ray = trace_rays[index];
    let span = proxy_span(ray.position, ray.momentum);
    ray.base = ray.momentum * volume.ambient_n;
    ray.n = volume.ambient_n;
    if (span.x > span.y || span.y < 0.0) {
        ray.momentum = vec3f(0.0);
        ray.status = MISSED;
    } else {
        follow(&ray, max(span.x, 0.0));
    }
    trace_rays[index] = ray;
}

fn follow(ray: ptr<function, TraceRay>, approach: f32) {
    let d = (*ray).momentum;
    var walk = begin_walk((*ray).position + approach * d, d, volume.ambient_n);
    walk.optical_path = volume.ambient_n * approach * volume.scale;
    enter_sharp(&walk);
    var wave = Wave(walk.p0, ORDINARY);
    let around = crystal_at(walk.region, walk.x, d);
    if (around.splits && trace_params.mode == EXTRAORDINARY) {
        wave = Wave(momentum_of_ray(d, around.axis, around.n_o, around.n_e), EXTRAORDINARY);
    }
    var event = PAUSED;
    var interfaces = 0u;
    var crossing = Crossing();
    while (event == PAUSED || event == INTERFACE) {
        set_out(&walk, wave);
        let start = walk.x;
        let straight = !bends(walk.region, wave.mode) && !is_graded(walk.region);
        event = march_crystal(&walk, &wave, &crossing);
        if (straight) { gather_straight(&walk, start, distance(start, walk.x)); }
        if (event != INTERFACE) { continue; }
        // On into the wanted kind of ray; back as the kind that it is, where that is impossible.
        var leaving = leave_interface(wave, walk.x, walk.region, crossing);
        let splits = crystal_at(crossing.region, walk.x, crossing.normal).splits;
        let wanted = 2u + select(ORDINARY, trace_params.mode, splits);
        let passes = leaving.powers[wanted] > 0.0;
        let taken = select(wave.mode, wanted, passes);
        walk.transmittance *= leaving.powers[taken] * select(reflection_at(walk.x).rgb, vec3f(1.0), passes);
        wave = leaving.waves[taken];
        walk.region = select(walk.region, crossing.region, passes);
        walk.signs = select(walk.signs, crossing.signs, passes);
        interfaces += 1u;
        if (interfaces > volume.bounces) { event = EXHAUSTED; }
    }
    (*ray).position = walk.x;
    (*ray).optical_path = walk.optical_path;
    (*ray).momentum = walk.q;
    (*ray).base = walk.p0;
    (*ray).n = length(walk.p0 + walk.q);
    (*ray).transmittance = walk.transmittance;
    (*ray).status = event;
    (*ray).steps = walk.steps;
}
