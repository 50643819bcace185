// The proxy of a volume: the box in which rays are followed.

//!import techniques/eikonal/shaders/bindings
//!import techniques/eikonal/shaders/box

// (near, far) distances along a ray; near > far where it misses.
fn proxy_span(x: vec3f, d: vec3f) -> vec2f {
    return intersect_box(x - volume.proxy_center, d, volume.proxy_half);
}

// Distance to the nearest face from inside, object metres.
fn proxy_clearance(x: vec3f) -> f32 {
    let inside = volume.proxy_half - abs(x - volume.proxy_center);
    return min(inside.x, min(inside.y, inside.z));
}
