// Where a ray ends in a picture, by a march through its depth.
//!import techniques/water/shaders/picture

const MARCH_TRIES = 3u;
const MARCH_STRIDE = 3.0;      // texels that a step passes at least
const MARCH_THICKNESS = 0.02;  // of the depth: a ray that is farther behind what is shown has passed behind it
const MARCH_STEEPENING = 2.0;
const MARCH_SECANTS = 2u;
const MARCH_FAR_M = 1e4;
const MARCH_BEYOND = 1.05;     // of the way to where meshes end: a level bottom ends them all just there

// (x, y, reversed depth) run straight through the picture. Steps look for the first texel in front of the ray; halving
// finds it to a texel, and false position between texels the rest. What lies far in front of the ray was passed behind.
fn seen_march(layer: u32, p_ws: vec3f, direction_ws: vec3f) -> PicturePlace {
    let begin = picture_clip(layer, p_ws);
    let along = water_views.clip_from_world[layer] * vec4f(direction_ws, 0.0);
    let reach = march_reach(layer, p_ws, direction_ws);
    let border = march_border(begin, along);
    let t_end = min(MARCH_BEYOND * reach, 0.9999 * border);
    if !picture_shows(begin) {
        return PicturePlace(clamp(picture_uv(begin), vec2f(0.0), vec2f(1.0)), 0.0, PICTURE_UNKNOWN);
    }
    let end = begin + t_end * along;
    let from_at = vec3f(picture_uv(begin), begin.z / begin.w);
    let to_at = vec3f(picture_uv(end), end.z / end.w);
    let texels = length((to_at.xy - from_at.xy) * vec2f(textureDimensions(picture_depths)));
    let steps = clamp(ceil(texels / MARCH_STRIDE), 2.0, f32(water.march_steps));
    let texel = 1.0 / max(texels, 1.0);
    let halvings = u32(ceil(log2(max(texels / steps, 1.0)))) + 1u;
    var ends = vec2f(0.0);  // in front, behind
    var s = 0.0;
    var passed = false;     // behind something
    var first = -1.0;       // where it was passed
    var found = false;
    // A software driver executes every branch of a loop for all pixels: so one loop looks, one halves, and what is
    // rarely done once more is a loop round both.
    for (var tries = 0u; tries < MARCH_TRIES; tries++) {
        for (var i = 0u; i <= u32(steps); i++) {
            let at = mix(from_at, to_at, s);
            let behind = at.z <= picture_depth(layer, at.xy);
            if behind && !passed {
                break;
            }
            passed = behind;
            ends.x = select(s, ends.x, behind);
            if s >= 1.0 {
                s = 2.0;
                break;
            }
            s = min(s + 1.0 / steps, 1.0);
        }
        if s > 1.0 {
            break;
        }
        ends.y = s;
        for (var i = 0u; i < halvings; i++) {
            let middle = 0.5 * (ends.x + ends.y);
            let at = mix(from_at, to_at, middle);
            let behind = at.z <= picture_depth(layer, at.xy);
            ends = select(vec2f(middle, ends.y), vec2f(ends.x, middle), behind);
        }
        found = march_meets(layer, from_at, to_at, ends, texel);
        if found {
            break;
        }
        first = select(first, ends.y, first < 0.0);
        passed = true;
        s = min(s + 1.0 / steps, 1.0);
    }
    s = select(select(1.0, first, first >= 0.0), ends.y, found);
    if found {
        s = march_refined(layer, from_at, to_at, ends);
    }
    // Metres are not linear in the picture, their reciprocals are.
    let t = t_end * s * begin.w / mix(end.w, begin.w, s);
    let open = select(PICTURE_UNKNOWN, PICTURE_NOTHING, first < 0.0 && !passed && reach <= border);
    let nothing = select(open, PICTURE_HIDDEN, first >= 0.0 && passed);
    return PicturePlace(mix(from_at, to_at, s).xy, t, select(nothing, PICTURE_SOMETHING, found));
}

// Whether a ray that is in front at `ends.x` and behind at `ends.y` met the surface there: not where that is nearer by
// far than the ray ever was, unless it goes on as steeply a texel farther, or the ray had all but met what was before
fn march_meets(layer: u32, from_at: vec3f, to_at: vec3f, ends: vec2f, texel: f32) -> bool {
    let ray = picture_metres(layer, mix(from_at.z, to_at.z, ends.x));
    let shown = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, ends.y)));
    let next = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, ends.y + 1.5 * texel)));
    let before = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, ends.x)));
    let most = MARCH_THICKNESS * ray;
    let meets = ray - shown <= most + MARCH_STEEPENING * abs(shown - next) || before - ray <= most;
    // What hides the very start lies between the camera and the surface, on the other side of it.
    return ends.x < ends.y && meets;
}

// Secants between four texels each, which the ends need not lie on two sides of
fn march_refined(layer: u32, from_at: vec3f, to_at: vec3f, ends: vec2f) -> f32 {
    let width = max(ends.y - ends.x, 1e-7);
    var at = ends;
    var gap = vec2f(march_gap(layer, from_at, to_at, at.x), march_gap(layer, from_at, to_at, at.y));
    var s = ends.y;
    for (var i = 1u; i <= MARCH_SECANTS; i++) {
        let slope = gap.x - gap.y;
        s = select(s, mix(at.x, at.y, gap.x / slope), abs(slope) > 1e-12);
        s = clamp(s, max(ends.x - width, 0.0), min(ends.y + width, 1.0));
        if i < MARCH_SECANTS {
            at = vec2f(at.y, s);
            gap = vec2f(gap.y, march_gap(layer, from_at, to_at, s));
        }
    }
    return s;
}

fn march_gap(layer: u32, from_at: vec3f, to_at: vec3f, s: f32) -> f32 {
    let at = mix(from_at, to_at, s);
    return at.z - picture_depth_between(layer, at.xy);
}

// Metres to where all meshes end in height
fn march_reach(layer: u32, p_ws: vec3f, direction_ws: vec3f) -> f32 {
    let t = (water_views.limit[layer].x - p_ws.y) / select(direction_ws.y, 1e-20, direction_ws.y == 0.0);
    let beyond = select(water_views.limit[layer].x <= p_ws.y, water_views.limit[layer].x >= p_ws.y, layer == 0u);
    return select(select(t, MARCH_FAR_M, t < 0.0), 0.0, beyond);
}

// Metres to the border of the picture, or to its camera
fn march_border(begin: vec4f, along: vec4f) -> f32 {
    let inside = vec4f(begin.w + begin.xy, begin.w - begin.xy);
    let change = vec4f(along.w + along.xy, along.w - along.xy);
    let ways = select(vec4f(MARCH_FAR_M), inside / max(-change, vec4f(1e-20)), change < vec4f(0.0));
    let nearer = along.z - along.w;
    let near = select(MARCH_FAR_M, (begin.w - begin.z) / max(nearer, 1e-20), nearer > 0.0);
    return clamp(min(min(min(ways.x, ways.y), min(ways.z, ways.w)), near), 0.0, MARCH_FAR_M);
}
