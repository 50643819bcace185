// Steepest slope, trough and crest of all layers of waves together, from those of ripples on the device.
//!struct RippleMap from techniques.water.layouts

@group(0) @binding(0) var<uniform> ripple_map: RippleMap;
@group(0) @binding(1) var<storage, read> ripple_extremes: array<u32, 3>;
@group(0) @binding(2) var<storage, read_write> ripple_limits: array<f32, 3>;

// What in_order of ripple_texels.wgsl was given
fn out_of_order(bits: u32) -> f32 {
    return bitcast<f32>(select(~bits, bits & 0x7fffffffu, (bits & 0x80000000u) != 0u));
}

@compute @workgroup_size(1)
fn main() {
    ripple_limits[0] = ripple_map.others.x + sqrt(out_of_order(ripple_extremes[0]));
    ripple_limits[1] = ripple_map.others.y - out_of_order(ripple_extremes[1]);
    ripple_limits[2] = ripple_map.others.z + out_of_order(ripple_extremes[2]);
}
