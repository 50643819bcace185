// Light laid down on the atlas of caustics in fixed point: sums of integers come out the same in any order.
//!import surroundings/shaders/charts
//!struct LandParams from surroundings.layouts
//!struct OutPatch from surroundings.layouts

const SPLAT_WINDOW = 2.0;   // texels across that a splat may be wide: with its tents it then covers 4 x 4 of them
const SPLAT_BLOCKS = 9.0;   // of that size, at most; what takes more goes to the next coarser resolution
const SPLAT_POINTS = 2.0;   // a texel
const SPLAT_LEAST = 0.02;   // texels, smallest width of a point
// RGB of the caustic, RGB of the blocked light; after the last texel, those of the light that no chart has received
const SUMS_PER_TEXEL = 6u;

@group(0) @binding(0) var<uniform> landing: LandParams;
@group(0) @binding(1) var<storage, read_write> flux_sums: array<atomic<i32>>;

// A quadrangle on a chart; corners in texels, in the order (0, 0), (1, 0), (0, 1), (1, 1)
struct Quad {
    a: vec2f,
    b: vec2f,
    c: vec2f,
    d: vec2f,
}

fn quad_point(q: Quad, st: vec2f) -> vec2f {
    return mix(mix(q.a, q.b, st.x), mix(q.c, q.d, st.x), st.y);
}

fn quad_extent(q: Quad) -> f32 {
    let size = max(max(q.a, q.b), max(q.c, q.d)) - min(min(q.a, q.b), min(q.c, q.d));
    return max(size.x, size.y);
}

fn quad_part(q: Quad, low: vec2f, high: vec2f) -> Quad {
    return Quad(
        quad_point(q, low), quad_point(q, vec2f(high.x, low.y)),
        quad_point(q, vec2f(low.x, high.y)), quad_point(q, high)
    );
}

// Into how many blocks a quadrangle is cut along its two directions, so that none is wider than SPLAT_WINDOW
fn block_counts(q: Quad) -> vec2f {
    let u = max(abs(q.b - q.a), abs(q.d - q.c));
    let v = max(abs(q.c - q.a), abs(q.d - q.b));
    let counts = max(ceil(vec2f(max(u.x, u.y), max(v.x, v.y)) / SPLAT_WINDOW), vec2f(1.0));
    let size = u / counts.x + v / counts.y;
    return counts * max(ceil(max(size.x, size.y) / SPLAT_WINDOW - 0.01), 1.0);
}

// Spread light evenly over a quadrangle on a chart, at the resolution that suits its size: what is many texels wide
// costs no more than what is small, and is blurred by no more than half its own width.
fn spread(q: Quad, point: ChartPoint, units: vec3f, kind: u32, noise: f32) {
    let finest = vec4f(point.low, point.high);
    var bounds = finest;
    var there = q;
    var counts = block_counts(q);
    for (var level = 1u; level < CHART_LEVELS && counts.x * counts.y > SPLAT_BLOCKS; level++) {
        bounds = chart_bounds(point.chart, level);
        there = Quad(
            between_levels(q.a, finest, bounds), between_levels(q.b, finest, bounds),
            between_levels(q.c, finest, bounds), between_levels(q.d, finest, bounds)
        );
        counts = block_counts(there);
    }
    counts = min(counts, vec2f(SPLAT_BLOCKS));
    counts.y = max(min(counts.y, floor(SPLAT_BLOCKS / counts.x)), 1.0);
    let columns = u32(counts.x);
    let blocks = columns * u32(counts.y);
    for (var k = 0u; k < blocks; k++) {
        let at = vec2f(f32(k % columns), f32(k / columns)) / counts;
        let block = quad_part(there, at, at + 1.0 / counts);
        // What is too wide even so is drawn smaller than it is: gaps show, and no light is lost.
        let shrink = 0.5 - 0.5 * min(1.0, SPLAT_WINDOW / max(quad_extent(block), 1e-9));
        let kept = quad_part(block, vec2f(shrink), vec2f(1.0 - shrink));
        splat(kept, bounds, units / f32(blocks), kind, fract(noise + 0.618034 * f32(k)));
    }
}

// A quadrangle no wider than SPLAT_WINDOW: a lattice of boxes, each as large as its share of the quadrangle and weighted
// with the tents of the texels around. Neighbouring bundles sum to a plateau. `units` is the flux in units of the sums;
// `noise` in 0..1 decides how fractions are rounded, so that none is lost on average.
fn splat(q: Quad, bounds: vec4f, units: vec3f, kind: u32, noise: f32) {
    let low = min(min(q.a, q.b), min(q.c, q.d));
    let size = max(max(q.a, q.b), max(q.c, q.d)) - low;
    let base = floor(low - 0.5);
    let count = clamp(u32(ceil(SPLAT_POINTS * max(size.x, size.y))), 1u, u32(SPLAT_POINTS * SPLAT_WINDOW));
    let box = max(size / f32(count), vec2f(SPLAT_LEAST));
    var weights = array<vec4f, 4>();
    for (var k = 0u; k < count * count; k++) {
        let at = quad_point(q, (vec2f(f32(k % count), f32(k / count)) + 0.5) / f32(count)) - base - 0.5;
        let x = tents(at.x, box.x);
        let y = tents(at.y, box.y);
        weights[0] += y.x * x;
        weights[1] += y.y * x;
        weights[2] += y.z * x;
        weights[3] += y.w * x;
    }
    let share = units / f32(count * count);
    var rest = vec3f(noise);
    for (var k = 0u; k < 16u; k++) {
        let value = weights[k / 4u][k % 4u] * share + rest;
        let whole = floor(value);
        rest = value - whole;
        if any(whole != vec3f(0.0)) {
            let texel = clamp(base + vec2f(f32(k % 4u), f32(k / 4u)), bounds.xy, bounds.zw - 1.0);
            let place = SUMS_PER_TEXEL * (u32(texel.y) * landing.width + u32(texel.x)) + 3u * kind;
            atomicAdd(&flux_sums[place], i32(whole.x));
            atomicAdd(&flux_sums[place + 1u], i32(whole.y));
            atomicAdd(&flux_sums[place + 2u], i32(whole.z));
        }
    }
}

// Means of the tents that stand at 0, 1, 2, 3 over a box
fn tents(middle: f32, width: f32) -> vec4f {
    let x = middle - vec4f(0.0, 1.0, 2.0, 3.0);
    return (tent_integral(x + 0.5 * width) - tent_integral(x - 0.5 * width)) / width;
}

fn tent_integral(x: vec4f) -> vec4f {
    let inside = clamp(x, vec4f(-1.0), vec4f(1.0));
    return 0.5 + inside - 0.5 * inside * abs(inside);
}

// A number in 0..1 that depends on a bundle itself, not on its place in the list [jarzynski2020, pcg3d]
fn bundle_noise(bundle: OutPatch, salt: u32) -> f32 {
    var v = bitcast<vec3u>(bundle.corner_0) ^ (bitcast<vec3u>(bundle.way_3) * 2654435761u);
    v = (v + vec3u(salt, 0u, bundle.kind)) * 1664525u + 1013904223u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    return f32(v.x >> 8u) / 16777216.0;
}
