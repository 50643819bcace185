// Where a ray of the camera meets a relief, from where it enters the hull.
//!import techniques/relief/shaders/search

override RELIEF_DEPTH: u32 = 2u;  // 0 the polygon itself, 1 the polygon with shifted coordinates, 2 search

fn relief_enter(frame_at: ReliefFrame, ray: ReliefRay) -> ReliefHit {
    if RELIEF_DEPTH != 2u {
        return ReliefHit(0.0, RELIEF_SOLID);
    }
    if any(frame_at.wall_ws != vec3f(0.0)) {
        let both = relief_heights(ray.uv);
        if ray.h <= both.x {
            return ReliefHit(0.0, RELIEF_SOLID);
        }
        if ray.h < both.y {
            return ReliefHit(0.0, RELIEF_TRANSLUCENT);
        }
    }
    return relief_first(ray, relief_reach(ray));
}

// Texture coordinates moved against the view by the height there, with its offset limited [welsh2004, sec. 3.3]
fn relief_offset(frame_at: ReliefFrame, direction_ws: vec3f) -> vec2f {
    let towards = -vec2f(dot(frame_at.T_dual, direction_ws), dot(frame_at.B_dual, direction_ws));
    return frame_at.uv + relief_heights(frame_at.uv).x * towards;
}
