// What a sheet is made of, as group 0. A pass binds only the names that it uses.
//!struct SheetParams from techniques.sheet.layouts
//!struct SheetVertex from techniques.sheet.layouts

@group(0) @binding(0) var<uniform> sheet: SheetParams;
@group(0) @binding(1) var<storage, read> sheet_vertices: array<SheetVertex>;
@group(0) @binding(2) var sheet_picture: texture_2d<f32>;  // with levels; row 0 at the least z
@group(0) @binding(3) var sheet_sampler: sampler;
@group(0) @binding(4) var sheet_sphere_map: texture_2d<f32>;
