// What a pixel sees by way of the translucent layer: a point of the solid layer, or the surroundings in a direction.
//!import techniques/relief/shaders/frame

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
