// Sums of flux become irradiance: divided by the surface that each texel stands for.
//!import surroundings/shaders/full_picture
//!struct LandParams from surroundings.layouts

@group(0) @binding(0) var<uniform> landing: LandParams;
@group(0) @binding(1) var<storage, read> flux_sums: array<i32>;
@group(0) @binding(2) var<storage, read> chart_area: array<f32>;

override MOST: f32 = 3.0e38;  // the largest number that the maps hold

struct Maps {
    @location(0) caustic: vec4f,
    @location(1) blocked: vec4f,
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> Maps {
    let texel = u32(position.y) * landing.width + u32(position.x);
    let area = chart_area[texel];
    let scale = select(0.0, 1.0 / (area * landing.units_per_flux), area > 0.0);
    return Maps(vec4f(irradiance(6u * texel, scale), 1.0), vec4f(irradiance(6u * texel + 3u, scale), 1.0));
}

fn irradiance(first: u32, scale: f32) -> vec3f {
    let units = vec3f(f32(flux_sums[first]), f32(flux_sums[first + 1u]), f32(flux_sums[first + 2u]));
    return min(units * scale, vec3f(MOST));
}
