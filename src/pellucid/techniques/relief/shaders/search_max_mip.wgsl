// Down and up a pyramid of bounds of the heights [tevs2008], then exact patches: nothing is skipped. One pyramid has both layers.
//!import techniques/relief/shaders/patch

// A square of cells: its bounds, and where a ray leaves it
struct ReliefNode {
    index: vec2u,
    far: vec2f,        // its corner ahead
    bounds: vec4f,
}

fn relief_node(walk: ReliefWalk, cell: vec2f, level: u32) -> ReliefNode {
    // Where the array repeats, so do the squares; the last of a row ends with it.
    let index = select(cell, relief_cell_index(walk, cell), relief.tiling != 0u);
    let square = floor(index / f32(1u << level));
    let end = select(vec2f(1e9), walk.size, relief.tiling != 0u);
    let far = min((square + walk.ahead) * f32(1u << level), end) + cell - index;
    let last = max(relief.texels >> vec2u(level), vec2u(1u)) - 1u;
    let node = min(vec2u(max(square, vec2f(0.0))), last);
    return ReliefNode(vec2u(vec2i(square)), far, textureLoad(height_bounds, node, level));
}

fn relief_by_bounds(ray: ReliefRay, reach: f32, kind: u32) -> ReliefHit {
    let walk = relief_walk(ray);
    let end = relief_end(walk, ray, reach);
    let top = firstLeadingBit(max(relief.texels.x, relief.texels.y));
    // Squares as large as an eighth of the way: larger ones are hardly ever free.
    var level = min(u32(max(log2(walk.spread * end) - 3.0, 0.0)), top);
    var t = 0.0;
    for (var turn = 0u; turn < RELIEF_TURNS && t < end; turn++) {
        let cell = relief_cell(walk, t);
        let node = relief_node(walk, cell, level);
        let leaves = relief_leaves(walk, t, node.far);
        let lowest = relief_lowest(ray, t, leaves);
        var ceiling = node.bounds.x;
        var free = lowest > ceiling;
        if TWO_LAYERS && kind == RELIEF_FIRST {
            ceiling = max(ceiling, node.bounds.z);
            free = lowest > ceiling;
        }
        if kind == RELIEF_LEAVE {
            free = free && relief_highest(ray, t, leaves) < node.bounds.w;
        }
        if !free && level == 0u {
            let hit = relief_in_cell(walk, ray, cell, t, min(leaves, end), kind);
            if hit.layer != RELIEF_NONE {
                return hit;
            }
        }
        // Not free, and not a cell: look closer, from where the ray can first be as low as the square is high.
        let closer = !free && level > 0u;
        let fall = max(-relief_steepest_fall(ray, t, end), 1e-20);
        let enters = min(t + max(relief_height_along(ray, t) - ceiling, 0.0) / fall, leaves);
        t = select(leaves, select(enters, t, kind == RELIEF_LEAVE), closer);
        // Over the border of this square and of the one of twice its size at once: the next may be that large.
        let borders = (node.far - walk.origin) * walk.inverse;
        let last_of_two = (node.index & vec2u(1u)) == vec2u(walk.ahead);
        let outward = select(last_of_two.y, last_of_two.x, borders.x < borders.y);
        level = select(select(level, min(level + 1u, top), outward), level - 1u, closer);
    }
    return ReliefHit(reach, RELIEF_NONE);
}
