// Which other body light meets on its way from one.

//!import techniques/eikonal/shaders/box
//!struct OtherBodies from techniques.eikonal.layouts

const NOBODY = 0xffffffffu;
const MOST_OTHERS = 15u;      // layouts.MOST_OTHERS
const TOUCHING = 1e-4;        // of the half diagonal of a box: shorter ways through it are none

@group(0) @binding(28) var<uniform> others: OtherBodies;

struct BodyAhead {
    body: u32,
    distance: f32,            // world metres
}

// The nearest within `reach` world metres. A ray that begins in a box meets it at once.
fn body_ahead(origin_ws: vec3f, direction_ws: vec3f, reach: f32) -> BodyAhead {
    var ahead = BodyAhead(NOBODY, reach);
    // Up to the first box of no size, not up to `count`: as in light_count of lights.wgsl
    for (var k = 0u; k < MOST_OTHERS && others.half[k].x > 0.0; k++) {
        let x = (others.object_from_world[k] * vec4f(origin_ws, 1.0)).xyz - others.center[k].xyz;
        let d = normalize((others.object_from_world[k] * vec4f(direction_ws, 0.0)).xyz);
        let half = others.half[k].xyz;
        let span = intersect_box(x, d, half);
        let near = max(span.x, 0.0);
        let distance = near * others.center[k].w;
        if (span.y - near > TOUCHING * length(half) && distance < ahead.distance) {
            ahead = BodyAhead(others.number[k].x, distance);
        }
    }
    return ahead;
}
