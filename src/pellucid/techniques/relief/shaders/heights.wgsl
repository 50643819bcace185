// Heights and slopes of both layers at a place.
//!import techniques/relief/shaders/bindings

override TWO_LAYERS: bool = false;  // whether there is a translucent layer

// Row 0 of a map is its top
fn relief_map_uv(uv: vec2f) -> vec2f {
    return vec2f(uv.x, 1.0 - uv.y);
}

// Heights of the solid and the translucent layer, metres, bilinear between texel centres
fn relief_heights(uv: vec2f) -> vec2f {
    let both = textureSampleLevel(height_map, height_sampler, relief_map_uv(uv), 0.0).rg;
    return vec2f(both.x, select(both.x - 1.0, both.y, TWO_LAYERS));
}

// Level of the slope maps whose texels are as large as `footprint` tiles
fn relief_surface_level(footprint: f32) -> f32 {
    let texels = vec2f(textureDimensions(solid_surface)) * footprint;
    return max(log2(max(max(texels.x, texels.y), 1e-6)), 0.0);
}

fn relief_solid_slopes(uv: vec2f, level: f32) -> vec2f {
    return textureSampleLevel(solid_surface, surface_sampler, relief_map_uv(uv), level).rg;
}

fn relief_translucent_slopes(uv: vec2f, level: f32) -> vec2f {
    return textureSampleLevel(translucent_surface, surface_sampler, relief_map_uv(uv), level).rg;
}
