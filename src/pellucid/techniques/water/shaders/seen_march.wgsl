// Where a ray ends in a picture, by a march through its depth.
//!import techniques/water/shaders/picture

const MARCH_TRIES = 3u;
const MARCH_STRIDE = 3.0;      // texels that a step passes at least
const MARCH_THICKNESS = 0.02;  // of the depth: a ray that is farther behind what is shown has passed behind it
const MARCH_STEEPENING = 2.0;
const MARCH_SECANTS = 2u;
const MARCH_NARROWINGS = 14u;  // secants, and halvings of the longest step that a picture of 8192 texels has
const MARCH_EXACT = 0.1;       // texels that a place may be off before the last false position
const MARCH_FAR_M = 1e4;
const MARCH_BEYOND = 1.05;     // of the way to where meshes end: a level bottom ends them all just there

// (x, y, reversed depth) run straight through the picture. Steps look for the first texel in front of the ray; false
// position finds where it meets a surface that goes on between two steps, halving where that ends, to a texel. What lies
// far in front of the ray there was passed behind.
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
    var bracket = MarchBracket(vec2f(0.0), vec2f(0.0), false);
    var s = 0.0;
    var passed = false;     // behind something
    var first = -1.0;       // where it was passed
    var found = false;
    // A software driver executes every branch of a loop for all pixels, and one turn of every loop: so one loop looks,
    // one finds, and what is rarely done once more is a loop round both.
    for (var tries = 0u; tries < MARCH_TRIES; tries++) {
        for (var i = 0u; i <= u32(steps); i++) {
            let at = mix(from_at, to_at, s);
            let gap = at.z - picture_depth_between(layer, at.xy);
            let behind = gap <= 0.0;
            if behind && !passed {
                bracket.gaps.y = gap;
                break;
            }
            passed = behind;
            bracket.ends.x = select(s, bracket.ends.x, behind);
            bracket.gaps.x = select(gap, bracket.gaps.x, behind);
            if s >= 1.0 {
                s = 2.0;
                break;
            }
            s = min(s + 1.0 / steps, 1.0);
        }
        if s > 1.0 {
            break;
        }
        bracket.ends.y = s;
        bracket = march_narrowed(layer, from_at, to_at, bracket, texel);
        found = bracket.meets || march_meets(layer, from_at, to_at, bracket, texel);
        if found {
            break;
        }
        first = select(first, bracket.ends.y, first < 0.0);
        passed = true;
        s = min(s + 1.0 / steps, 1.0);
    }
    s = select(select(1.0, first, first >= 0.0), march_between(bracket), found);
    // Metres are not linear in the picture, their reciprocals are.
    let t = t_end * s * begin.w / mix(end.w, begin.w, s);
    let open = select(PICTURE_UNKNOWN, PICTURE_NOTHING, first < 0.0 && !passed && reach <= border);
    let nothing = select(open, PICTURE_HIDDEN, first >= 0.0 && passed);
    return PicturePlace(mix(from_at, to_at, s).xy, t, select(nothing, PICTURE_SOMETHING, found));
}

// Where a ray is in front of what the picture shows, and where behind it: shares of its way, differences of depth
struct MarchBracket {
    ends: vec2f,
    gaps: vec2f,
    meets: bool,  // an end is in the surface
}

// False position twice, which finds a surface that goes on; then halves, down to a texel
fn march_narrowed(layer: u32, from_at: vec3f, to_at: vec3f, bracket: MarchBracket, texel: f32) -> MarchBracket {
    var b = bracket;
    for (var k = 0u; k < MARCH_NARROWINGS; k++) {
        let even = k < MARCH_SECANTS;
        let middle = select(0.5 * (b.ends.x + b.ends.y), march_between(b), even);
        let at = mix(from_at, to_at, middle);
        let gap = at.z - picture_depth_between(layer, at.xy);
        let behind = gap <= 0.0;
        // What is left of the gap, over its change, tells how far off that is.
        let off = abs(gap) * (b.ends.y - b.ends.x) / max(b.gaps.x - b.gaps.y, 1e-12);
        b.ends = select(vec2f(middle, b.ends.y), vec2f(b.ends.x, middle), behind);
        b.gaps = select(vec2f(gap, b.gaps.y), vec2f(b.gaps.x, gap), behind);
        b.meets = even && off <= MARCH_EXACT * texel && bracket.ends.x < bracket.ends.y;
        if b.meets || b.ends.y - b.ends.x <= texel {
            break;
        }
    }
    return b;
}

fn march_between(b: MarchBracket) -> f32 {
    let share = b.gaps.x / max(b.gaps.x - b.gaps.y, 1e-12);
    return mix(b.ends.x, b.ends.y, saturate(share));
}

// Whether a ray met the surface at a bracket of a texel: not where that is nearer by far a texel on than the ray ever
// was, unless it goes on as steeply farther, or the ray had all but met what was before. Between two texels that are no
// one surface there is none to meet.
fn march_meets(layer: u32, from_at: vec3f, to_at: vec3f, b: MarchBracket, texel: f32) -> bool {
    let ray = picture_metres(layer, mix(from_at.z, to_at.z, b.ends.x));
    let before = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, b.ends.x - 0.5 * texel)));
    let shown = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, b.ends.y + 0.5 * texel)));
    let next = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, b.ends.y + 2.0 * texel)));
    let most = MARCH_THICKNESS * ray;
    let meets = ray - shown <= most + MARCH_STEEPENING * abs(shown - next) || before - ray <= most;
    // What hides the very start lies between the camera and the surface, on the other side of it.
    return b.ends.x < b.ends.y && meets;
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
