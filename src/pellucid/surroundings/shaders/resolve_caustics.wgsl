// Sums of flux become irradiance: divided by the surface that each texel stands for, and the coarse levels of a chart
// added to its finest.
//!import surroundings/shaders/charts
//!import surroundings/shaders/full_picture
//!struct LandParams from surroundings.layouts

@group(0) @binding(0) var<uniform> landing: LandParams;
@group(0) @binding(1) var<storage, read> flux_sums: array<i32>;
@group(0) @binding(2) var<storage, read> chart_area: array<f32>;
@group(0) @binding(3) var<storage, read> chart_owner: array<u32>;

override MOST: f32 = 3.0e38;  // the largest number that the maps hold

struct Maps {
    @location(0) caustic: vec4f,
    @location(1) blocked: vec4f,
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> Maps {
    let texel = u32(position.y) * landing.width + u32(position.x);
    let chart = chart_owner[texel];
    var maps = irradiance(vec2i(position.xy));
    let finest = chart_bounds(chart, 0u);
    var before = finest;
    for (var level = 1u; level < CHART_LEVELS; level++) {
        let bounds = chart_bounds(chart, level);
        if chart != 0u && any(bounds != before) {
            let coarse = irradiance_between(between_levels(position.xy, finest, bounds), bounds);
            maps.caustic += coarse.caustic;
            maps.blocked += coarse.blocked;
        }
        before = bounds;
    }
    return Maps(min(maps.caustic, vec4f(MOST)), min(maps.blocked, vec4f(MOST)));
}

// Bilinear, level at the rim of the chart
fn irradiance_between(at: vec2f, bounds: vec4f) -> Maps {
    let base = floor(at - 0.5);
    let share = at - 0.5 - base;
    var out = Maps(vec4f(0.0), vec4f(0.0));
    for (var k = 0u; k < 4u; k++) {
        let step = vec2f(f32(k & 1u), f32(k >> 1u));
        let weight = mix(1.0 - share, share, step);
        let there = irradiance(vec2i(clamp(base + step, bounds.xy, bounds.zw - 1.0)));
        out.caustic += weight.x * weight.y * there.caustic;
        out.blocked += weight.x * weight.y * there.blocked;
    }
    return out;
}

fn irradiance(at: vec2i) -> Maps {
    let texel = u32(at.y) * landing.width + u32(at.x);
    let area = chart_area[texel];
    let scale = select(0.0, 1.0 / (area * landing.units_per_flux), area > 0.0);
    return Maps(scale * units(6u * texel), scale * units(6u * texel + 3u));
}

fn units(first: u32) -> vec4f {
    return vec4f(f32(flux_sums[first]), f32(flux_sums[first + 1u]), f32(flux_sums[first + 2u]), 0.0);
}
