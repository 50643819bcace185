// What the translucent layer mirrors: the surroundings, or the relief itself.
//!import techniques/relief/shaders/looks
//!import techniques/relief/shaders/search

override RELIEF_REFLECTION: u32 = 0u;  // 0 surroundings, 1 the relief as a plane, 2 the relief by search

// Where a mirrored ray that leaves (uv, h) meets the solid layer
fn relief_mirrored(ray: ReliefRay) -> ReliefHit {
    let nothing = ReliefHit(0.0, RELIEF_NONE);
    if RELIEF_REFLECTION == 1u {
        // [timonen2006, eq. 21-25]: the plane in the middle of the solid layer's heights
        let t = (0.5 * (relief.solid_low + relief.solid_high) - ray.h) / min(ray.dh, -1e-9);
        let lands = ray.dh < 0.0 && t > 0.0 && relief_inside(ray.uv + t * ray.duv);
        return ReliefHit(t, select(RELIEF_NONE, RELIEF_SOLID, lands));
    }
    if RELIEF_REFLECTION == 2u {
        return relief_solid(ray, relief_reach(ray));
    }
    return nothing;
}
