// Light that comes from other bodies begins on the box of this one: one invocation for each bundle under way.

//!import techniques/eikonal/shaders/light_enter
//!import techniques/eikonal/shaders/box
//!import surroundings/shaders/bundles
//!struct LookCount from surroundings.layouts

@group(0) @binding(29) var<storage, read> arrivals: array<OutPatch>;
@group(0) @binding(30) var<storage, read> arrivals_queue: LookCount;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= arrivals_queue.count) { return; }
    let bundle = arrivals[id.x];
    if (bundle.body != volume.body) { return; }
    for (var k = 0u; k < 4u; k++) { arrive_corner(k, bundle_corner(bundle, k), bundle_way(bundle, k)); }
    var begun = LightPatch();
    begun.touched = select(UNTOUCHED, TOUCHED, bundle.kind == OUT_CAUSTIC);
    begun.level = bundle.level;
    begun.begun = bundle.begun;
    begun.is_ray = bundle.is_ray;
    begun.breadth = bundle.breadth / volume.scale;
    enter(bundle.flux, begun);
}

// Bring a corner to the box, straight on.
fn arrive_corner(k: u32, origin_ws: vec3f, way_ws: vec3f) {
    let x = (volume.object_from_world * vec4f(origin_ws, 1.0)).xyz - light.box_center;
    let d = normalize((volume.object_from_world * vec4f(way_ws, 0.0)).xyz);
    let on_box = x + max(intersect_box(x, d, light.box_half).x, 0.0) * d;
    corner_x[k] = light.box_center + clamp(on_box, -light.box_half, light.box_half);
    corner_p[k] = d;
}
