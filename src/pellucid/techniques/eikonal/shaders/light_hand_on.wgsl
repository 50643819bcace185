// Where the bundles go that have left a body: into another one, or to the meshes.

//!import surroundings/shaders/raycast
//!import surroundings/shaders/bundles
//!import techniques/eikonal/shaders/light_others
//!struct LightParams from techniques.eikonal.layouts
//!struct LookCount from surroundings.layouts

override HAS_MESHES: bool = true;

const OUT_CAUSTIC = 0u;
const OUT_BLOCKED = 1u;
const OUT_UNTOUCHED = 2u;
const PARTS = 4u;             // along each edge of a bundle whose rays go different ways
const LIST_GROUP = 64u;

struct BundleCount {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

const LANDING = 0u;
const ARRIVALS = 1u;

@group(0) @binding(20) var<uniform> light: LightParams;
@group(0) @binding(27) var<storage, read> outgoing: array<OutPatch>;
@group(0) @binding(29) var<storage, read> outgoing_queue: LookCount;
@group(0) @binding(30) var<storage, read_write> landing: array<OutPatch>;
@group(0) @binding(31) var<storage, read_write> arrivals: array<OutPatch>;
@group(0) @binding(32) var<storage, read_write> bundle_queues: array<BundleCount, 2>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= outgoing_queue.count) { return; }
    let bundle = outgoing[id.x];
    if (bundle.kind == OUT_BLOCKED || others.count == 0u) {
        hand_on(bundle, NOBODY);
        return;
    }
    let next = next_body(bundle, vec2f(0.5));
    var together = true;
    if (bundle.is_ray == 0u) {
        for (var k = 0u; k < 4u; k++) {
            together = together && next_body(bundle, vec2f(f32(k & 1u), f32(k >> 1u))) == next;
        }
    }
    if (together) {
        hand_on(bundle, next);
        return;
    }
    for (var k = 0u; k < PARTS * PARTS; k++) {
        let low = vec2f(f32(k % PARTS), f32(k / PARTS)) / f32(PARTS);
        let part_next = next_body(bundle, low + 0.5 / f32(PARTS));
        hand_on(part_of(bundle, low, part_next != NOBODY), part_next);
    }
}

fn next_body(bundle: OutPatch, st: vec2f) -> u32 {
    let origin_ws = bundle_point(bundle, st);
    let way_ws = bundle_direction(bundle, st);
    let ahead = body_ahead(origin_ws, way_ws, 1e30);
    if (!HAS_MESHES || ahead.body == NOBODY) { return ahead.body; }
    return select(ahead.body, NOBODY, occluded(origin_ws, way_ws, ahead.distance));
}

// A sixteenth of a bundle, start `low` on; the middle ray of it as all corners, since they may miss a box that it meets.
fn part_of(bundle: OutPatch, low: vec2f, as_ray: bool) -> OutPatch {
    let start = select(low, low + 0.5 / f32(PARTS), as_ray);
    let edge = select(1.0 / f32(PARTS), 0.0, as_ray);
    var part = bundle;
    part.corner_0 = bundle_point(bundle, start);
    part.corner_1 = bundle_point(bundle, start + vec2f(edge, 0.0));
    part.corner_2 = bundle_point(bundle, start + vec2f(0.0, edge));
    part.corner_3 = bundle_point(bundle, start + edge);
    part.way_0 = bundle_direction(bundle, start);
    part.way_1 = bundle_direction(bundle, start + vec2f(edge, 0.0));
    part.way_2 = bundle_direction(bundle, start + vec2f(0.0, edge));
    part.way_3 = bundle_direction(bundle, start + edge);
    part.flux = bundle.flux / f32(PARTS * PARTS);
    // As in `divide` of light_patches.wgsl
    let whole = bundle.kind == OUT_UNTOUCHED;
    part.level += select(4u, 0u, whole);
    part.begun /= select(1.0, f32(PARTS * PARTS), whole);
    part.is_ray = u32(as_ray);
    part.breadth = distance(bundle.corner_0, bundle.corner_3) / f32(PARTS);
    return part;
}

// What finds no room on the way to a body lands. Meshes have untouched light already.
fn hand_on(bundle: OutPatch, body: u32) {
    if (body != NOBODY) {
        let place = reserve(ARRIVALS, arrayLength(&arrivals));
        if (place < arrayLength(&arrivals)) {
            arrivals[place] = bundle;
            arrivals[place].body = body;
            return;
        }
    }
    if (bundle.kind > OUT_BLOCKED) { return; }
    let place = reserve(LANDING, arrayLength(&landing));
    if (place < arrayLength(&landing)) {
        landing[place] = bundle;
        landing[place].flux = light.weights * bundle.flux;
    }
}

// A place in a list, or its capacity. The count never passes what is written.
fn reserve(list: u32, capacity: u32) -> u32 {
    let place = atomicAdd(&bundle_queues[list].count, 1u);
    if (place >= capacity) {
        atomicMin(&bundle_queues[list].count, capacity);
        return capacity;
    }
    atomicMax(&bundle_queues[list].groups_x, place / LIST_GROUP + 1u);
    return place;
}
