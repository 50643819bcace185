// Equal steps along a ray until it is below the height field [timonen2006, 2.2.1]; thin parts may be skipped.
//!import techniques/relief/shaders/reach
//!import techniques/relief/shaders/gap

const RELIEF_FEWEST_STEPS = 4.0;

// Tiles that a pixel covers where its ray enters; a pass that knows it sets it
var<private> relief_pixel_tiles: f32 = 0.0;

// Fewer steps where the view is steep or far away [tatarchuk2006, sec. 3], or the heights simple [timonen2006, 2.3.1]
fn relief_adapted(steps: u32, ray: ReliefRay) -> u32 {
    let steep = mix(1.0, 1.0 / 3.0, saturate(abs(ray.dh)));
    let far = 1.0 / max(relief_pixel_tiles * f32(max(relief.texels.x, relief.texels.y)), 1.0);
    let simple = mix(1.0 / 3.0, 1.0, textureSampleLevel(complexity_map, height_sampler, relief_map_uv(ray.uv), 0.0).r);
    let share = mix(1.0, steep, relief.adapt_angle) * mix(1.0, far, relief.adapt_distance) * mix(1.0, simple, relief.complexity);
    return u32(clamp(ceil(f32(steps) * share), min(RELIEF_FEWEST_STEPS, f32(steps)), f32(steps)));
}

fn relief_linear(ray: ReliefRay, reach: f32, kind: u32, linear: u32, binary: u32) -> ReliefHit {
    let count = relief_adapted(max(linear, 1u), ray);
    let step = reach * 1.00001 / f32(count);  // rounding must not end above the lowest height
    let gap = relief_gap(ray, 0.0, kind);
    var piece = ReliefPiece(0.0, gap, 0.0, gap);
    for (var k = 0u; k < count && piece.gap_after > 0.0; k++) {
        let after = piece.after + step;
        piece = ReliefPiece(piece.after, piece.gap_after, after, relief_gap(ray, after, kind));
    }
    if piece.gap_after > 0.0 {
        return ReliefHit(reach, RELIEF_NONE);
    }
    return relief_refined(ray, piece, kind, binary);
}
