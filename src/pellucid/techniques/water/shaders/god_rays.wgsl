// Beams that waves and shadows cut out of the light in the water, by a march through slices of it.
//!import surroundings/shaders/submersion
//!import surroundings/shaders/beam
//!import techniques/water/shaders/bindings

@group(0) @binding(26) var caustic_slices: texture_3d<f32>;  // what comes to each depth, over that under a level surface
@group(0) @binding(27) var caustic_slice_sampler: sampler;

const GOD_RAY_STEPS = 24u;
const GOD_RAY_FAINT = 4.6;  // optical depth after which nothing is told apart: 1 %

// Each step holds the closed form of its part of the way, times what the slices say in one place of it, which differs
// from pixel to pixel [jimenez2014] and from picture to picture. What is beyond the steps is even.
fn god_rays(beam: WaterBeam, p_ws: vec3f, direction_ws: vec3f, length_m: f32, slope: vec2f) -> vec3f {
    let least = min(beam.loss.r, min(beam.loss.g, beam.loss.b));
    let seen_m = min(length_m, GOD_RAY_FAINT / max(least, 1e-3));
    let step_m = seen_m / f32(GOD_RAY_STEPS);
    let offset = god_ray_offset(p_ws + direction_ws);
    var radiance = vec3f(0.0);
    for (var k = 0u; k <= GOD_RAY_STEPS; k++) {
        let begun_m = f32(k) * step_m;
        let start = p_ws + begun_m * direction_ws;
        let beyond = k == GOD_RAY_STEPS;
        let part_m = select(step_m, max(length_m - seen_m, 0.0), beyond);
        let gained = beam_inscatter(beam, max(water.level - start.y, 0.0), direction_ws.y, part_m);
        let light = god_ray_light(start + offset * step_m * direction_ws, slope);
        radiance += exp(-beam.loss * begun_m) * gained * select(light, 1.0, beyond);
    }
    return radiance;
}

fn god_ray_light(p_ws: vec3f, slope: vec2f) -> f32 {
    let entry = submerged_entry(p_ws, water.level, slope);
    let uv = (entry - water.low) / (water.high - water.low);
    let depth = (water.level + water.wave_high - p_ws.y) / submersion.level[water.region].w;
    let light = textureSampleLevel(caustic_slices, caustic_slice_sampler, vec3f(uv, depth), 0.0).r;
    return select(1.0, light, all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0)));
}

// 0 to 1 by the pixel that shows a point: neighbours differ, and nine of them have nearly even steps [jimenez2014]
fn god_ray_offset(p_ws: vec3f) -> f32 {
    let clip = frame.clip_from_world * vec4f(p_ws, 1.0);
    let pixel = floor((0.5 + 0.5 * clip.xy / max(abs(clip.w), 1e-6)) * frame.size) + 5.588238 * f32(frame.sample_index);
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}
