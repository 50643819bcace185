// The space that water fills.
//!import techniques/water/shaders/outline
//!import techniques/water/shaders/waves

const WATER_FAR = 1e30;

// Way along a ray to the borders: in, out; out < in where it passes
fn water_sides(origin_ws: vec3f, direction_ws: vec3f) -> vec2f {
    if WATER_OUTLINE > 0u {
        let way = outline_way(origin_ws, direction_ws);
        return vec2f(way.near, way.far);
    }
    let tiny = vec2f(1e-20);
    let d = select(direction_ws.xz, select(-tiny, tiny, direction_ws.xz >= vec2f(0.0)), abs(direction_ws.xz) < tiny);
    let a = (water.low - origin_ws.xz) / d;
    let b = (water.high - origin_ws.xz) / d;
    let low = min(a, b);
    let high = max(a, b);
    return vec2f(max(low.x, low.y), min(high.x, high.y));
}

// Metres that a ray stays in the water, which ends at its sides and where no wave reaches
fn water_way(p_ws: vec3f, direction_ws: vec3f) -> f32 {
    let up = (water.level + water.wave_high - p_ws.y) / max(direction_ws.y, 1e-20);
    return max(min(water_sides(p_ws, direction_ws).y, select(WATER_FAR, up, direction_ws.y > 0.0)), 0.0);
}

// What stands at the borders, such as the walls of a pool, counts as within
const WATER_MARGIN = 1e-4;  // of the rectangle

// Whether a point is in the water but for the waves over it: within the rectangle, borders included
fn water_reaches(p_ws: vec3f) -> bool {
    let margin = WATER_MARGIN * (water.high - water.low);
    return all(p_ws.xz > water.low - margin) && all(p_ws.xz < water.high + margin);
}
