// What a pixel sees by way of the translucent layer: a point of the solid layer, or the surroundings in a direction.
//!import techniques/relief/shaders/frame

const RELIEF_GRAZING = 1e-3;  // least cosine between normal and view

struct SolidLook {
    uv: vec2f,
    footprint: f32,    // tiles
    wet: bool,         // seen within the translucent matter
    p_ws: vec3f,
    view_ws: vec3f,    // unit, from the point towards where it is seen from
    weight: vec3f,     // zero where nothing is seen
}

struct OutsideLook {
    origin_ws: vec3f,
    direction_ws: vec3f,
    alpha: f32,        // GGX roughness that blurs it
    weight: vec3f,
}

// One mirrored look into the surroundings, and one that passes right through: of three colours the last that does
struct OutsideLooks {
    mirrored: OutsideLook,
    passed: OutsideLook,
}

// A normal that leans away from the viewer is turned until it just faces them: interpolated slopes do not know what
// the polygon hides
fn relief_towards(n_ws: vec3f, direction_ws: vec3f) -> vec3f {
    let facing = -dot(n_ws, direction_ws);
    return select(n_ws, normalize(n_ws - (RELIEF_GRAZING - facing) * direction_ws), facing < RELIEF_GRAZING);
}
