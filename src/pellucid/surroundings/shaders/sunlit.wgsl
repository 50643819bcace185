// Light that the map of a water tells of, onto what stays the same while waves move: see shading_apart.wgsl.
//!import surroundings/shaders/camera
//!import surroundings/shaders/full_picture
//!import surroundings/shaders/submerged_sky
//!import surroundings/shaders/submerged_sun

@group(0) @binding(0) var shaded_rest: texture_2d<f32>;
@group(0) @binding(1) var shaded_sun: texture_2d<u32>;

// What is the same for all pixels
struct SunlitVarying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) passed: vec3f,
    @location(1) @interpolate(flat) aside: vec3f,   // way over depth as the third
    @location(2) @interpolate(flat) astray: vec2f,
}

@vertex
fn vs_sunlit(@builtin(vertex_index) vertex: u32) -> SunlitVarying {
    let to_light = lights[submerged_sun()].direction;
    let beam = submerged_beam(to_light, submerged_direction(to_light, submersion.index[0].g), 0u);
    return SunlitVarying(full_picture(vertex), beam.passed, vec3f(beam.aside, beam.longer), beam.astray);
}

@fragment
fn fs_main(in: SunlitVarying) -> @location(0) vec4f {
    let pixel = vec2i(in.position.xy);
    let rest = textureLoad(shaded_rest, pixel, 0);
    let kept = textureLoad(shaded_sun, pixel, 0);
    let sun = vec4f(unpack2x16float(kept.x), unpack2x16float(kept.y));
    let p_ws = camera_point(in.position.xy, bitcast<f32>(kept.z));
    let beam = SubmergedBeam(in.passed, in.aside.xy, in.aside.z, in.astray);
    let share = submerged_share(beam, 0, p_ws, 0u, sun.a);
    return vec4f(rest.rgb * mix(vec3f(1.0), sunlit_depth(p_ws), rest.a) + sun.rgb * share, 1.0);
}

// What waves take from the light of the sky, which was worked out for level water; 1 where there is none
fn sunlit_depth(p_ws: vec3f) -> vec3f {
    let level = submersion.level[0];
    let inside = submerged_within(0u, p_ws) && p_ws.y < level.x + level.y;
    let at_rest_m = level.x - p_ws.y;
    let more_m = max(at_rest_m + submerged_wave(0u, p_ws.xz), 0.0) - max(at_rest_m, 0.0);
    return select(vec3f(1.0), exp(-submerged_attenuation(0u) * more_m), inside);
}
