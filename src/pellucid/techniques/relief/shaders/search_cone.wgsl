// Jumps through cones that hold no matter [dummer2006], then exact patches: nothing is skipped (see fields/heightfield.py).
//!import techniques/relief/shaders/patch

// Highest corner of a cell in metres, and how steeply the surface rises beyond it at most, metres a cell of gap along both
// axes. The map has the four quadrants of directions side by side; channels 2 and 3 are of the solid layer alone.
fn relief_cone_of(walk: ReliefWalk, cell: vec2f, kind: u32) -> vec2f {
    let quadrant = (1.0 - walk.ahead) * walk.size;
    let cone = textureLoad(cone_map, vec2i(relief_cell_index(walk, cell) + quadrant), 0);
    if TWO_LAYERS && kind == RELIEF_BASE {
        return cone.zw;
    }
    return cone.xy;
}

fn relief_by_cones(ray: ReliefRay, reach: f32, kind: u32) -> ReliefHit {
    let walk = relief_walk(ray);
    let end = relief_end(walk, ray, reach);
    var t = 0.0;
    for (var turn = 0u; turn < RELIEF_TURNS && t < end; turn++) {
        let cell = relief_cell(walk, t);
        let cone = relief_cone_of(walk, cell, kind);
        let leaves = relief_leaves(walk, t, cell + walk.ahead);
        if relief_lowest(ray, t, leaves) <= cone.x {
            let hit = relief_in_cell(walk, ray, cell, t, min(leaves, end), kind);
            if hit.layer != RELIEF_NONE {
                return hit;
            }
        }
        let free = max(relief_height_along(ray, leaves) - cone.x, 0.0);
        t = leaves + free / max(cone.y * walk.spread - relief_steepest_fall(ray, leaves, end), 1e-20);
    }
    return ReliefHit(reach, RELIEF_NONE);
}
