// Facets of a GGX surface in proportion to how much of them a viewer sees.

// Unit vectors across a normal [duff2017]
fn frame_about(n: vec3f) -> mat3x3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return mat3x3f(vec3f(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3f(b, s + n.y * n.y * a, -n.y), n);
}

// The normal of a facet, by two numbers in 0..1 [dupuy2023]
fn visible_normal(n: vec3f, v: vec3f, alpha: f32, u: vec2f) -> vec3f {
    let axes = frame_about(n);
    let local = v * axes;
    let stretched = normalize(vec3f(alpha * local.xy, max(local.z, 1e-4)));
    let turn = 6.28318531 * u.x;
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let side = sqrt(saturate(1.0 - z * z));
    let h = vec3f(side * cos(turn), side * sin(turn), z) + stretched;
    return axes * normalize(vec3f(alpha * h.xy, max(h.z, 1e-6)));
}

// Density of those normals, 1/sr: G1 (v.h) D / (n.v) [heitz2018, eq. 3]
fn visible_normal_density(n: vec3f, v: vec3f, h: vec3f, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let off = cross(n, h);
    let d = a2 + (1.0 - a2) * dot(off, off);
    let n_dot_v = max(dot(n, v), 1e-4);
    let masking = 2.0 / (n_dot_v + sqrt(a2 + (1.0 - a2) * n_dot_v * n_dot_v));
    return masking * max(dot(v, h), 0.0) * a2 / (3.14159265 * d * d);
}
