// What every ray may ask of its surroundings, as group 1. A pass binds only the names that it uses.
//!struct FrameParams from surroundings.layouts
//!struct BvhNode from surroundings.layouts
//!struct BvhTriangle from surroundings.layouts
//!struct TriangleAttributes from surroundings.layouts
//!struct Material from surroundings.layouts
//!struct Light from surroundings.layouts
//!struct SubmersionParams from surroundings.layouts

@group(1) @binding(0) var<uniform> frame: FrameParams;
@group(1) @binding(1) var env_map: texture_2d<f32>;
@group(1) @binding(2) var env_sampler: sampler;
@group(1) @binding(3) var<storage, read> bvh_nodes: array<BvhNode>;
@group(1) @binding(4) var<storage, read> bvh_triangles: array<BvhTriangle>;
@group(1) @binding(5) var<storage, read> triangle_attributes: array<TriangleAttributes>;
@group(1) @binding(6) var<storage, read> materials: array<Material>;
@group(1) @binding(7) var<storage, read> lights: array<Light>;
@group(1) @binding(8) var base_color_maps: texture_2d_array<f32>;
@group(1) @binding(9) var base_color_sampler: sampler;
@group(1) @binding(10) var shadow_maps: texture_depth_2d_array;
@group(1) @binding(11) var shadow_sampler: sampler_comparison;
@group(1) @binding(12) var env_glossy: texture_2d<f32>;
@group(1) @binding(13) var caustic_map: texture_2d<f32>;
@group(1) @binding(14) var blocked_map: texture_2d<f32>;
@group(1) @binding(15) var caustic_sampler: sampler;
@group(1) @binding(16) var caustic_charts: texture_2d<u32>;  // bits of floats, three texels a chart
@group(1) @binding(17) var<uniform> submersion: SubmersionParams;
@group(1) @binding(18) var submerged_light: texture_2d_array<f32>;  // what comes through a surface; its height, metres
@group(1) @binding(19) var submerged_depth: texture_depth_2d_array;  // first mesh below it along the light
@group(1) @binding(20) var<storage, read> submerged_open: array<vec4u>;  // half floats by place: see submerged_open.wgsl
