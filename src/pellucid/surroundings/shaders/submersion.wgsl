// Which water a point lies in, how deep, and where the light of a camera over it has entered. See submersion.py.
//!import surroundings/shaders/bindings
//!import surroundings/shaders/outline

const MAX_WATERS = 4u;  // layouts.MAX_WATERS
const MAX_WATER_LIGHTS = 4u;  // layouts.MAX_WATER_LIGHTS

const SUBMERGED_SLACK = 2e-4;  // of the water: what stands at its borders is within

override SUBMERGED_OUTLINES: bool = false;  // whether waters have borders of their own

struct Submerged {
    inside: bool,
    water: u32,
    depth_m: f32,  // below the surface straight above
}

// The lowest surface above the point; no branch depends on parameters alone, which would have the driver build anew
fn submerged_at(p_ws: vec3f) -> Submerged {
    var found = Submerged(false, 0u, 1e30);
    for (var k = 0u; k < MAX_WATERS; k++) {
        if submerged_within(k, p_ws) && p_ws.y < submersion.level[k].x + submersion.level[k].y {
            let depth_m = submersion.level[k].x + submerged_wave(k, p_ws.xz) - p_ws.y;
            if depth_m > 0.0 && depth_m < found.depth_m {
                found = Submerged(true, k, depth_m);
            }
        }
    }
    return found;
}

// The same where there is but one water, without its waves: what only the highest of them covers counts as just below
// the surface
fn submerged_at_rest(p_ws: vec3f) -> Submerged {
    let level = submersion.level[0];
    let within = submerged_within(0u, p_ws) && p_ws.y < level.x + level.y;
    return Submerged(within, 0u, max(level.x - p_ws.y, 0.0));
}

// Whether a point is within what bounds a water besides its surface; see scene/water_outline.py
fn submerged_within(k: u32, p_ws: vec3f) -> bool {
    let bounds = submersion.bounds[k];
    var within = all(p_ws.xz >= bounds.xy) && all(p_ws.xz <= bounds.zw);
    if SUBMERGED_OUTLINES {
        let shape = submersion.shape[k];
        let middle = submersion.middle[k];
        let p = p_ws.xz - middle.xy;
        let h = submersion.level[k].x - p_ws.y;
        let slack = SUBMERGED_SLACK * min(middle.z, middle.w);
        let scaled = p / (middle.zw + slack);
        let ellipse = dot(scaled, scaled) <= 1.0 + h * (shape.y + shape.z * h);
        var polygon = true;
        for (var e = 0u; e < MOST_CORNERS; e++) {
            let edge = submersion.edges[k * MOST_CORNERS + e];
            polygon = polygon && dot(edge.xy, p) + edge.z * h <= edge.w + slack;
        }
        let own = h <= shape.w + slack && select(polygon, ellipse, shape.x < 1.5);
        within = select(within, own, shape.x > 0.5);
    }
    return within;
}

// Where a ray is within that, of a water with borders of its own
fn submerged_outline(k: u32, origin_ws: vec3f, direction_ws: vec3f) -> OutlineWay {
    let shape = submersion.shape[k];
    let middle = submersion.middle[k];
    let o = origin_ws - vec3f(middle.x, submersion.level[k].x, middle.y);
    let round = outline_ellipse(middle.zw, shape.yz, o, direction_ws);
    var way = outline_everywhere();
    for (var e = 0u; e < MOST_CORNERS; e++) {
        let edge = submersion.edges[k * MOST_CORNERS + e];
        way = outline_cut(way, vec3f(edge.x, -edge.z, edge.y), edge.w, o, direction_ws);
    }
    if shape.x < 1.5 {
        way = round;
    }
    return outline_cut(way, vec3f(0.0, -1.0, 0.0), shape.w, o, direction_ws);
}

// Place on the maps of a water, 0..1, of a place on its level
fn submerged_uv(water: u32, xz: vec2f) -> vec2f {
    let bounds = submersion.bounds[water];
    return (xz - bounds.xy) / (bounds.zw - bounds.xy);
}

// Height of the surface over its level, metres
fn submerged_wave(water: u32, xz: vec2f) -> f32 {
    let layer = u32(submersion.level[water].z);
    return textureSampleLevel(submerged_light, caustic_sampler, submerged_uv(water, xz), layer, 0.0).a;
}

// Where the level is met on the way from a point to the camera of a map, whose slope is horizontal way over height
fn submerged_entry(p_ws: vec3f, level_m: f32, slope: vec2f) -> vec2f {
    return p_ws.xz + slope * (level_m - p_ws.y);
}
