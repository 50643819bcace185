// Lamps mirrored in the waves.
//!import surroundings/shaders/lights
//!import techniques/water/shaders/bindings

// Radiance towards the viewer, from the side that `n_ws` is on; `variance` is that of the slopes
fn water_glitter(p_ws: vec3f, n_ws: vec3f, view_ws: vec3f, variance: vec3f) -> vec3f {
    return vec3f(0.0);
}
