// Radiance of the solid layer: Lambert under GGX, as the surroundings shade a mesh.
//!import surroundings/shaders/shade
//!import techniques/relief/shaders/light
//!import techniques/relief/shaders/diffuse

override RELIEF_NORMALS: bool = true;  // whether slopes turn the normal

fn relief_color(uv: vec2f, footprint: f32) -> vec3f {
    let texels = vec2f(textureDimensions(color_map)) * footprint;
    let level = max(log2(max(max(texels.x, texels.y), 1e-6)), 0.0);
    return relief.color * textureSampleLevel(color_map, surface_sampler, relief_map_uv(uv), level).rgb;
}

// Tiles that a pixel covers at a point
fn relief_footprint(frame_at: ReliefFrame, p_ws: vec3f, direction_ws: vec3f) -> f32 {
    let cosine = clamp(-dot(frame_at.N, direction_ws), 0.05, 1.0);
    let side = max(min(length(frame_at.T), length(frame_at.B)), 1e-9);
    return footprint_m(p_ws) * inverseSqrt(cosine) / side;
}

fn relief_solid_point(frame_at: ReliefFrame, uv: vec2f, p_ws: vec3f, footprint: f32) -> ReliefPoint {
    let level = relief_surface_level(footprint);
    let slopes = select(vec2f(0.0), relief_solid_slopes(uv, level), RELIEF_NORMALS);
    return ReliefPoint(uv, relief_heights(uv).x, p_ws, relief_normal(frame_at, uv, slopes), frame_at);
}

// Where nothing translucent covers it
fn relief_solid_dry(point: ReliefPoint, view_ws: vec3f, footprint: f32) -> vec3f {
    let n_ws = point.n_ws;
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    let f0 = relief.solid_specular;
    let alpha = max(relief.solid_roughness * relief.solid_roughness, SHADE_MIN_ALPHA);
    let specular = ggx_albedo(n_dot_v, relief.solid_roughness, f0);
    let diffuse = (1.0 - specular) * relief_color(point.uv, footprint) / GGX_PI;
    var radiance = diffuse * environment_irradiance(n_ws);
    radiance += specular * environment_glossy(reflect(-view_ws, n_ws), alpha);
    for (var light = 0u; light < frame.light_count; light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            let sample = sample_light(light, k, point.p_ws, n_ws);
            let n_dot_l = dot(n_ws, sample.direction);
            if n_dot_l > 0.0 && any(sample.irradiance > vec3f(0.0)) {
                let brdf = diffuse + specular_lobe(n_ws, view_ws, sample.direction, n_dot_l, n_dot_v, alpha, f0);
                radiance += brdf * sample.irradiance * n_dot_l * relief_light_share(point, light, sample.direction);
            }
        }
    }
    return radiance;
}

// Radiance inside the translucent matter that covers the solid layer. Light of lamps arrives refracted; that of the
// environment from everywhere; what the interface throws back lights the layer again [saunderson1942]
fn relief_solid_wet(point: ReliefPoint, view_ws: vec3f, footprint: f32, above_ws: vec3f) -> vec3f {
    let n_ws = point.n_ws;
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    let f0 = relief_specular_within(relief.solid_specular, relief.n_layer.g / relief.n_outside);
    let alpha = max(relief.solid_roughness * relief.solid_roughness, SHADE_MIN_ALPHA);
    let specular = ggx_albedo(n_dot_v, relief.solid_roughness, f0);
    let color = relief_color(point.uv, footprint);
    let albedo = specular + (1.0 - specular) * color;
    let depth_m = max(relief_heights(point.uv).y - point.h, 0.0);
    let once = exp(-relief.absorption * depth_m);
    let again = 1.0 / (1.0 - albedo * relief_diffuse_back(once));
    var radiance = albedo * again * relief_diffuse_down(once) * environment_irradiance(n_ws) / GGX_PI;
    let diffuse = (1.0 - specular) * color * again / GGX_PI;
    for (var light = 0u; light < frame.light_count; light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            let sample = sample_light(light, k, point.p_ws, above_ws);
            let cos_i = dot(above_ws, sample.direction);
            let inside = refract(-sample.direction, above_ws, relief.n_outside, relief.n_layer.g);
            let towards = -inside.direction;
            let n_dot_l = dot(n_ws, towards);
            if cos_i > 0.0 && n_dot_l > 0.0 && inside.valid && any(sample.irradiance > vec3f(0.0)) {
                let narrowed = cos_i / max(dot(above_ws, towards), 1e-4);  // a beam is as wide as the interface cuts it
                let brdf = diffuse + specular_lobe(n_ws, view_ws, towards, n_dot_l, n_dot_v, alpha, f0);
                let share = relief_light_share(point, light, sample.direction);
                radiance += brdf * sample.irradiance * (narrowed * n_dot_l) * share;
            }
        }
    }
    return radiance;
}

// Reflectance of the same coat at normal incidence when it lies in a medium of relative index n
fn relief_specular_within(f0: f32, n: f32) -> f32 {
    let root = sqrt(min(f0, 0.98));
    return normal_reflectance(n, (1.0 + root) / (1.0 - root));
}
