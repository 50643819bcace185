// Where a ray ends in a picture, by a march through its depth.
//!import techniques/water/shaders/picture

const MARCH_REFINEMENTS = 5u;
const MARCH_STRIDE = 1.5;      // texels that a step passes at least
const MARCH_THICKNESS = 0.02;  // of the depth: a ray that is farther behind what is shown has passed behind it
const MARCH_STEEPENING = 2.0;
const MARCH_SECANTS = 3u;
const MARCH_FAR_M = 1e4;

// (x, y, reversed depth) run straight through the picture. Steps look for the first texel in front of the ray; halving
// finds it to a texel, and false position between texels the rest. What lies far in front of the ray was passed behind.
fn seen_march(layer: u32, p_ws: vec3f, direction_ws: vec3f) -> PicturePlace {
    let begin = picture_clip(layer, p_ws);
    let along = water_views.clip_from_world[layer] * vec4f(direction_ws, 0.0);
    let reach = march_reach(layer, p_ws, direction_ws);
    let border = march_border(begin, along);
    let t_end = min(reach, 0.9999 * border);
    if !picture_shows(begin) {
        return PicturePlace(clamp(picture_uv(begin), vec2f(0.0), vec2f(1.0)), 0.0, PICTURE_UNKNOWN);
    }
    let end = begin + t_end * along;
    let from_at = vec3f(picture_uv(begin), begin.z / begin.w);
    let to_at = vec3f(picture_uv(end), end.z / end.w);
    let texels = length((to_at.xy - from_at.xy) * vec2f(textureDimensions(picture_depths)));
    let steps = clamp(ceil(texels / MARCH_STRIDE), 2.0, f32(water.march_steps));
    let texel = 1.0 / max(texels, 1.0);
    var low = 0.0;
    var high = 0.0;
    var s = 0.0;
    var passed = false;   // behind something
    var first = -1.0;     // where it was passed
    var halvings = 0u;
    var found = false;
    for (var i = 0u; i < 2u * u32(steps) + 3u * MARCH_REFINEMENTS; i++) {
        let at = mix(from_at, to_at, s);
        let behind = at.z <= picture_depth(layer, at.xy);
        if halvings == 0u {
            if !behind || passed {
                passed = behind;
                low = select(s, low, behind);
                if s >= 1.0 {
                    break;
                }
                s = min(s + 1.0 / steps, 1.0);
                continue;
            }
            high = s;
        } else {
            low = select(s, low, behind);
            high = select(high, s, behind);
        }
        halvings++;
        if halvings > MARCH_REFINEMENTS || high - low < 0.5 * texel {
            found = march_meets(layer, from_at, to_at, vec2f(low, high), texel);
            if found {
                break;
            }
            first = select(first, high, first < 0.0);
            passed = true;
            halvings = 0u;
            s = min(high + 1.0 / steps, 1.0);
            continue;
        }
        s = 0.5 * (low + high);
    }
    if found {
        s = march_refined(layer, from_at, to_at, low, high);
    } else if first >= 0.0 {
        s = first;
    }
    // Metres are not linear in the picture, their reciprocals are.
    let t = t_end * s * begin.w / mix(end.w, begin.w, s);
    let nothing = select(PICTURE_UNKNOWN, PICTURE_NOTHING, !passed && reach <= border);
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
    return ray - shown <= most + MARCH_STEEPENING * abs(shown - next) || before - ray <= most;
}

// Secants between four texels each, which the ends need not lie on two sides of; the best place of all
fn march_refined(layer: u32, from_at: vec3f, to_at: vec3f, low: f32, high: f32) -> f32 {
    let a = mix(from_at, to_at, low);
    let b = mix(from_at, to_at, high);
    var at = vec2f(low, high);
    var gap = vec2f(a.z - picture_depth_between(layer, a.xy), b.z - picture_depth_between(layer, b.xy));
    var best = select(vec2f(high, abs(gap.y)), vec2f(low, abs(gap.x)), abs(gap.x) < abs(gap.y));
    for (var i = 0u; i < MARCH_SECANTS; i++) {
        let slope = gap.x - gap.y;
        let s = select(high, mix(at.x, at.y, clamp(gap.x / slope, -2.0, 3.0)), abs(slope) > 1e-12);
        let c = mix(from_at, to_at, s);
        let found = c.z - picture_depth_between(layer, c.xy);
        best = select(best, vec2f(s, abs(found)), abs(found) < best.y);
        at = vec2f(at.y, s);
        gap = vec2f(gap.y, found);
    }
    return clamp(best.x, 0.0, 1.0);
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
