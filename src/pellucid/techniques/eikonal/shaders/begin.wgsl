// The camera ray of every pixel, sent to the body that it meets first.

//!import surroundings/shaders/camera
//!import techniques/eikonal/shaders/looks
//!import techniques/eikonal/shaders/meeting

@group(0) @binding(9) var<storage, read_write> drawn: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let at = pixel_of(group.xy, lane);
    if (any(at >= draw.size)) { return; }
    let pixel = at.y * draw.size.x + at.x;
    let ray = camera_ray(vec2f(draw.corner + at) + 0.5);
    let meeting = next_body(ray.origin, ray.direction, NOBODY);
    let meets = meeting.body != NOBODY;
    drawn[pixel] = vec4f(0.0, 0.0, 0.0, UNSEEN);
    // The first plane is in use, by this ray
    look_values[pixel] = select(vec4f(0.0), vec4f(1.0), meets);
    if (!meets) { return; }
    look_rays[pixel] = LookRay(ray.origin, LOOK_ALONG | RAY_UNTOUCHED | RAY_ENTERS, ray.direction, meeting.body, vec3f(0.0), 0.0);
    list_pixel(meeting.body, pixel, draw.size.x * draw.size.y);
}
