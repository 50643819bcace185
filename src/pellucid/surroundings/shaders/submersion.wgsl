// Which water a point lies in, how deep, and where the light of a camera over it has entered. See submersion.py.
//!import surroundings/shaders/bindings

const MAX_WATERS = 4u;  // layouts.MAX_WATERS
const MAX_WATER_LIGHTS = 4u;  // layouts.MAX_WATER_LIGHTS

struct Submerged {
    inside: bool,
    water: u32,
    depth_m: f32,  // below the surface straight above
}

// The lowest surface above the point; no branch depends on parameters alone, which would have the driver build anew
fn submerged_at(p_ws: vec3f) -> Submerged {
    var found = Submerged(false, 0u, 1e30);
    for (var k = 0u; k < MAX_WATERS; k++) {
        let bounds = submersion.bounds[k];
        let within = all(p_ws.xz >= bounds.xy) && all(p_ws.xz <= bounds.zw);
        if within && p_ws.y < submersion.level[k].x + submersion.level[k].y {
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
    let bounds = submersion.bounds[0];
    let level = submersion.level[0];
    let within = all(p_ws.xz >= bounds.xy) && all(p_ws.xz <= bounds.zw) && p_ws.y < level.x + level.y;
    return Submerged(within, 0u, max(level.x - p_ws.y, 0.0));
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
