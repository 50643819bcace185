// Where a ray meets an axis-aligned box centred on the origin.

// (near, far) distances along the ray; near > far where it misses [kay1986].
fn intersect_box(x: vec3f, d: vec3f, half_extent: vec3f) -> vec2f {
    let safe = select(d, vec3f(1e-20), abs(d) < vec3f(1e-20));
    let middle = -x / safe;
    let reach = abs(half_extent / safe);
    let near = middle - reach;
    let far = middle + reach;
    return vec2f(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}
