// Light that a surface refracts: one beam a cell of the surface, and sums of flux in fixed point, as group 0 with the
// surface itself.
//!import techniques/water/shaders/bindings
//!struct CausticParams from techniques.water.layouts
//!struct CausticBeam from techniques.water.layouts

@group(0) @binding(20) var<uniform> caustic: CausticParams;
@group(0) @binding(21) var<storage, read_write> caustic_beams: array<CausticBeam>;  // cells by rows, channel by channel
@group(0) @binding(22) var<storage, read_write> caustic_sums: array<atomic<u32>>;  // texels likewise
@group(0) @binding(23) var caustic_below: texture_depth_2d_array;  // as surroundings/shaders/bindings: submerged_depth
@group(0) @binding(24) var caustic_above: texture_depth_2d_array;  // highest mesh over the surface along the light
@group(0) @binding(25) var caustic_map_out: texture_storage_2d_array<rgba16float, write>;
