// Where a ray meets the bilinear surface over one cell, exactly.
//!import techniques/relief/shaders/lattice
//!import techniques/relief/shaders/heights

const RELIEF_NOWHERE = 1e30;
const RELIEF_CONTACT = 1e-4;  // of the range of heights: what starts this near to a surface and leaves it does not meet it

// Metres from t to where `side` (1: from above, -1: from below) times the gap is, or becomes, negative. Both coordinates
// are linear in t and the patch is bilinear, so the gap is a quadratic; in this form its root does not cancel.
fn relief_patch(walk: ReliefWalk, ray: ReliefRay, heights: vec4f, cell: vec2f, t: f32, side: f32) -> f32 {
    let p = walk.origin + t * walk.step - cell;
    let along = heights.y - heights.x;
    let across = heights.z - heights.x;
    let twist = heights.w - heights.z - along;
    let d = walk.step;
    let q0 = side * (relief_height_along(ray, t) - (heights.x + along * p.x + across * p.y + twist * p.x * p.y));
    let q1 = side * (relief_slope_along(ray, t) - (along * d.x + across * d.y + twist * (p.x * d.y + p.y * d.x)));
    let q2 = side * (ray.bend - twist * d.x * d.y);
    let under = q1 * q1 - 4.0 * q2 * q0;
    let s = 2.0 * q0 / (sqrt(max(under, 0.0)) - q1);
    let inside = q0 < 0.0 && (q1 < 0.0 || q0 < -RELIEF_CONTACT * (relief.hull_high - relief.hull_low));
    return select(select(RELIEF_NOWHERE, s, under >= 0.0 && s >= 0.0), 0.0, inside);
}

// The four corners of a cell: (0, 0), (1, 0), (0, 1), (1, 1) in columns and rows; the sampler repeats or clamps
fn relief_corners(walk: ReliefWalk, cell: vec2f, layer: u32) -> vec4f {
    let middle = (cell + 1.0) * walk.inverse_size;
    if layer == RELIEF_SOLID {
        return textureGather(0, height_map, height_sampler, middle).wzxy;
    }
    return textureGather(1, height_map, height_sampler, middle).wzxy;
}

// What a ray in a cell from t to `end` meets there; the solid layer wins ties
fn relief_in_cell(walk: ReliefWalk, ray: ReliefRay, cell: vec2f, t: f32, end: f32, kind: u32) -> ReliefHit {
    var s = relief_patch(walk, ray, relief_corners(walk, cell, RELIEF_SOLID), cell, t, 1.0);
    var layer = RELIEF_SOLID;
    if TWO_LAYERS && kind != RELIEF_BASE {
        let side = select(1.0, -1.0, kind == RELIEF_LEAVE);
        let upper = relief_patch(walk, ray, relief_corners(walk, cell, RELIEF_TRANSLUCENT), cell, t, side);
        layer = select(RELIEF_SOLID, RELIEF_TRANSLUCENT, upper < s);
        s = min(s, upper);
    }
    return ReliefHit(t + s, select(RELIEF_NONE, layer, t + s <= end));
}
