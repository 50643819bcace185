// Light that falls on a point from everywhere, for matter that is no mesh.
//!import surroundings/shaders/environment
//!import surroundings/shaders/lights

// Irradiance on a surface element, environment (unoccluded) and lamps (with their shadows)
fn surface_irradiance(p_ws: vec3f, n_ws: vec3f) -> vec3f {
    var irradiance = environment_irradiance(n_ws);
    for (var light = 0u; light < light_count(); light++) {
        let samples = light_sample_count(light);
        for (var k = 0u; k < samples; k++) {
            let sample = sample_light(light, k, p_ws, n_ws);
            irradiance += sample.irradiance * max(dot(n_ws, sample.direction), 0.0);
        }
    }
    return irradiance;
}
