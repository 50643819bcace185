// Light that level water scatters towards a viewer along a straight way, once, in closed form: that of lamps far away, and
// of the sky.
//!import optics/phase
//!import surroundings/shaders/beam
//!import surroundings/shaders/environment
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

const SCATTER_DOWN = 33u;    // layouts.SCATTER_DOWN
const SCATTER_AROUND = 16u;  // layouts.SCATTER_AROUND

// The sky as one beam: what all directions of Snell's window send into the way, with the mean of their angles and of how
// steeply they come (sky_scatter.py)
fn sky_beam(water: u32, direction_ws: vec3f) -> WaterBeam {
    let at = environment_uv(environment_space(direction_ws)) * vec2f(f32(SCATTER_AROUND), f32(SCATTER_DOWN - 1u));
    let row = min(floor(at.y), f32(SCATTER_DOWN - 2u));
    let column = floor(at.x - 0.5);
    let share = vec2f(at.x - 0.5 - column, at.y - row);
    var logarithm = vec3f(0.0);
    var means = vec2f(0.0);
    for (var k = 0u; k < 4u; k++) {
        let corner = vec2u(k & 1u, k >> 1u);
        let around = (u32(column + f32(SCATTER_AROUND)) + corner.x) % SCATTER_AROUND;
        let entry = submersion.scatter[(water * SCATTER_DOWN + u32(row) + corner.y) * SCATTER_AROUND + around];
        let weight = mix(1.0 - share, share, vec2f(corner));
        logarithm += weight.x * weight.y * entry.rgb;
        means += weight.x * weight.y * unpack2x16float(bitcast<u32>(entry.a));
    }
    let scattered = frame.environment_intensity * exp2(logarithm) * submersion.scattering[water].rgb;
    return WaterBeam(scattered, beam_attenuation(water, -1.0) * means.y, beam_attenuation(water, means.x));
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
