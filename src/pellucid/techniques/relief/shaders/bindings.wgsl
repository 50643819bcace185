// What a relief is made of, as group 0. A pass binds only the names that it uses; what a relief has not is one texel.
//!struct ReliefParams from techniques.relief.layouts
//!struct ReliefVertex from techniques.relief.layouts

@group(0) @binding(0) var<uniform> relief: ReliefParams;
@group(0) @binding(1) var height_map: texture_2d<f32>;  // solid, translucent; metres
@group(0) @binding(2) var height_sampler: sampler;
@group(0) @binding(3) var height_bounds: texture_2d<f32>;  // with levels: solid max, min, translucent max, min
@group(0) @binding(4) var solid_surface: texture_2d<f32>;  // slopes, metres a metre
@group(0) @binding(5) var translucent_surface: texture_2d<f32>;
@group(0) @binding(6) var color_map: texture_2d<f32>;
@group(0) @binding(7) var surface_sampler: sampler;
@group(0) @binding(8) var relief_vertices: texture_2d<f32>;  // three a triangle, five texels each
@group(0) @binding(9) var relief_hits: texture_2d<u32>;
@group(0) @binding(10) var distance_map: texture_3d<f32>;
@group(0) @binding(11) var cone_map: texture_2d<f32>;
@group(0) @binding(12) var horizon_map: texture_2d_array<f32>;
@group(0) @binding(13) var complexity_map: texture_2d<f32>;
@group(0) @binding(14) var light_map: texture_2d_array<f32>;  // a layer a light: share that reaches the solid layer
@group(0) @binding(15) var relief_caustic_map: texture_2d_array<f32>;  // a layer a light
@group(0) @binding(16) var scene_cube: texture_cube<f32>;  // what is around the object
