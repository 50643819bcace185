// Which body a ray meets next, and the lists of pixels whose rays enter each body.

//!import techniques/eikonal/shaders/box
//!import techniques/eikonal/shaders/pixels
//!struct BodyBox from techniques.eikonal.layouts

const NOBODY = 0xffffffffu;

@group(0) @binding(14) var<storage, read> body_boxes: array<BodyBox>;
@group(0) @binding(15) var<storage, read_write> body_lists: array<atomic<u32>>;

struct Meeting {
    body: u32,
    distance: f32,      // world metres
}

// The nearest body, but for the one that the ray has left: out of a box there is no straight way back in.
fn next_body(origin_ws: vec3f, direction_ws: vec3f, left: u32) -> Meeting {
    var next = Meeting(NOBODY, 1e30);
    for (var k = 0u; k < arrayLength(&body_boxes); k++) {
        let x = (body_boxes[k].object_from_world * vec4f(origin_ws, 1.0)).xyz - body_boxes[k].center;
        let d = normalize((body_boxes[k].object_from_world * vec4f(direction_ws, 0.0)).xyz);
        let span = intersect_box(x, d, body_boxes[k].half);
        let distance = max(span.x, 0.0) * body_boxes[k].scale;
        if (k != left && span.x < span.y && span.y > 0.0 && distance < next.distance) { next = Meeting(k, distance); }
    }
    return next;
}

// A pixel is listed once for a body, however many of its rays go there.
fn list_pixel(body: u32, pixel: u32, pixels: u32) {
    let bodies = arrayLength(&body_boxes);
    let bit = 1u << (body % 32u);
    let marks = 4u * bodies + pixel * mark_words(bodies) + body / 32u;
    if ((atomicOr(&body_lists[marks], bit) & bit) != 0u) { return; }
    let place = atomicAdd(&body_lists[4u * body + 3u], 1u);
    atomicMax(&body_lists[4u * body], place / 64u + 1u);
    atomicStore(&body_lists[list_start(body, bodies, pixels) + place], pixel);
}
