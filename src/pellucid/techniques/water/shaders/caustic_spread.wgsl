// A photon's flux is spread over the parallelogram between it and its neighbours, and over the picture of the lamp:
// along each axis by the projection of that, a trapezoid. Places of neighbours touch, so that what is spread apart stays
// even; nothing is lost but rounding, which goes on to the next texel.
//!import techniques/water/shaders/caustic_cells

const SPREAD_WIDEST = 6.0;     // texels
const SPREAD_LAMP = 4.0;       // texels; wider lamps come in parts
const SPREAD_SHARPEST = 0.004;  // texels, so that a trapezoid has sides
const SPREAD_TEXELS = 10.0;

// A trapezoid over the middles of texels, and those that it touches
struct Spread {
    middle: f32,
    wide: f32,
    narrow: f32,
    first: f32,
    last: f32,
}

// `one` and `other` are sides of the parallelogram, texels; `grid` the columns and rows of the sums, and the first row.
fn caustic_spread(middle: vec2f, one: vec2f, other: vec2f, lamp: vec2f, flux: f32, grid: vec3u) {
    let over_x = spread(middle.x, one.x, other.x, lamp.x);
    let over_y = spread(middle.y, one.y, other.y, lamp.y);
    let size = vec2f(grid.xy);
    var rest = 0.5;
    var below_y = 0.0;
    for (var y = over_y.first; y <= over_y.last; y += 1.0) {
        let until_y = spread_below(over_y, y + 1.0);
        let units = flux * CAUSTIC_UNITS * (until_y - below_y);
        below_y = until_y;
        var below_x = 0.0;
        for (var x = over_x.first; x <= over_x.last; x += 1.0) {
            let until_x = spread_below(over_x, x + 1.0);
            let value = units * (until_x - below_x) + rest;
            below_x = until_x;
            let whole = floor(value);
            rest = value - whole;
            if min(x, y) >= 0.0 && x < size.x && y < size.y && whole > 0.0 {
                atomicAdd(&caustic_sums[(grid.z + u32(y)) * grid.x + u32(x)], u32(whole));
            }
        }
    }
}

// Texels under a box of one width seen through a box of another: differences of its integral. The narrower box takes
// the lamp's picture into it: the wider one must go on to touch its neighbours.
fn spread(middle: f32, one: f32, other: f32, lamp: f32) -> Spread {
    let sides = min(abs(vec2f(one, other)), vec2f(SPREAD_WIDEST));
    let smaller = min(min(sides.x, sides.y) + min(lamp, SPREAD_WIDEST), SPREAD_LAMP);
    let wide = max(max(max(sides.x, sides.y), smaller), SPREAD_SHARPEST);
    let narrow = max(min(max(sides.x, sides.y), smaller), SPREAD_SHARPEST);
    let reach = 0.5 * (wide + narrow);
    let first = floor(middle - reach);
    return Spread(middle, wide, narrow, first, min(ceil(middle + reach) - 1.0, first + SPREAD_TEXELS));
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
