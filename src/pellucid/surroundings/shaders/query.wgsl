// Ask the surroundings about many rays at once; one invocation a ray.
//!import surroundings/shaders/radiance
//!struct QueryRay from surroundings.layouts
//!struct QueryHit from surroundings.layouts

@group(0) @binding(0) var<storage, read> query_rays: array<QueryRay>;
@group(0) @binding(1) var<storage, read_write> query_hits: array<QueryHit>;

@compute @workgroup_size(64)
fn hits(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_rays) {
        return;
    }
    let ray = query_rays[id.x];
    let hit = trace_opaque(ray.origin, ray.direction, ray.t_max);
    let blocked = occluded(ray.origin, ray.direction, ray.t_max);
    query_hits[id.x].value = vec3f(hit.barycentric, depth_of(ray.origin + ray.direction * hit.t));
    query_hits[id.x].t = hit.t;
    query_hits[id.x].valid = u32(hit.valid);
    query_hits[id.x].triangle = hit.triangle;
    query_hits[id.x].blocked = u32(blocked);
}

@compute @workgroup_size(64)
fn radiance(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_rays) {
        return;
    }
    query_hits[id.x].value = radiance_along(query_rays[id.x].origin, query_rays[id.x].direction);
}

@compute @workgroup_size(64)
fn environment(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_rays) {
        return;
    }
    let direction = query_rays[id.x].direction;
    query_hits[id.x].value = environment_radiance_blurred(direction, query_rays[id.x].t_max);
}

@compute @workgroup_size(64)
fn irradiance(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_rays) {
        return;
    }
    query_hits[id.x].value = environment_irradiance(query_rays[id.x].direction);
}

// Rays of the camera through every pixel centre, row by row from the upper left
@compute @workgroup_size(64)
fn camera(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&query_hits) {
        return;
    }
    let width = u32(frame.size.x);
    let ray = camera_ray(vec2f(f32(id.x % width), f32(id.x / width)) + 0.5);
    query_hits[id.x].value = ray.origin;
    query_hits[id.x].direction = ray.direction;
}
