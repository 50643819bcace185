// Texels of a layer of waves from simulated heights, and the largest of three of their properties: the square of the
// steepest slope, and how far heights reach down and up. Twin of prepare.py, _steepest, and of difference_slopes of
// fields/waves/source.py.
//!struct RippleMap from techniques.water.layouts

@group(0) @binding(0) var<uniform> ripple_map: RippleMap;
@group(0) @binding(1) var ripple_heights: texture_2d<f32>;
@group(0) @binding(2) var ripple_texels_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(3) var<storage, read_write> ripple_extremes: array<atomic<u32>, 3>;

var<workgroup> group_extremes: array<atomic<u32>, 3>;

// Whole numbers in the order of the floats that they stand for
fn in_order(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

fn height_round(at: vec2i) -> f32 {
    let size = vec2i(textureDimensions(ripple_heights));
    return textureLoad(ripple_heights, (at + size) % size, 0).r;
}

fn height_held(at: vec2i) -> f32 {
    let last = vec2i(textureDimensions(ripple_heights)) - 1;
    return textureLoad(ripple_heights, clamp(at, vec2i(0), last), 0).r;
}

// Central differences, one-sided at a border that does not repeat
fn slope_at(at: vec2i) -> vec2f {
    let last = vec2i(textureDimensions(ripple_heights)) - 1;
    let right = vec2i(1, 0);
    let down = vec2i(0, 1);
    let across = vec2f(height_round(at + right) - height_round(at - right), height_round(at + down) - height_round(at - down));
    let held = vec2f(height_held(at + right) - height_held(at - right), height_held(at + down) - height_held(at - down));
    let share = select(vec2f(0.5), vec2f(1.0), (at == vec2i(0)) | (at == last));
    return select(share * held, 0.5 * across, ripple_map.repeats != 0u) / ripple_map.cell_m;
}

// Bound of the slope of the surface within a cell: along an axis it lies between those of the two edges along it
fn steepest_square(at: vec2i) -> f32 {
    let right = vec2i(1, 0);
    let down = vec2i(0, 1);
    let here = height_round(at);
    let next = vec2f(height_round(at + right), height_round(at + down));
    let beyond = height_round(at + right + down);
    let edges = abs(vec2f(next.x - here, next.y - here));
    let others = abs(vec2f(beyond - next.y, beyond - next.x));
    let either = max(edges, others) / ripple_map.cell_m;
    return dot(either, either);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if local < 3u { atomicStore(&group_extremes[local], 0u); }
    workgroupBarrier();
    let inside = all(id.xy < textureDimensions(ripple_heights));
    if inside {
        let at = vec2i(id.xy);
        let height = height_round(at);
        textureStore(ripple_texels_out, id.xy, vec4f(height, slope_at(at), 1.0));
        atomicMax(&group_extremes[0], in_order(steepest_square(at)));
        atomicMax(&group_extremes[1], in_order(-height));
        atomicMax(&group_extremes[2], in_order(height));
    }
    workgroupBarrier();
    if local < 3u {
        atomicMax(&ripple_extremes[local], atomicLoad(&group_extremes[local]));
    }
}
