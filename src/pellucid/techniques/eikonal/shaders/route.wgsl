// Where the rays go that have left a body: into another one, or into the list of those that look around.

//!import surroundings/shaders/raycast
//!import techniques/eikonal/shaders/looks
//!import techniques/eikonal/shaders/meeting

override HAS_MESHES: bool = true;

@group(0) @binding(16) var<storage, read> waiting: FinishedList;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= waiting.heads[0].count) { return; }
    let slot = waiting.slots[id.x];
    let ray = look_rays[slot];
    var meeting = Meeting(NOBODY, 0.0);
    if ((ray.kind & LOOK_KIND) == LOOK_ALONG) { meeting = next_body(ray.origin, ray.direction, ray.body); }
    // A mesh before an untouched ray has been drawn: its depth is asked for where the ray enters.
    if (HAS_MESHES && meeting.body != NOBODY && (ray.kind & RAY_UNTOUCHED) == 0u) {
        if (trace_opaque(ray.origin, ray.direction, meeting.distance).valid) { meeting.body = NOBODY; }
    }
    if (meeting.body != NOBODY) {
        look_rays[slot].kind = ray.kind | RAY_ENTERS;
        look_rays[slot].body = meeting.body;
        let pixels = draw.size.x * draw.size.y;
        list_pixel(meeting.body, slot % pixels, pixels);
    } else if ((ray.kind & RAY_UNTOUCHED) == 0u) {
        put_in(select(0u, 1u, (ray.kind & LOOK_KIND) >= LOOK_GLINT), slot);
    }
}
