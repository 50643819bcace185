// Where a ray ends in a picture, by a march through its depth.
//!import techniques/water/shaders/picture

const MARCH_REFINEMENTS = 5u;
const MARCH_STRIDE = 1.5;      // texels that a step passes at least
const MARCH_THICKNESS = 0.02;  // of the depth: a ray that is farther behind what is shown has passed behind it
const MARCH_FAR_M = 1e4;

// (x, y, reversed depth) run straight through the picture. Steps look for the first texel in front of the ray; halving
// finds it to a texel, and a line between four texels the rest. What lies far in front of the ray was passed behind.
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
    var low = 0.0;
    var high = 0.0;
    var s = 0.0;
    var passed = false;   // behind something
    var halvings = 0u;
    var found = false;
    for (var i = 0u; i < 2u * u32(steps) + 3u * MARCH_REFINEMENTS; i++) {
        let at = mix(from_at, to_at, s);
        let depth = picture_depth(layer, at.xy);
        let behind = at.z <= depth;
        if halvings == 0u {
            if behind && !passed {
                high = s;
                halvings = select(1u, MARCH_REFINEMENTS + 1u, s == 0.0);
            } else {
                passed = behind;
                low = select(low, s, !behind);
                if s >= 1.0 {
                    break;
                }
                s = min(s + 1.0 / steps, 1.0);
                continue;
            }
        } else {
            low = select(s, low, behind);
            high = select(high, s, behind);
            halvings++;
        }
        if halvings > MARCH_REFINEMENTS {
            let metres = picture_metres(layer, mix(from_at.z, to_at.z, low));
            let shown = picture_metres(layer, picture_depth(layer, mix(from_at.xy, to_at.xy, high)));
            if metres - shown <= MARCH_THICKNESS * metres {
                found = true;
                break;
            }
            passed = true;
            halvings = 0u;
            s = min(high + 1.0 / steps, 1.0);
            continue;
        }
        s = 0.5 * (low + high);
    }
    if found {
        s = march_refined(layer, from_at, to_at, low, high);
    }
    // Metres are not linear in the picture, their reciprocals are.
    let t = t_end * s * begin.w / mix(end.w, begin.w, s);
    let nothing = select(PICTURE_UNKNOWN, PICTURE_NOTHING, !passed && reach <= border);
    return PicturePlace(mix(from_at, to_at, s).xy, t, select(nothing, PICTURE_SOMETHING, found));
}

// One step of false position, between four texels each
fn march_refined(layer: u32, from_at: vec3f, to_at: vec3f, low: f32, high: f32) -> f32 {
    let a = mix(from_at, to_at, low);
    let b = mix(from_at, to_at, high);
    let over = a.z - picture_depth_between(layer, a.xy);
    let under = b.z - picture_depth_between(layer, b.xy);
    let slope = over - under;
    return select(high, mix(low, high, clamp(over / slope, -2.0, 3.0)), abs(slope) > 1e-12);
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
