// Radiance of the solid layer, in the open or under the translucent one: Lambert under GGX, as the surroundings shade
// a mesh.
//!import surroundings/shaders/shade
//!import techniques/relief/shaders/light
//!import techniques/relief/shaders/diffuse
//!import techniques/relief/shaders/footprint

override RELIEF_NORMALS: bool = true;  // whether slopes turn the normal

fn relief_color(uv: vec2f, footprint: f32) -> vec3f {
    let texels = vec2f(textureDimensions(color_map)) * footprint;
    let level = max(log2(max(max(texels.x, texels.y), 1e-6)), 0.0);
    return relief.color * textureSampleLevel(color_map, surface_sampler, relief_map_uv(uv), level).rgb;
}

fn relief_solid_point(frame_at: ReliefFrame, uv: vec2f, p_ws: vec3f, footprint: f32) -> ReliefPoint {
    let slopes = select(vec2f(0.0), relief_solid_slopes(uv, relief_surface_level(footprint)), RELIEF_NORMALS);
    return ReliefPoint(uv, relief_heights(uv).x, p_ws, relief_normal(frame_at, uv, slopes), frame_at, false);
}

// Radiance towards `view_ws`, inside the translucent matter where it is `wet`. There light of lamps arrives refracted,
// that of the environment from everywhere, and what the interface throws back lights the layer again
// [saunderson1942]: 1 / (1 - albedo back). The interface lies as it does right above.
fn relief_solid_radiance(point: ReliefPoint, view_ws: vec3f, footprint: f32, is_wet: bool) -> vec3f {
    let wet = TWO_LAYERS && is_wet;
    let n_ws = point.n_ws;
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    let n_around = select(relief.n_outside, relief.n_layer.g, wet);
    let f0 = select(relief.solid_specular, relief_specular_within(relief.solid_specular), wet);
    let alpha = max(relief.solid_roughness * relief.solid_roughness, SHADE_MIN_ALPHA);
    let specular = ggx_albedo(n_dot_v, relief.solid_roughness, f0);
    let color = relief_color(point.uv, footprint);
    var above_ws = n_ws;
    var again = vec3f(1.0);
    var radiance = vec3f(0.0);
    if wet {
        above_ws = relief_normal(point.frame, point.uv, relief_translucent_slopes(point.uv, 0.0));
        let once = exp(-relief.absorption * max(relief_heights(point.uv).y - point.h, 0.0));
        let albedo = specular + (1.0 - specular) * color;
        again = 1.0 / (1.0 - albedo * relief_diffuse_back(once));
        radiance = albedo * again * relief_diffuse_down(once) * environment_irradiance(n_ws) / GGX_PI;
    } else {
        radiance = (1.0 - specular) * color * environment_irradiance(n_ws) / GGX_PI;
        radiance += specular * environment_glossy(reflect(-view_ws, n_ws), alpha);
    }
    let diffuse = (1.0 - specular) * color * again / GGX_PI;
    for (var light = 0u; light < light_count(); light++) {
        var open = vec3f(0.0);
        var direct = vec3f(0.0);
        for (var k = 0u; k < light_sample_count(light); k++) {
            let sample = sample_light(light, k, point.p_ws, select(above_ws, point.frame.N, RELIEF_CAUSTICS));
            open += sample.irradiance * max(dot(point.frame.N, sample.direction), 0.0);
            let inside = refract(-sample.direction, above_ws, relief.n_outside, n_around);
            let towards = -inside.direction;
            let n_dot_l = dot(n_ws, towards);
            if n_dot_l > 0.0 && inside.valid && any(sample.irradiance > vec3f(0.0)) {
                // A beam is as wide as the interface cuts it.
                let narrowed = max(dot(above_ws, sample.direction), 0.0) / max(dot(above_ws, towards), 1e-4);
                let brdf = diffuse + specular_lobe(n_ws, view_ws, towards, n_dot_l, n_dot_v, alpha, f0);
                direct += brdf * sample.irradiance * (narrowed * n_dot_l);
            }
        }
        // No rays through the relief to lamps that light nothing here
        if any(direct > vec3f(0.0)) {
            radiance += direct * relief_light_share(point, light);
        }
        if RELIEF_CAUSTICS {
            // Gathered on the level; a slope spreads it.
            radiance += diffuse * open * relief_caustic(point, light) * max(dot(n_ws, point.frame.N), 0.0);
        }
    }
    return radiance;
}

// Reflectance of the same coat at normal incidence when it lies in the translucent matter; what has none stays matt
fn relief_specular_within(f0: f32) -> f32 {
    let root = sqrt(min(f0, 0.98));
    return min(f0, normal_reflectance(relief.n_layer.g / relief.n_outside, (1.0 + root) / (1.0 - root)));
}
