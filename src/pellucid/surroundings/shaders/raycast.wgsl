// Rays against the opaque triangles, through the hierarchy of bvh.py, nearer child first.
//!import surroundings/shaders/bindings

const BVH_STACK = 32u;  // bvh.MAX_DEPTH + 2
const BVH_MISS = 3.0e38;

struct SurfaceHit {
    t: f32,              // in lengths of the direction; t_max where nothing is hit
    valid: bool,
    triangle: u32,
    barycentric: vec2f,  // weights of the second and third corner
}

// No triangles: the root is no leaf, and yet its second child would be itself. Asked of the nodes, for the reason of light_count in
// lights.wgsl.
fn bvh_is_empty() -> bool {
    return bvh_nodes[0].link == 0u && bvh_nodes[0].count == 0u;
}

// Nearest opaque surface with 0 < t < t_max that can be seen
fn trace_opaque(origin_ws: vec3f, direction_ws: vec3f, t_max: f32) -> SurfaceHit {
    return nearest_surface(origin_ws, direction_ws, t_max, true);
}

// Nearest opaque surface with 0 < t < t_max; `cull` lets a ray pass the back of what is single-sided, as light does not
fn nearest_surface(origin_ws: vec3f, direction_ws: vec3f, t_max: f32, cull: bool) -> SurfaceHit {
    return nearest_below(0u, origin_ws, direction_ws, t_max, cull);
}

// The same of the triangles below one node
fn nearest_below(root: u32, origin_ws: vec3f, direction_ws: vec3f, t_max: f32, cull: bool) -> SurfaceHit {
    var hit = SurfaceHit(t_max, false, 0u, vec2f(0.0));
    if root == 0u && bvh_is_empty() {
        return hit;
    }
    let inverse = bvh_inverse(direction_ws);
    var stack: array<u32, BVH_STACK>;
    var top = 0u;
    var index = root;
    if bvh_entry(root, origin_ws, inverse, t_max) == BVH_MISS {
        return hit;
    }
    loop {
        let link = bvh_nodes[index].link;
        let count = bvh_nodes[index].count;
        if count == 0u {
            let t_left = bvh_entry(index + 1u, origin_ws, inverse, hit.t);
            let t_right = bvh_entry(link, origin_ws, inverse, hit.t);
            let left_first = t_left <= t_right;
            if max(t_left, t_right) < BVH_MISS {
                stack[top] = select(index + 1u, link, left_first);
                top += 1u;
            }
            if min(t_left, t_right) < BVH_MISS {
                index = select(link, index + 1u, left_first);
                continue;
            }
        }
        for (var k = link; k < link + count; k++) {
            let found = triangle_entry(k, origin_ws, direction_ws, cull);
            if found.x > 0.0 && found.x < hit.t {
                hit = SurfaceHit(found.x, true, k, found.yz);
            }
        }
        if top == 0u {
            break;
        }
        top -= 1u;
        index = stack[top];
    }
    return hit;
}

// Whether any opaque surface, from either side, lies at 0 < t < t_max
fn occluded(origin_ws: vec3f, direction_ws: vec3f, t_max: f32) -> bool {
    if bvh_is_empty() {
        return false;
    }
    let inverse = bvh_inverse(direction_ws);
    var stack: array<u32, BVH_STACK>;
    var top = 0u;
    var index = 0u;
    loop {
        let link = bvh_nodes[index].link;
        let count = bvh_nodes[index].count;
        if count == 0u {
            let left = bvh_entry(index + 1u, origin_ws, inverse, t_max) < BVH_MISS;
            let right = bvh_entry(link, origin_ws, inverse, t_max) < BVH_MISS;
            if left && right {
                stack[top] = link;
                top += 1u;
            }
            if left || right {
                index = select(link, index + 1u, left);
                continue;
            }
        }
        for (var k = link; k < link + count; k++) {
            let t = triangle_entry(k, origin_ws, direction_ws, false).x;
            if t > 0.0 && t < t_max {
                return true;
            }
        }
        if top == 0u {
            break;
        }
        top -= 1u;
        index = stack[top];
    }
    return false;
}

// Reciprocal direction without infinities, whose products with zero would be undefined
fn bvh_inverse(direction: vec3f) -> vec3f {
    let tiny = vec3f(1e-20);
    let safe = select(direction, select(-tiny, tiny, direction >= vec3f(0.0)), abs(direction) < tiny);
    return 1.0 / safe;
}

// Distance at which a ray enters a node's box, or BVH_MISS; the exit is widened by two roundings [ize2013, sec. 3.2]
fn bvh_entry(index: u32, origin: vec3f, inverse: vec3f, t_max: f32) -> f32 {
    let a = (bvh_nodes[index].lower - origin) * inverse;
    let b = (bvh_nodes[index].upper - origin) * inverse;
    let low = min(a, b);
    let high = max(a, b);
    let t_in = max(max(low.x, low.y), max(low.z, 0.0));
    let t_out = min(min(high.x, high.y), min(high.z, t_max)) * 1.0000004;
    return select(BVH_MISS, t_in, t_in <= t_out);
}

// Where a ray meets a triangle: (t, u, v), t negative for none
fn triangle_entry(index: u32, origin: vec3f, direction: vec3f, cull: bool) -> vec3f {
    let found = triangle_plane_entry(index, origin, direction);
    let culled = cull && found.w < 0.0 && bvh_triangles[index].single_sided != 0u;
    let inside = found.y >= 0.0 && found.z >= 0.0 && found.y + found.z <= 1.0;
    return select(vec3f(-1.0), found.xyz, inside && !culled && found.w != 0.0);
}

// Where a ray meets a triangle's plane: (t, u, v, determinant) [moller1997, eq. 6]
fn triangle_plane_entry(index: u32, origin: vec3f, direction: vec3f) -> vec4f {
    let corner = bvh_triangles[index].corner_0;
    let e1 = bvh_triangles[index].corner_1 - corner;
    let e2 = bvh_triangles[index].corner_2 - corner;
    let p = cross(direction, e2);
    let determinant = dot(e1, p);
    let q = cross(origin - corner, e1);
    let scaled = vec3f(dot(e2, q), dot(origin - corner, p), dot(direction, q));
    return vec4f(scaled / select(determinant, 1.0, determinant == 0.0), determinant);
}
