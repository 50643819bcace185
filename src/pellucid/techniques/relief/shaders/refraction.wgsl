// Where a ray goes that has entered the translucent matter.
//!import optics/snell
//!import techniques/relief/shaders/looks
//!import techniques/relief/shaders/search

override RELIEF_REFRACTION: u32 = 0u;  // 0 search, 1 a plane as deep as the layer is where the ray enters
override RELIEF_PIECES: u32 = 4u;      // straight pieces of the ray that are followed, within the matter and over it

const RELIEF_INWARDS = 1e-3;  // share of the depth by which a ray begins off the surface that it came through

struct Refracted {
    uv: vec2f,
    p_ws: vec3f,
    direction_ws: vec3f,  // of the ray when it ends
    path_m: f32,          // within the matter
    solid: bool,          // whether it ended on the solid layer, else it has left the relief
    wet: bool,            // whether it ended within the matter
}

fn relief_refracted(frame_at: ReliefFrame, uv: vec2f, p_ws: vec3f, h: f32, direction_ws: vec3f, n: f32) -> Refracted {
    let both = relief_heights(uv);
    let start = mix(min(h, both.y), both.x, RELIEF_INWARDS);
    var ray = relief_ray(frame_at, uv, start, direction_ws);
    if RELIEF_REFRACTION == 1u {
        let t = (both.x - h) / min(ray.dh, -1e-3);
        return Refracted(uv + t * ray.duv, p_ws + t * direction_ws, direction_ws, t, true, true);
    }
    var at = Refracted(uv, p_ws, direction_ws, 0.0, true, true);
    for (var k = 0u; k < RELIEF_PIECES; k++) {
        let reach = relief_reach(ray);
        let hit = relief_onwards(ray, reach, at.wet);
        let cut_ws = relief_cut(frame_at, ray, reach);
        let h_there = relief_height_along(ray, hit.t);
        at.uv = ray.uv + hit.t * ray.duv;
        at.p_ws += hit.t * at.direction_ws;
        at.path_m += select(0.0, hit.t, at.wet);
        at.solid = hit.layer == RELIEF_SOLID;
        let leaves = hit.layer == RELIEF_NONE && (!at.wet || all(cut_ws == vec3f(0.0)));
        if at.solid || leaves {
            return at;
        }
        // At an interface: the upper surface, from within or from above, or the cut at an open border
        let upper_ws = relief_normal(frame_at, at.uv, relief_translucent_slopes(at.uv, 0.0));
        let n_ws = select(upper_ws, cut_ws, hit.layer == RELIEF_NONE);
        let towards_ws = relief_towards(select(n_ws, -n_ws, at.wet), at.direction_ws);
        let out = relief_across(at.direction_ws, towards_ws, at.wet, n);
        at.direction_ws = select(reflect(at.direction_ws, towards_ws), out.direction, out.valid);
        at.wet = at.wet != out.valid;
        let there = relief_heights(at.uv);
        let off = RELIEF_INWARDS * (there.y - there.x);
        let on_upper = there.y + select(off, -off, at.wet);
        ray = relief_ray(frame_at, at.uv, select(on_upper, h_there, hit.layer == RELIEF_NONE), at.direction_ws);
    }
    at.solid = at.wet || ray.dh < 0.0;  // followed no further: it ends on what is below
    return at;
}

// Into the surroundings, or from there into the matter
fn relief_across(direction_ws: vec3f, n_ws: vec3f, is_inside: bool, n: f32) -> RefractResult {
    let from_n = select(relief.n_outside, n, is_inside);
    return refract(direction_ws, n_ws, from_n, select(n, relief.n_outside, is_inside));
}

// Outward unit normal of the open border that ends a ray's reach; zero where none does
fn relief_cut(frame_at: ReliefFrame, ray: ReliefRay, reach: f32) -> vec3f {
    let t = relief_clips(ray);
    let along = select(frame_at.B_dual * sign(ray.duv.y), frame_at.T_dual * sign(ray.duv.x), t.x < t.y);
    return select(vec3f(0.0), normalize(along), max(min(t.x, t.y), 0.0) <= reach);
}
