// The light of each cell is spread over the parallelogram between its neighbours' landings, and over the picture of the
// lamp: along each axis by the projection of that, a trapezoid. Places of neighbours touch, so that what is spread apart
// stays even, and nothing is lost but rounding, which goes on to the next texel.
//!import techniques/water/shaders/caustic_cells

const SPLAT_WIDEST = 6.0;     // texels
const SPLAT_TORN = 12.0;      // texels: what lies farther apart was parted by an edge
const SPLAT_SHARPEST = 0.05;  // texels, of the picture of a lamp
const SPLAT_TEXELS = 10.0;

// A trapezoid over the middles of texels, and those that it touches
struct Spread {
    middle: f32,
    wide: f32,
    narrow: f32,
    first: f32,
    last: f32,
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= caustic_side() {
        return;
    }
    let beam = caustic_beams[caustic_cell(id.xy, id.z)];
    if beam.flux <= 0.0 {
        return;
    }
    let along = landed_beside(id, vec2i(1, 0), beam.landed);
    let across = landed_beside(id, vec2i(0, 1), beam.landed);
    let texel_m = (water.high - water.low) / f32(caustic_side());
    let lamp = 2.0 * caustic.sun_slope * beam.depth_m / texel_m;
    let over_x = spread(along.x, along.z, across.z, lamp.x);
    let over_y = spread(across.y, across.w, along.w, lamp.y);
    let side = f32(caustic_side());
    let row = id.z * caustic_side();
    var rest = 0.5;
    var below_y = 0.0;
    for (var y = over_y.first; y <= over_y.last; y += 1.0) {
        let until_y = spread_below(over_y, y + 1.0);
        let units = beam.flux * CAUSTIC_UNITS * (until_y - below_y);
        below_y = until_y;
        var below_x = 0.0;
        for (var x = over_x.first; x <= over_x.last; x += 1.0) {
            let until_x = spread_below(over_x, x + 1.0);
            let value = units * (until_x - below_x) + rest;
            below_x = until_x;
            let whole = floor(value);
            rest = value - whole;
            if min(x, y) >= 0.0 && max(x, y) < side && whole > 0.0 {
                atomicAdd(&caustic_sums[(row + u32(y)) * caustic_side() + u32(x)], u32(whole));
            }
        }
    }
}

// Middle and width of the place between the neighbours of a cell on both sides, in texels
fn landed_beside(id: vec3u, step: vec2i, here: vec2f) -> vec4f {
    let before = landed_at(vec2i(id.xy) - step, id.z, here, step);
    let after = landed_at(vec2i(id.xy) + step, id.z, here, -step);
    return vec4f(0.25 * before + 0.5 * here + 0.25 * after, 0.5 * (after - before));
}

// Beyond the border, and beyond an edge, cells go on as they do on the other side
fn landed_at(cell: vec2i, channel: u32, here: vec2f, back: vec2i) -> vec2f {
    let side = i32(caustic_side());
    let outside = any(cell < vec2i(0)) || any(cell >= vec2i(side));
    let asked = select(cell, cell + 2 * back, outside);
    let found = caustic_beams[caustic_cell(vec2u(clamp(asked, vec2i(0), vec2i(side - 1))), channel)].landed;
    let way = select(found - here, here - found, outside);
    return here + select(way, -vec2f(back), any(abs(way) > vec2f(SPLAT_TORN)));
}

// Texels under a box of one width seen through a box of another: differences of its integral. The narrower box takes
// the lamp's picture into it: the wider one must go on to touch its neighbours.
fn spread(middle: f32, one: f32, other: f32, lamp: f32) -> Spread {
    let sides = min(abs(vec2f(one, other)), vec2f(SPLAT_WIDEST));
    let smaller = min(min(sides.x, sides.y) + min(lamp, SPLAT_WIDEST), 0.4 * SPLAT_WIDEST);
    let wide = max(max(max(sides.x, sides.y), smaller), SPLAT_SHARPEST);
    let narrow = max(min(max(sides.x, sides.y), smaller), SPLAT_SHARPEST);
    let reach = 0.5 * (wide + narrow);
    let first = floor(middle - reach);
    return Spread(middle, wide, narrow, first, min(ceil(middle + reach) - 1.0, first + SPLAT_TEXELS));
}

// Share that lies below x
fn spread_below(over: Spread, x: f32) -> f32 {
    let from_middle = abs(x - over.middle);
    let from_edge = clamp(0.5 * (over.wide + over.narrow) - from_middle, 0.0, over.narrow);
    let even = from_middle / over.wide;
    let ramp = 0.5 - 0.5 * from_edge * from_edge / (over.wide * over.narrow);
    let half = select(ramp, even, from_middle <= 0.5 * (over.wide - over.narrow));
    return 0.5 + select(half, -half, x < over.middle);
}
