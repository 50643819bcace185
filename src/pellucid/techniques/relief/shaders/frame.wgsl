// The frame of a relief at a place: how directions of the world become tiles and heights.
//!import techniques/relief/shaders/bindings

const RELIEF_VERTEX_TEXELS = 5u;  // layouts.VERTEX_TEXELS
const RELIEF_FLAT = 1e-5;  // 1/m; what bends less counts as flat

struct ReliefFrame {
    p_ws: vec3f,       // where the ray begins, height included
    uv: vec2f,
    h: f32,            // metres over the polygon
    T: vec3f,          // world metres a tile, at this height
    B: vec3f,
    N: vec3f,          // unit
    T_dual: vec3f,     // T_dual . T = 1, T_dual . B = T_dual . N = 0
    B_dual: vec3f,
    form: vec3f,       // second fundamental form, metres a tile^2
    wall_ws: vec3f,    // outward unit normal of an open border, else zero
}

struct ReliefRay {     // at t world metres: uv + t duv, h + t dh + bend t^2
    uv: vec2f,
    h: f32,
    duv: vec2f,
    dh: f32,
    bend: f32,
}

// A point of a layer, for light that arrives there
struct ReliefPoint {
    uv: vec2f,
    h: f32,
    p_ws: vec3f,
    n_ws: vec3f,       // unit normal of the layer
    frame: ReliefFrame,
    is_cut: bool,      // on the cut at an open border, not on the layer's surface
}

// A corner of the hull, from its texels: a software driver reads buffers at places that differ one by one
fn relief_vertex(index: u32) -> ReliefVertex {
    let across = textureDimensions(relief_vertices).x;
    let first = index * RELIEF_VERTEX_TEXELS;
    let at = vec2u(first % across, first / across);
    let p = textureLoad(relief_vertices, at, 0);
    let n = textureLoad(relief_vertices, at + vec2u(1u, 0u), 0);
    let tangent = textureLoad(relief_vertices, at + vec2u(2u, 0u), 0);
    let bitangent = textureLoad(relief_vertices, at + vec2u(3u, 0u), 0);
    let curvature = textureLoad(relief_vertices, at + vec2u(4u, 0u), 0).xyz;
    return ReliefVertex(p.xyz, p.w, n.xyz, n.w, tangent.xyz, tangent.w, bitangent.xyz, bitangent.w, curvature);
}

fn relief_vertex_ws(corner: ReliefVertex) -> vec3f {
    let at = corner.position + relief_level_height(corner.level) * corner.normal;
    return (relief.world_from_object * vec4f(at, 1.0)).xyz;
}

fn relief_level_height(level: f32) -> f32 {
    return mix(relief.hull_low, relief.hull_high, level);
}

// The frame where weights (b.x, b.y) of the second and third corner lie on a triangle of the hull
fn relief_frame(triangle: u32, b: vec2f) -> ReliefFrame {
    let k = 3u * triangle;
    let w = vec3f(1.0 - b.x - b.y, b);
    let a0 = relief_vertex(k);
    let a1 = relief_vertex(k + 1u);
    let a2 = relief_vertex(k + 2u);
    let corners = mat3x3f(relief_vertex_ws(a0), relief_vertex_ws(a1), relief_vertex_ws(a2));
    let turn = mat3x3f(relief.world_from_object[0].xyz, relief.world_from_object[1].xyz, relief.world_from_object[2].xyz);
    let n = normalize(turn * (w.x * a0.normal + w.y * a1.normal + w.z * a2.normal));
    let tangent = turn * (w.x * a0.tangent + w.y * a1.tangent + w.z * a2.tangent);
    let bitangent = turn * (w.x * a0.bitangent + w.y * a1.bitangent + w.z * a2.bitangent);
    let form = w.x * a0.curvature + w.y * a1.curvature + w.z * a2.curvature;
    let h = relief_level_height(dot(w, vec3f(a0.level, a1.level, a2.level)));
    let uv = w.x * vec2f(a0.u, a0.v) + w.y * vec2f(a1.u, a1.v) + w.z * vec2f(a2.u, a2.v);
    var wall = vec3f(0.0);
    if a0.wall > 0.5 {
        wall = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    }
    return relief_frame_at_height(corners * w, uv, h, tangent, bitangent, n, form, wall);
}

