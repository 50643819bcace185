// Equal steps along a ray until it is below the height field, then halving, then the line between the last two.
//!import techniques/relief/shaders/reach
//!import techniques/relief/shaders/heights

const RELIEF_NONE = 0u;
const RELIEF_TRANSLUCENT = 1u;
const RELIEF_SOLID = 2u;

struct ReliefHit {
    t: f32,
    layer: u32,
}

// What a search looks for
const RELIEF_FIRST = 0u;  // the first of both layers, from above both
const RELIEF_BASE = 1u;   // the solid layer alone, from above it
const RELIEF_LEAVE = 2u;  // from within the translucent matter: its upper surface, or the solid layer

// Height above what is looked for, positive before the hit; and the layer that is nearer
fn relief_gap(ray: ReliefRay, t: f32, kind: u32) -> f32 {
    let both = relief_heights(ray.uv + t * ray.duv);
    let h = relief_height_along(ray, t);
    switch kind {
        case RELIEF_FIRST: { return h - max(both.x, both.y); }
        case RELIEF_LEAVE: { return min(h - both.x, both.y - h); }
        default: { return h - both.x; }
    }
}

fn relief_layer_at(ray: ReliefRay, t: f32, kind: u32) -> u32 {
    let both = relief_heights(ray.uv + t * ray.duv);
    let h = relief_height_along(ray, t);
    switch kind {
        case RELIEF_FIRST: { return select(RELIEF_SOLID, RELIEF_TRANSLUCENT, both.y > both.x); }
        case RELIEF_LEAVE: { return select(RELIEF_SOLID, RELIEF_TRANSLUCENT, both.y - h < h - both.x); }
        default: { return RELIEF_SOLID; }
    }
}

// [policarpo2005, sec. 3; timonen2006, 3.2]: `linear` steps find the piece, `binary` halve it
fn relief_linear(ray: ReliefRay, reach: f32, kind: u32, linear: u32, binary: u32) -> ReliefHit {
    let step = reach * 1.00001 / f32(max(linear, 1u));  // rounding must not end above the lowest height
    var before = 0.0;
    var gap_before = relief_gap(ray, 0.0, kind);
    var after = 0.0;
    var gap_after = gap_before;
    for (var k = 0u; k < linear && gap_after > 0.0; k++) {
        before = after;
        gap_before = gap_after;
        after += step;
        gap_after = relief_gap(ray, after, kind);
    }
    if gap_after > 0.0 {
        return ReliefHit(reach, RELIEF_NONE);
    }
    for (var k = 0u; k < binary; k++) {
        let middle = 0.5 * (before + after);
        let gap = relief_gap(ray, middle, kind);
        let above = gap > 0.0;
        before = select(before, middle, above);
        gap_before = select(gap_before, gap, above);
        after = select(middle, after, above);
        gap_after = select(gap, gap_after, above);
    }
    // Both heights change linearly within a short piece [timonen2006, 3.2.3]
    let share = saturate(gap_before / max(gap_before - gap_after, 1e-20));
    let t = select(after, mix(before, after, share), relief.linear_approximation != 0u && gap_before > 0.0);
    return ReliefHit(t, relief_layer_at(ray, t, kind));
}
