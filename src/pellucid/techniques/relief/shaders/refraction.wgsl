// Where a ray goes within the translucent matter.
//!import optics/snell
//!import techniques/relief/shaders/search

override RELIEF_REFRACTION: u32 = 0u;  // 0 search, 1 a plane as deep as the layer is where the ray enters

const RELIEF_INWARDS = 1e-3;  // share of the depth by which a ray begins below the surface it came through

const RELIEF_LEGS = 2u;           // straight pieces between total reflections that are followed

struct Refracted {
    uv: vec2f,
    p_ws: vec3f,
    direction_ws: vec3f,  // of the ray when it ends
    path_m: f32,
    solid: bool,          // whether it ended on the solid layer, else it has left
}

fn relief_refracted(frame_at: ReliefFrame, uv: vec2f, p_ws: vec3f, h: f32, direction_ws: vec3f, n: f32) -> Refracted {
    let both = relief_heights(uv);
    let start = mix(min(h, both.y), both.x, RELIEF_INWARDS);
    var ray = relief_ray(frame_at, uv, start, direction_ws);
    if RELIEF_REFRACTION == 1u {
        let t = (both.x - h) / min(ray.dh, -1e-3);
        return Refracted(uv + t * ray.duv, p_ws + t * direction_ws, direction_ws, t, true);
    }
    var at = Refracted(uv, p_ws, direction_ws, 0.0, true);
    for (var k = 0u; k < RELIEF_LEGS; k++) {
        let hit = relief_leave(ray, relief_reach(ray));
        at.uv = ray.uv + hit.t * ray.duv;
        at.p_ws += hit.t * at.direction_ws;
        at.path_m += hit.t;
        at.solid = hit.layer == RELIEF_SOLID;
        if hit.layer != RELIEF_TRANSLUCENT {
            return at;  // on the solid layer, or through a wall
        }
        let n_ws = -relief_normal(frame_at, at.uv, relief_translucent_slopes(at.uv, 0.0));
        let out = refract(at.direction_ws, n_ws, n, relief.n_outside);
        if out.valid && dot(at.direction_ws, n_ws) < 0.0 {
            at.direction_ws = out.direction;
            return at;
        }
        let there = relief_heights(at.uv);
        at.direction_ws = reflect(at.direction_ws, n_ws);
        ray = relief_ray(frame_at, at.uv, mix(there.y, there.x, RELIEF_INWARDS), at.direction_ws);
    }
    at.solid = true;  // thrown back once more: it ends on what is below
    return at;
}