// P + h N has the derivatives T + h dN/du and B + h dN/dv
fn relief_frame_at_height(
    p_ws: vec3f, uv: vec2f, h: f32, tangent: vec3f, bitangent: vec3f, n: vec3f, form: vec3f, wall_ws: vec3f
) -> ReliefFrame {
    let t_flat = tangent - n * dot(n, tangent);
    let b_flat = bitangent - n * dot(n, bitangent);
    let base = relief_duals(t_flat, b_flat, n);
    let n_u = form.x * base[0] + form.y * base[1];
    let n_v = form.y * base[0] + form.z * base[1];
    let t_high = t_flat + h * n_u;
    let b_high = b_flat + h * n_v;
    let duals = relief_duals(t_high, b_high, n);
    let form_high = vec3f(dot(n_u, t_high), dot(n_u, b_high), dot(n_v, b_high));
    return ReliefFrame(p_ws, uv, h, t_high, b_high, n, duals[0], duals[1], form_high, wall_ws);
}

// Two vectors of the plane that measure along a and along b; n is its unit normal
fn relief_duals(a: vec3f, b: vec3f, n: vec3f) -> mat2x3f {
    let area = dot(cross(a, b), n);
    let least = 1e-12 + 1e-4 * max(dot(a, a), dot(b, b));  // tiles shrink to nothing at a pole
    let safe = select(min(area, -least), max(area, least), area >= 0.0);
    return mat2x3f(cross(b, n) / safe, cross(n, a) / safe);
}

// The ray that leaves a place (uv, h) of a frame in a unit direction of the world
fn relief_ray(frame_at: ReliefFrame, uv: vec2f, h: f32, direction_ws: vec3f) -> ReliefRay {
    let duv = vec2f(dot(frame_at.T_dual, direction_ws), dot(frame_at.B_dual, direction_ws));
    let form = frame_at.form;
    let bend = 0.5 * relief.silhouettes * (form.x * duv.x * duv.x + 2.0 * form.y * duv.x * duv.y + form.z * duv.y * duv.y);
    let dh = dot(frame_at.N, direction_ws);
    return ReliefRay(uv, h, duv, dh, relief_round_bend(bend, dh, h - relief.hull_low));
}

// Over a ball of radius r, heights are sqrt(r^2 + 2 r dh t + t^2) - r, and no parabola. The one that is taken keeps the
// slope at the start, and ends right: at the lowest height of the relief, `depth` below, or else at the closest
// approach, so that outlines are right.
fn relief_round_bend(bend: f32, dh: f32, depth: f32) -> f32 {
    if bend < RELIEF_FLAT || dh >= 0.0 || depth <= 0.0 {
        return bend;
    }
    let tangential_2 = max(1.0 - dh * dh, 0.0);
    let radius = tangential_2 / (2.0 * bend);
    let under = dh * dh - depth / radius * (2.0 - depth / radius);
    if under < 0.0 || depth > radius {
        return (1.0 + sqrt(tangential_2)) / (4.0 * radius);
    }
    let t = depth * (2.0 - depth / radius) / (sqrt(under) - dh);
    return max((-depth - dh * t) / (t * t), 0.0);
}

fn relief_height_along(ray: ReliefRay, t: f32) -> f32 {
    return ray.h + t * (ray.dh + ray.bend * t);
}

// The unit normal N at another place of a frame, on the curved mesh
fn relief_normal_at(frame_at: ReliefFrame, uv: vec2f) -> vec3f {
    let d = uv - frame_at.uv;
    let along = (frame_at.form.x * d.x + frame_at.form.y * d.y) * frame_at.T_dual;
    let across = (frame_at.form.y * d.x + frame_at.form.z * d.y) * frame_at.B_dual;
    return normalize(frame_at.N + along + across);
}

// Normal of a height field whose slopes (metres a metre of the nominal tile) are given, unit, world
fn relief_normal(frame_at: ReliefFrame, uv: vec2f, slopes: vec2f) -> vec3f {
    let s = slopes * relief.tile_m;
    return normalize(relief_normal_at(frame_at, uv) - s.x * frame_at.T_dual - s.y * frame_at.B_dual);
}
