// Lamps mirrored in the translucent layer.
//!import optics/fresnel
//!import surroundings/shaders/lights
//!import surroundings/shaders/shade
//!import techniques/relief/shaders/frame

const GLINT_LEAST = 1e-4;  // 1/sr: a 3000th of what white paper sends

// A GGX lobe [walter2007] with the exact reflectance of its facets; radiance as it is, times a factor on request
fn relief_glints(p_ws: vec3f, n_ws: vec3f, view_ws: vec3f) -> vec3f {
    let alpha = max(relief.translucent_roughness * relief.translucent_roughness, SHADE_MIN_ALPHA);
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    var radiance = vec3f(0.0);
    for (var light = 0u; light < light_count(); light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            let towards = light_direction(light, k, p_ws);
            let n_dot_l = dot(n_ws, towards);
            let facet = normalize(towards + view_ws);
            let lobe = ggx_distribution(saturate(dot(n_ws, facet)), alpha) * ggx_visibility(n_dot_l, n_dot_v, alpha);
            let mirrored = lobe * n_dot_l * fresnel_dielectric(dot(view_ws, facet), relief.n_outside, relief.n_layer.g);
            // Most places mirror no lamp: no ray to it from there
            if n_dot_l > 0.0 && relief.specular_factor * mirrored > GLINT_LEAST {
                radiance += mirrored * sample_light(light, k, p_ws, n_ws).irradiance;
            }
        }
    }
    return relief.specular_factor * radiance;
}
