// How far a ray is above what it looks for, and where between two places it meets it.
//!import techniques/relief/shaders/hit
//!import techniques/relief/shaders/frame
//!import techniques/relief/shaders/heights

// Height above what is looked for, positive before the hit
fn relief_gap(ray: ReliefRay, t: f32, kind: u32) -> f32 {
    let both = relief_heights(ray.uv + t * ray.duv);
    let h = relief_height_along(ray, t);
    switch kind {
        case RELIEF_FIRST: { return h - max(both.x, both.y); }
        case RELIEF_LEAVE: { return min(h - both.x, both.y - h); }
        default: { return h - both.x; }
    }
}

// The layer that is nearer; the solid one wins ties
fn relief_layer_at(ray: ReliefRay, t: f32, kind: u32) -> u32 {
    let both = relief_heights(ray.uv + t * ray.duv);
    let h = relief_height_along(ray, t);
    switch kind {
        case RELIEF_FIRST: { return select(RELIEF_SOLID, RELIEF_TRANSLUCENT, both.y > both.x); }
        case RELIEF_LEAVE: { return select(RELIEF_SOLID, RELIEF_TRANSLUCENT, both.y - h < h - both.x); }
        default: { return RELIEF_SOLID; }
    }
}

// A piece of a ray at whose end it is below what it looks for, and the gaps at both ends
struct ReliefPiece {
    before: f32,
    gap_before: f32,
    after: f32,
    gap_after: f32,
}

// Halving [policarpo2005, sec. 3; timonen2006, 2.2.2], then the line between the last two heights [timonen2006, 2.2.3]
fn relief_refined(ray: ReliefRay, found: ReliefPiece, kind: u32, binary: u32) -> ReliefHit {
    var piece = found;
    for (var k = 0u; k < binary; k++) {
        let middle = 0.5 * (piece.before + piece.after);
        let gap = relief_gap(ray, middle, kind);
        let above = gap > 0.0;
        piece.before = select(piece.before, middle, above);
        piece.gap_before = select(piece.gap_before, gap, above);
        piece.after = select(middle, piece.after, above);
        piece.gap_after = select(gap, piece.gap_after, above);
    }
    let share = saturate(piece.gap_before / max(piece.gap_before - piece.gap_after, 1e-20));
    let line = relief.linear_approximation != 0u && piece.gap_before > 0.0;
    let t = select(piece.after, mix(piece.before, piece.after, share), line);
    return ReliefHit(t, relief_layer_at(ray, t, kind));
}
