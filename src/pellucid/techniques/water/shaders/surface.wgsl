// Where a ray meets the surface of water, from either side.
//!import surroundings/shaders/camera
//!import techniques/water/shaders/body

struct WaterMeeting {
    t: f32,
    valid: bool,
    p_ws: vec3f,
    n_ws: vec3f,      // unit, up
    variance: vec3f,  // of slopes that a pixel hides: xx, zz, xz
    fold: f32,
}

const MEET_STEPS = 128u;
const MEET_REFINEMENTS = 8u;

// First crossing at 0 <= t < t_max. Steps are as long as the steepest slope of the waves allows, so that no crest is
// passed, but at least a part of a texel and of what a pixel covers; the last one is divided by false position.
fn meet_water(origin_ws: vec3f, direction_ws: vec3f, t_max: f32) -> WaterMeeting {
    let sides = water_sides(origin_ws, direction_ws);
    let start = max(sides.x, 0.0);
    let under = water_holds(origin_ws + start * direction_ws);
    return meet_water_from(origin_ws, direction_ws, start, min(sides.y, t_max), under);
}

// The same between two points of the ray, the first of which is `under` water or not
fn meet_water_from(origin_ws: vec3f, direction_ws: vec3f, start: f32, end: f32, under: bool) -> WaterMeeting {
    let side = select(1.0, -1.0, under);
    let slab = water_slab(origin_ws.y - water.level, direction_ws.y);
    let last = min(end, slab.y);
    var t = max(start, slab.x);
    var meeting = WaterMeeting(last, false, origin_ws, vec3f(0.0, 1.0, 0.0), vec3f(0.0), 1.0);
    if t > last {
        return meeting;
    }
    let steepness = abs(direction_ws.y) + water.wave_slope * length(direction_ws.xz);
    var gap = side * water_gap(origin_ws, direction_ws, t);
    var t_before = t;
    var gap_before = max(gap, 0.0);
    for (var k = 0u; k < MEET_STEPS; k++) {
        if gap <= 0.0 || t >= last {
            break;
        }
        t_before = t;
        gap_before = gap;
        let least = max(0.25 * water.wave_cell_m, 0.5 * frame.pixel_footprint * t);
        t = min(t + max(gap / max(steepness, 1e-6), min(least, 0.02 * t + water.wave_cell_m)), last);
        gap = side * water_gap(origin_ws, direction_ws, t);
    }
    meeting.valid = gap <= 0.0;
    meeting.t = water_refined(origin_ws, direction_ws, vec2f(t_before, t), vec2f(gap_before, gap), side);
    meeting.p_ws = origin_ws + meeting.t * direction_ws;
    let at = wave_point(meeting.p_ws.xz, footprint_m(meeting.p_ws));
    meeting.n_ws = normalize(vec3f(-at.slope.x, 1.0, -at.slope.y));
    meeting.variance = at.variance;
    meeting.fold = at.fold;
    return meeting;
}

// Height of a point of a ray over the surface, metres
fn water_gap(origin_ws: vec3f, direction_ws: vec3f, t: f32) -> f32 {
    return (origin_ws.y - water.level) + t * direction_ws.y - wave_height(origin_ws.xz + t * direction_ws.xz);
}

// Where a ray is between the lowest and the highest wave
fn water_slab(y: f32, dy: f32) -> vec2f {
    let safe = select(dy, select(-1e-20, 1e-20, dy >= 0.0), abs(dy) < 1e-20);
    let a = (water.wave_low - y) / safe;
    let b = (water.wave_high - y) / safe;
    return vec2f(min(a, b), max(a, b));
}

// False position in which an end that stays counts half as much [dowell1971]
fn water_refined(origin_ws: vec3f, direction_ws: vec3f, t: vec2f, gaps: vec2f, side: f32) -> f32 {
    var at = t;
    var gap = gaps;
    for (var k = 0u; k < MEET_REFINEMENTS; k++) {
        let between = gap.x - gap.y;
        let middle = select(mix(at.x, at.y, saturate(gap.x / between)), at.y, between <= 0.0);
        let found = side * water_gap(origin_ws, direction_ws, middle);
        if found > 0.0 {
            at.x = middle;
            gap = vec2f(found, 0.5 * gap.y);
        } else {
            at.y = middle;
            gap = vec2f(0.5 * gap.x, found);
        }
    }
    return at.y;
}
