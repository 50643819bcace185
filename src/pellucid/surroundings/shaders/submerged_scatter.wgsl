// Light that level water scatters towards a viewer along a straight way, once, in closed form: that of lamps far away, and
// of the sky.
//!import optics/phase
//!import surroundings/shaders/beam
//!import surroundings/shaders/lights
//!import surroundings/shaders/submerged_sky
//!import surroundings/shaders/submerged_sun

// All of it, radiance within the water; beams are as even as a level surface leaves them
fn submerged_inscatter(water: u32, p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> vec3f {
    let depth_m = max(submersion.level[water].x - p_ws.y, 0.0);
    var radiance = beam_inscatter(sky_beam(water, direction_ws), depth_m, direction_ws.y, length_m);
    for (var light = 0u; light < light_count(); light++) {
        if lights[light].kind == LIGHT_DIRECTIONAL && lights[light].direction.y > 0.0 {
            radiance += beam_inscatter(sun_beam(water, light, direction_ws), depth_m, direction_ws.y, length_m);
        }
    }
    return radiance;
}

// A lamp far away over level water: its irradiance just below the surface, across the refracted beam
fn sun_beam(water: u32, light: u32, direction_ws: vec3f) -> WaterBeam {
    let towards = lights[light].direction;
    let index = submersion.index[water].rgb;
    let to_light = submerged_direction(towards, index.g);
    let share = 1.0 - submerged_reflectance(towards.y, index);
    let irradiance = lights[light].power * share * towards.y / to_light.y;
    let cosine = dot(to_light, direction_ws);
    let matter = submersion.scattering[water];
    let scattered = irradiance * matter.rgb * henyey_greenstein(cosine, matter.a);
    return WaterBeam(scattered, beam_attenuation(water, -1.0) / to_light.y, beam_attenuation(water, cosine));
}

// The sky as one broad beam, the light of an even patch as wide as Snell's window: its mean cosine to its middle is
// (1 + cos)/2 of its half angle. Smeared over it, the phase function is one of a mean cosine as much less.
fn sky_beam(water: u32, direction_ws: vec3f) -> WaterBeam {
    let mean = 0.5 + 0.5 * sqrt(1.0 - submersion.window[water].a);
    let cosine = dot(environment_space(direction_ws), submersion.sky_axis[water].xyz);
    let irradiance = frame.environment_intensity * submersion.sky[water].rgb / mean;
    let matter = submersion.scattering[water];
    let scattered = irradiance * matter.rgb * henyey_greenstein(cosine, matter.a * mean);
    return WaterBeam(scattered, beam_attenuation(water, -1.0) / mean, beam_attenuation(water, cosine));
}

// 1/m, of light on its way to the viewer that is scattered by an angle of that cosine. What comes from behind the viewer
// has lost what is absorbed or turned back, (1 - g)/2 of what is scattered, as a + b_b [gordon1973]; what comes from
// ahead has lost all that is scattered: else the same light would be scattered into the way again and again. Between
// them it is taken to change evenly with the cosine. Down to the depth where it is scattered all light loses a + b_b.
fn beam_attenuation(water: u32, cosine: f32) -> vec3f {
    let matter = submersion.scattering[water];
    let turned = mix(1.0, 0.5 * (1.0 - matter.a), 0.5 - 0.5 * clamp(cosine, -1.0, 1.0));
    return submersion.absorption[water].rgb + turned * matter.rgb;
}
