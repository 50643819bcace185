// What a body of water is made of, as group 0. A pass binds only the names that it uses; what is absent is one texel.
//!struct WaterParams from techniques.water.layouts
//!struct WaterViews from techniques.water.layouts

@group(0) @binding(0) var<uniform> water: WaterParams;
@group(0) @binding(1) var wave_map: texture_2d_array<f32>;  // height m, dh/dx, dh/dz, fold; a layer a source
@group(0) @binding(2) var wave_sampler: sampler;
@group(0) @binding(3) var wave_moments: texture_2d_array<f32>;  // with levels: mean and second moments of slopes
@group(0) @binding(4) var water_hits: texture_2d<f32>;  // what the search found, see hit.wgsl
@group(0) @binding(5) var picture_colors: texture_2d_array<f32>;  // of what lies below the surface, above it
@group(0) @binding(6) var picture_depths: texture_2d_array<f32>;  // reversed
@group(0) @binding(7) var picture_sampler: sampler;
@group(0) @binding(9) var view_sampler: sampler;
@group(0) @binding(10) var<uniform> water_views: WaterViews;
@group(0) @binding(11) var opaque_color: texture_2d<f32>;  // what was drawn before
@group(0) @binding(8) var water_blocks: texture_2d<f32>;  // radiance and reversed depth of blocks of pixels, 0 for no water
@group(0) @binding(12) var opaque_depth: texture_depth_2d;
