// What a ray that meets no more refractive matter sees.
//!import surroundings/shaders/across

// First opaque surface, shaded, or else the environment; through what stands for water, and glass behind it
fn radiance_along(origin_ws: vec3f, direction_ws: vec3f) -> vec3f {
    if ACROSS_WATER || ACROSS_GLASS {
        return across_viewed(origin_ws, direction_ws).radiance;
    }
    let hit = trace_opaque(origin_ws, direction_ws, 1e30);
    if hit.valid {
        return shade_hit(hit, direction_ws);
    }
    return environment_radiance(normalize(direction_ws));
}
