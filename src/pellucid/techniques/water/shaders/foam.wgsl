// Foam on crests that waves fold together.
//!import surroundings/shaders/environment
//!import surroundings/shaders/lights
//!import techniques/water/shaders/waves

override WATER_FOAM: bool = false;

const FOAM_ALBEDO = 0.55;    // of fresh, dense foam [koepke1984]
const FOAM_SOFTNESS = 0.25;  // of the Jacobian, from no foam to a closed cover
const FOAM_PATCH_M = 0.35;   // size of what a cover tears into
const FOAM_PI = 3.14159265358979;

// Share of a place that foam covers. It begins where the surface is folded to less than `water.foam` of its area at rest
// [tessendorf2001, 4.6], in patches.
fn foam_cover(xz: vec2f, fold: f32, footprint_m: f32) -> f32 {
    let whole = 1.0 - smoothstep(water.foam - FOAM_SOFTNESS, water.foam, fold);
    let torn = 0.6 * foam_noise(xz / FOAM_PATCH_M) + 0.4 * foam_noise(4.0 * xz / FOAM_PATCH_M);
    let patches = smoothstep(torn, torn + 0.3, 1.3 * whole);
    return mix(patches, whole, saturate(footprint_m / FOAM_PATCH_M));
}

// Matt light of the sky and of lamps: thrown back above, let through below
fn foam_radiance(p_ws: vec3f, up_ws: vec3f, from_within: bool) -> vec3f {
    var irradiance = environment_irradiance(up_ws);
    for (var light = 0u; light < light_count(); light++) {
        for (var k = 0u; k < light_sample_count(light); k++) {
            let sample = sample_light(light, k, p_ws, up_ws);
            irradiance += sample.irradiance * max(dot(up_ws, sample.direction), 0.0);
        }
    }
    return select(FOAM_ALBEDO, 1.0 - FOAM_ALBEDO, from_within) * irradiance / FOAM_PI;
}

// Numbers at the corners of squares, 0 to 1, smooth between them
fn foam_noise(at: vec2f) -> f32 {
    let cell = floor(at);
    let share = smoothstep(vec2f(0.0), vec2f(1.0), at - cell);
    let top = mix(foam_number(cell), foam_number(cell + vec2f(1.0, 0.0)), share.x);
    let bottom = mix(foam_number(cell + vec2f(0.0, 1.0)), foam_number(cell + vec2f(1.0)), share.x);
    return mix(top, bottom, share.y);
}

// [jarzynski2020, pcg2d]
fn foam_number(cell: vec2f) -> f32 {
    var v = bitcast<vec2u>(vec2i(cell)) * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v = v ^ (v >> vec2u(16u));
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    return f32((v.x ^ (v.x >> 16u)) >> 8u) / 16777216.0;
}
