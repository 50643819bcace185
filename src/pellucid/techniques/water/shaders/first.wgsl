// What a ray of the camera meets first of the water.
//!import techniques/water/shaders/hit
//!import techniques/water/shaders/surface

const FIND_COVER = 1e-5;  // what covers an open border lies this share of the way before it, or not at all

// What a ray of the camera meets first
fn water_first(origin_ws: vec3f, direction_ws: vec3f, t_max: f32) -> WaterHit {
    let up = vec3f(0.0, 1.0, 0.0);
    let own = outline_way(origin_ws, direction_ws);
    let sides = water_sides(origin_ws, direction_ws);
    let start = max(sides.x, 0.0);
    let end = min(sides.y, t_max);
    if start > end * (1.0 - FIND_COVER) {
        return WaterHit(WATER_NONE, 0.0, up);
    }
    let under = water_gap(origin_ws, direction_ws, start) < 0.0;
    if under && start > 0.0 {
        let cut = water_side_normal(origin_ws + start * direction_ws);
        return WaterHit(WATER_SIDE, start, select(cut, own.near_n, WATER_OUTLINE > 0u));
    }
    let found = water_crossing(origin_ws, direction_ws, start, end, select(1.0, -1.0, under));
    if found >= 0.0 {
        return WaterHit(select(WATER_ABOVE, WATER_BELOW, under), found, up);
    }
    if under && WATER_OUTLINE > 0u && sides.y < WATER_FAR {
        return WaterHit(select(WATER_RIM, WATER_FOG, t_max <= sides.y), end, own.far_n);
    }
    let holds = water_reaches(origin_ws + t_max * direction_ws);
    let within = WaterHit(select(WATER_OUT, WATER_FOG, holds), select(end, t_max, holds), up);
    if under {
        return within;
    }
    return WaterHit(WATER_NONE, 0.0, up);
}

// Out of the water, of the side that a point on the border is nearest to
fn water_side_normal(p_ws: vec3f) -> vec3f {
    let middle = 0.5 * (water.low + water.high);
    let away = (p_ws.xz - middle) / (water.high - water.low);
    let along_x = abs(away.x) > abs(away.y);
    return select(vec3f(0.0, 0.0, sign(away.y)), vec3f(sign(away.x), 0.0, 0.0), along_x);
}
