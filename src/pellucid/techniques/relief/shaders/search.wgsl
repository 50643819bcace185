// Where a ray meets the layers, by the search that RELIEF_SEARCH names.
//!import techniques/relief/shaders/search_linear

override RELIEF_SEARCH: u32 = 0u;  // 0 linear, 1 distance map, 2 cone map, 3 maxima

// First of both layers, from outside
fn relief_first(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_linear(ray, reach, RELIEF_FIRST, relief.linear_steps, relief.binary_steps);
}

// Solid layer alone, from above it
fn relief_solid(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_linear(ray, reach, RELIEF_BASE, relief.linear_steps, relief.binary_steps);
}

// From inside the translucent matter: its upper surface, or the solid layer
fn relief_leave(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_linear(ray, reach, RELIEF_LEAVE, relief.refraction_linear, relief.refraction_binary);
}
