// Radiance of the picture by the square of the index, which rays lose when they leave: as it is, or lit through the sheet.
//!import surroundings/shaders/environment
//!import surroundings/shaders/lights
//!import optics/fresnel
//!import techniques/sheet/shaders/bindings

override SHEET_LIT: bool = false;

fn sheet_picture_radiance(uv: vec2f, lod: f32, xz: vec2f) -> vec3f {
    let color = textureSampleLevel(sheet_picture, sheet_sampler, uv, lod).rgb;
    if !SHEET_LIT {
        return color;
    }
    let up_ws = normalize(sheet.world_from_object[1].xyz);
    let above_ws = (sheet.world_from_object * vec4f(xz.x, 0.0, xz.y, 1.0)).xyz;
    var irradiance = sheet.diffuse_down * environment_irradiance(up_ws);
    for (var light = 0u; light < light_count(); light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            irradiance += sheet_lamp_irradiance(light, k, above_ws, up_ws);
        }
    }
    // What the interface throws back lights the picture again [saunderson1942]
    let n = sheet.n_inside / sheet.n_outside;
    let albedo = min(color, vec3f(1.0));
    return albedo * irradiance / (ENVIRONMENT_PI * n * n * (1.0 - albedo * sheet.diffuse_back));
}

// Irradiance of a lamp on the picture, through the sheet as if it were level: Snell, Fresnel, exp(-a s). Shadows are
// those where the ray enters; beside the sheet nothing does.
fn sheet_lamp_irradiance(light: u32, k: u32, above_ws: vec3f, up_ws: vec3f) -> vec3f {
    let near = lights[light].kind != LIGHT_DIRECTIONAL;
    let towards = normalize(select(lights[light].direction, lights[light].position - above_ws, near));
    let n = sheet.n_inside / sheet.n_outside;
    let cosine = dot(towards, up_ws);
    let cos_inside = sqrt(max(1.0 - (1.0 - cosine * cosine) / (n * n), 1e-6));
    let depth_m = sheet.depth * sheet.scale;
    let enters_ws = above_ws + depth_m / (n * cos_inside) * (towards - cosine * up_ws);
    let sample = sample_light(light, k, enters_ws, up_ws);
    let cos_i = dot(sample.direction, up_ws);
    let enters = ((sheet.object_from_world * vec4f(enters_ws, 1.0)).xz - sheet.extents_low) / sheet.extents_size;
    let through = select(0.0, 1.0, all(enters >= vec2f(0.0)) && all(enters <= vec2f(1.0)));
    let passes = 1.0 - fresnel_dielectric(cos_i, sheet.n_outside, sheet.n_inside);
    return through * passes * max(cos_i, 0.0) * sample.irradiance * exp(-sheet.absorption * depth_m / cos_inside);
}
