// Light that water scatters towards the viewer along a straight way, once, in closed form: that of lamps far away, and of
// the sky.
//!import optics/phase
//!import surroundings/shaders/lights
//!import surroundings/shaders/submerged_sky
//!import surroundings/shaders/submerged_sun
//!import techniques/water/shaders/beam
//!import techniques/water/shaders/bindings
//!import techniques/water/shaders/god_rays

override WATER_GOD_RAYS: bool = false;

fn water_inscatter(p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> vec3f {
    var radiance = sky_inscatter(p_ws, direction_ws, length_m);
    for (var light = 0u; light < light_count(); light++) {
        let towards = lights[light].direction;
        if lights[light].kind != LIGHT_DIRECTIONAL || towards.y <= 0.0 {
            continue;
        }
        let to_light = submerged_direction(towards, water.n_water.g / water.n_outside);
        let share = 1.0 - submerged_reflectance(towards.y, water.n_water / water.n_outside);
        let irradiance = lights[light].power * share * towards.y / to_light.y;
        let beam = sun_beam(to_light, direction_ws, irradiance);
        if WATER_GOD_RAYS && lights[light].water_layer == 0 {
            radiance += god_rays(beam, p_ws, direction_ws, length_m, to_light.xz / to_light.y);
        } else {
            radiance += beam_inscatter(beam, max(water.level - p_ws.y, 0.0), direction_ws.y, length_m);
        }
    }
    return radiance;
}

// A lamp far away over level water: its irradiance just below the surface, across the refracted beam
fn sun_beam(to_light: vec3f, direction_ws: vec3f, irradiance: vec3f) -> WaterBeam {
    let cosine = dot(to_light, direction_ws);
    let attenuation = water_attenuation(cosine);
    let scattered = irradiance * water.scattering * henyey_greenstein(cosine, water.asymmetry);
    return WaterBeam(scattered, water_attenuation(-1.0) / to_light.y, attenuation);
}

// The sky as one broad beam, the light of an even patch as wide as Snell's window: its mean cosine to its middle is
// (1 + cos)/2 of its half angle. Smeared over it, the phase function is one of a mean cosine as much less.
fn sky_inscatter(p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> vec3f {
    let mean = 0.5 + 0.5 * sqrt(1.0 - submersion.window[water.region].a);
    let cosine = dot(environment_space(direction_ws), submersion.sky_axis[water.region].xyz);
    let attenuation = water_attenuation(cosine);
    let irradiance = frame.environment_intensity * submersion.sky[water.region].rgb / mean;
    let scattered = irradiance * water.scattering * henyey_greenstein(cosine, water.asymmetry * mean);
    let beam = WaterBeam(scattered, water_attenuation(-1.0) / mean, attenuation);
    return beam_inscatter(beam, max(water.level - p_ws.y, 0.0), direction_ws.y, length_m);
}

// 1/m, of light on its way to the viewer that is scattered by an angle of that cosine. What comes from behind the viewer
// has lost what is absorbed or turned back, (1 - g)/2 of what is scattered, as a + b_b [gordon1973]; what comes from
// ahead has lost all that is scattered: else the same light would be scattered into the way again and again. Between
// them it is taken to change evenly with the cosine. Down to the depth where it is scattered all light loses a + b_b.
fn water_attenuation(cosine: f32) -> vec3f {
    let turned = mix(1.0, 0.5 * (1.0 - water.asymmetry), 0.5 - 0.5 * clamp(cosine, -1.0, 1.0));
    return water.absorption + turned * water.scattering;
}
