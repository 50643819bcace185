// Where rays of the picture begin: a convex body around the matter of a volume, within its proxy box (hulls.py).

//!import techniques/eikonal/shaders/proxy

override PROXY: u32 = 0u;   // BY_SPHERE, BY_PLANES, or 0 for the box alone

const BY_SPHERE = 1u;
const BY_PLANES = 2u;

// (near, far) distances along a ray, d unit; near > far where it misses.
fn hull_span(x: vec3f, d: vec3f) -> vec2f {
    var span = proxy_span(x, d);
    if (PROXY == BY_SPHERE) {
        let to = volume.proxy_sphere.xyz - x;
        let along = dot(to, d);
        let off = to - along * d;
        let square = volume.proxy_sphere.w * volume.proxy_sphere.w - dot(off, off);
        let half_chord = sqrt(max(square, 0.0));
        span = vec2f(max(span.x, along - half_chord), min(span.y, along + half_chord));
        if (square < 0.0) { span = vec2f(1.0, -1.0); }
    }
    if (PROXY == BY_PLANES) {
        for (var k = 0u; k < volume.proxy_plane_count; k++) {
            let plane = volume.proxy_planes[k];
            let room = plane.w - dot(plane.xyz, x);
            let rate = dot(plane.xyz, d);
            let t = room / select(rate, 1e-20, abs(rate) < 1e-20);
            if (rate < 0.0) { span.x = max(span.x, t); } else { span.y = min(span.y, t); }
        }
    }
    return span;
}
