// Lamps mirrored in the translucent layer.
//!import optics/fresnel
//!import surroundings/shaders/lights
//!import surroundings/shaders/shade
//!import techniques/relief/shaders/frame

// A GGX lobe [walter2007] with the exact reflectance of its facets; radiance as it is, times a factor on request
fn relief_glints(p_ws: vec3f, n_ws: vec3f, view_ws: vec3f) -> vec3f {
    let alpha = max(relief.translucent_roughness * relief.translucent_roughness, SHADE_MIN_ALPHA);
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    var radiance = vec3f(0.0);
    for (var light = 0u; light < light_count(); light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            let sample = sample_light(light, k, p_ws, n_ws);
            let n_dot_l = dot(n_ws, sample.direction);
            if n_dot_l > 0.0 {
                let facet = normalize(sample.direction + view_ws);
                let lobe = ggx_distribution(saturate(dot(n_ws, facet)), alpha) * ggx_visibility(n_dot_l, n_dot_v, alpha);
                let mirrored = fresnel_dielectric(dot(view_ws, facet), relief.n_outside, relief.n_layer.g);
                radiance += lobe * mirrored * n_dot_l * sample.irradiance;
            }
        }
    }
    return relief.specular_factor * radiance;
}
