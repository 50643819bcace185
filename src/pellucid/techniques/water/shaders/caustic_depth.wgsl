// Distance of the first mesh along the light, below the surface or above it. The camera is parallel to the light and its
// picture lies on the level of the water.
//!import surroundings/shaders/surface
//!import techniques/water/shaders/caustic_bindings

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let p_ws = triangle_corner(vertex / 3u, vertex % 3u);
    let above = caustic.above > 0.5;
    let slope = select(caustic.slope, caustic.slope_above, above);
    let seen = (p_ws.xz + slope * (water.level - p_ws.y) - water.low) / (water.high - water.low);
    let below_crest = (water.level + water.wave_high - p_ws.y) / caustic.reach_m;
    let over_trough = 1.0 - (p_ws.y - water.level - water.wave_low) / caustic.reach_above_m;
    return vec4f(2.0 * seen.x - 1.0, 1.0 - 2.0 * seen.y, select(below_crest, over_trough, above), 1.0);
}
