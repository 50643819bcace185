// Rays of the caller through one volume, by the same march that draws it (`pellucid.trace`).

//!import techniques/eikonal/shaders/march_smooth
//!import techniques/eikonal/shaders/march_sharp
//!import techniques/eikonal/shaders/splitting
//!struct TraceParams from techniques.eikonal.layouts
//!struct TraceRay from techniques.eikonal.layouts

override SHARP: bool = true;

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
    let start = (*ray).position + approach * (*ray).momentum;
    var walk = begin_walk(start, (*ray).momentum, volume.ambient_n);
    walk.optical_path = volume.ambient_n * approach * volume.scale;
    var event = PAUSED;
    var interfaces = 0u;
    if (SHARP) { enter_sharp(&walk); } else { redirect(&walk, (*ray).momentum, index_at(start)); }
    var crossing = Crossing();
    var passage = begin_passage(walk);
    while (event == PAUSED || event == INTERFACE) {
        if (SHARP) { event = trace_sharp(&walk, &crossing); } else { event = march_smooth(&walk, &passage, &crossing, NO_LIMIT); }
        if (event != INTERFACE) { continue; }
        // The path that a picture follows first: refraction, or reflection where that is total.
        let split = split_at(crossing);
        interfaces += 1u;
        walk.transmittance *= select(vec3f(1.0 - split.reflectance), reflection_at(walk.x).rgb, split.total);
        if (SHARP) {
            if (split.total) { redirect(&walk, split.reflected, crossing.n_i); } else { pass_through(&walk, crossing, split.refracted); }
        }
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

fn trace_sharp(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    let start = (*walk).x;
    let event = march_sharp(walk, crossing);
    if (!is_graded((*walk).region)) { gather_straight(walk, start, distance(start, (*walk).x)); }
    return event;
}
