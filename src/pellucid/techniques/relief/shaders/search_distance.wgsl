// Steps as long as a map of distances allows [donnelly2005], which is sphere tracing [hart1996].
//!import techniques/relief/shaders/gap

const RELIEF_SHORTEST = 0.35;  // cells that a step goes at least: what is thinner than that may be skipped

// Distance of matter in metres of the nominal tile; channel 1 is of the solid layer alone
fn relief_distance(uv: vec2f, h: f32, kind: u32) -> f32 {
    let layers = f32(textureDimensions(distance_map).z);
    let share = saturate((h - relief.solid_low) / max(relief_distance_top() - relief.solid_low, 1e-20));
    let depth = (share * (layers - 1.0) + 0.5) / layers;
    let both = textureSampleLevel(distance_map, height_sampler, vec3f(relief_map_uv(uv), depth), 0.0).rg;
    return select(both.x, both.y, TWO_LAYERS && kind == RELIEF_BASE);
}

fn relief_distance_top() -> f32 {
    return select(relief.solid_high, max(relief.solid_high, relief.translucent_high), TWO_LAYERS);
}

fn relief_by_distance(ray: ReliefRay, reach: f32, kind: u32, turns: u32, binary: u32) -> ReliefHit {
    let level = ray.duv * relief.tile_m;
    let cells = abs(ray.duv) * vec2f(relief.texels);
    let shortest = min(RELIEF_SHORTEST / max(max(cells.x, cells.y), 1e-6), reach / 16.0);
    let gap = relief_gap(ray, 0.0, kind);
    var piece = ReliefPiece(0.0, gap, 0.0, gap);
    for (var k = 0u; k < turns && piece.gap_after > 0.0 && piece.after < reach; k++) {
        let slope = ray.dh + 2.0 * ray.bend * piece.after;
        let speed = max(length(vec3f(level, slope)), 1e-6);
        let free = relief_distance(ray.uv + piece.after * ray.duv, relief_height_along(ray, piece.after), kind) / speed;
        let after = min(piece.after + max(free, shortest), reach * 1.00001);
        piece = ReliefPiece(piece.after, piece.gap_after, after, relief_gap(ray, after, kind));
    }
    if piece.gap_after > 0.0 {
        return ReliefHit(reach, RELIEF_NONE);
    }
    return relief_refined(ray, piece, kind, binary);
}
