// The space that a body of water with borders of its own is bounded by besides its surface.
//!import surroundings/shaders/outline
//!import techniques/water/shaders/bindings

override WATER_OUTLINE: u32 = 0u;  // water_outline.PART, ELLIPSE, POLYGON

fn outline_way(origin_ws: vec3f, direction_ws: vec3f) -> OutlineWay {
    let o = origin_ws - vec3f(water.middle.x, water.level, water.middle.y);
    var way = outline_everywhere();
    if WATER_OUTLINE == 1u {
        way = outline_ellipse(water.half, water.shape.xy, o, direction_ws);
    } else {
        for (var k = 0u; k < MOST_CORNERS; k++) {
            let edge = water.edges[k];
            way = outline_cut(way, vec3f(edge.x, -edge.z, edge.y), edge.w, o, direction_ws);
        }
    }
    return outline_cut(way, vec3f(0.0, -1.0, 0.0), water.shape.z, o, direction_ws);
}
