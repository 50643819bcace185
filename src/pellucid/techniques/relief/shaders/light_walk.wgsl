// Rays towards a lamp, or from it, that pass the surface of one layer; nothing is skipped.
//!import techniques/relief/shaders/search_max_mip
//!import techniques/relief/shaders/reach

override RELIEF_LIGHT_STEPPED: bool = false;  // in equal steps along straight rays, as in [timonen2006]

const LIGHT_TURNS = 512u;

fn light_top_level() -> u32 {
    return firstLeadingBit(max(relief.texels.x, relief.texels.y));
}

// The level to go on with where a ray has left a square: a larger one, if it has left that too
fn light_next_level(walk: ReliefWalk, node: ReliefNode, cell: vec2f, t: f32, level: u32) -> u32 {
    let outward = any(((node.index & vec2u(1u)) == vec2u(walk.ahead)) & (relief_cell(walk, t) != cell));
    return select(level, min(level + 1u, light_top_level()), outward);
}

// First t from `begin` on where a ray comes out of a layer (`rising`) or goes into it; RELIEF_NOWHERE when it does not
fn light_crossing(ray: ReliefRay, begin: f32, reach: f32, layer: u32, rising: bool) -> f32 {
    let walk = relief_walk(ray);
    let side = select(1.0, -1.0, rising);
    var t = begin;
    var level = min(1u, light_top_level());
    for (var turn = 0u; turn < LIGHT_TURNS && t < reach; turn++) {
        let cell = relief_cell(walk, t);
        let node = relief_node(walk, cell, level);
        let leaves = relief_leaves(walk, t, node.far);
        let bounds = select(node.bounds.xy, node.bounds.zw, layer == RELIEF_TRANSLUCENT);
        let free = select(relief_lowest(ray, t, leaves) > bounds.x, relief_highest(ray, t, leaves) < bounds.y, rising);
        if !free && level > 0u {
            level -= 1u;
            continue;
        }
        if !free {
            let s = relief_patch(walk, ray, relief_corners(walk, cell, layer), cell, t, side);
            if t + s <= min(leaves, reach) {
                return t + s;
            }
        }
        t = leaves;
        level = light_next_level(walk, node, cell, t, level);
    }
    return RELIEF_NOWHERE;
}
