// What a ray sees that leaves the surface, downwards within the water or upwards above it.
//!import techniques/water/shaders/seen_iteration
//!import techniques/water/shaders/seen_march
//!import techniques/water/shaders/seen_point
//!import techniques/water/shaders/seen_rays

override WATER_REFRACTION: u32 = 0u;  // water_quality.REFRACTIONS
override WATER_REFLECTION: u32 = 0u;  // water_quality.REFLECTIONS

fn seen_below(p_ws: vec3f, direction_ws: vec3f) -> Seen {
    if WATER_REFRACTION == 1u {
        return seen_march(p_ws, direction_ws, true);
    }
    if WATER_REFRACTION == 2u {
        return seen_iteration(p_ws, direction_ws);
    }
    return seen_rays(p_ws, direction_ws, true);
}

fn seen_above(p_ws: vec3f, direction_ws: vec3f) -> Seen {
    if WATER_REFLECTION == 1u {
        return seen_march(p_ws, direction_ws, false);
    }
    if WATER_REFLECTION == 2u {
        return seen_point(p_ws, direction_ws);
    }
    if WATER_REFLECTION == 3u {
        return Seen(environment_radiance(direction_ws), WATER_FAR, false);
    }
    return seen_rays(p_ws, direction_ws, false);
}

// Either of them. Where both send rays there is one place that does: all pixels would execute each.
fn seen_along(p_ws: vec3f, direction_ws: vec3f, below: bool) -> Seen {
    if WATER_REFRACTION == 0u && WATER_REFLECTION == 0u {
        return seen_rays(p_ws, direction_ws, below);
    }
    if below {
        return seen_below(p_ws, direction_ws);
    }
    return seen_above(p_ws, direction_ws);
}
