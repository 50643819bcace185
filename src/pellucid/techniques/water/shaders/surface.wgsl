// Where a ray meets the surface of water, from either side.
//!import techniques/water/shaders/body
//!import techniques/water/shaders/block

const MEET_STEPS = 192u;
const MEET_REFINEMENTS = 10u;
const MEET_ROUNDING = 2e-7;  // of the way: a gap that need not become less
const MEET_PIXELS = 0.5;  // crests that stand out by less may be passed

// Way to the first crossing, or -1. Steps are as long as the steepest slope of the waves allows, so that no crest is
// passed but one that stands out by less than half a pixel. A ray that starts in the surface itself takes a step first.
// One that goes on to where no wave is has crossed the surface, whatever rounding makes of that.
fn water_crossing(origin_ws: vec3f, direction_ws: vec3f, start: f32, end: f32, side: f32) -> f32 {
    let slab = water_slab(origin_ws.y - water.level, direction_ws.y);
    let last = min(end, slab.y);
    var t = max(start, slab.x);
    let steepness = abs(direction_ws.y) + water.wave_slope * length(direction_ws.xz) + 1e-9;
    let parallel = camera_is_orthographic();
    var gap = max(side * water_gap(origin_ws, direction_ws, t), 0.0);
    var t_before = t;
    var gap_before = gap;
    for (var k = 0u; k < MEET_STEPS && t < last && (gap > 0.0 || k == 0u); k++) {
        t_before = t;
        gap_before = gap;
        let pixel = f32(water.block.y) * frame.pixel_footprint * select(t, 1.0, parallel);
        let step = max(gap, MEET_PIXELS * pixel) / steepness;
        t = select(min(t + max(step, 1e-3 * water.wave_cell_m), last), last, k + 1u == MEET_STEPS);
        gap = side * water_gap(origin_ws, direction_ws, t);
    }
    let through = last == slab.y && side * direction_ws.y < 0.0;
    if t > last || (gap > 0.0 && !through) || (gap == 0.0 && t == t_before && !through) {
        return -1.0;
    }
    return water_refined(origin_ws, direction_ws, vec2f(t_before, t), vec2f(gap_before, gap), side);
}

// Height of a point of a ray over the surface, metres
fn water_gap(origin_ws: vec3f, direction_ws: vec3f, t: f32) -> f32 {
    return (origin_ws.y - water.level) + t * direction_ws.y - wave_height(origin_ws.xz + t * direction_ws.xz);
}

// Where a ray is between the lowest and the highest wave
fn water_slab(y: f32, dy: f32) -> vec2f {
    let safe = select(dy, select(-1e-20, 1e-20, dy >= 0.0), abs(dy) < 1e-20);
    let a = (water.trough - y) / safe;
    let b = (water.crest - y) / safe;
    return vec2f(min(a, b), max(a, b));
}

// False position, in which an end that stays twice counts half as much [dowell1971]
fn water_refined(origin_ws: vec3f, direction_ws: vec3f, t: vec2f, gaps: vec2f, side: f32) -> f32 {
    var at = t;
    var gap = gaps;
    var best = vec2f(t.y, abs(gaps.y));
    var before = 0.0;
    for (var k = 0u; k < MEET_REFINEMENTS && gap.y < 0.0 && best.y > MEET_ROUNDING * t.y; k++) {
        let middle = mix(at.x, at.y, gap.x / (gap.x - gap.y));
        let found = side * water_gap(origin_ws, direction_ws, middle);
        let stays = select(1.0, 0.5, found * before > 0.0);
        at = select(vec2f(at.x, middle), vec2f(middle, at.y), found > 0.0);
        gap = select(vec2f(stays * gap.x, found), vec2f(found, stays * gap.y), found > 0.0);
        best = select(best, vec2f(middle, abs(found)), abs(found) < best.y);
        before = found;
    }
    return best.x;
}
