// A ray counted in columns and rows of texel centres, from cell to cell.
//!import techniques/relief/shaders/hit
//!import techniques/relief/shaders/frame

struct ReliefWalk {
    origin: vec2f,
    step: vec2f,       // a metre
    inverse: vec2f,
    ahead: vec2f,      // 1 where the far border of a cell is the one of the larger number
    size: vec2f,
    inverse_size: vec2f,
    spread: f32,       // |step.x| + |step.y|
    past: f32,         // metres that surely lead over a border
}

fn relief_walk(ray: ReliefRay) -> ReliefWalk {
    let size = vec2f(relief.texels);
    let uv = vec2f(ray.uv.x, 1.0 - ray.uv.y);  // row 0 of a map is its top
    let near = select(uv, uv - floor(uv), relief.tiling != 0u);
    let step = vec2f(ray.duv.x, -ray.duv.y) * size;
    let spread = abs(step.x) + abs(step.y);
    let moving = select(vec2f(1e-20), step, abs(step) > vec2f(1e-20));
    let ahead = select(vec2f(0.0), vec2f(1.0), moving > vec2f(0.0));
    return ReliefWalk(near * size - 0.5, step, 1.0 / moving, ahead, size, 1.0 / size, spread, 1e-4 / max(spread, 1e-6));
}

fn relief_cell(walk: ReliefWalk, t: f32) -> vec2f {
    return floor(walk.origin + t * walk.step);
}

// Index of a cell in maps: the array repeats, or its border goes on for ever
fn relief_cell_index(walk: ReliefWalk, cell: vec2f) -> vec2f {
    let repeated = cell - walk.size * floor((cell + 0.5) * walk.inverse_size);
    return select(clamp(cell, vec2f(0.0), walk.size - 1.0), repeated, relief.tiling != 0u);
}

// t just over the border of a box that a ray in it at t leaves through; `far` is its corner ahead
fn relief_leaves(walk: ReliefWalk, t: f32, far: vec2f) -> f32 {
    let borders = (far - walk.origin) * walk.inverse;
    // Far away the border cannot be told from its neighbours any more: go on by what a float can still count.
    return max(min(borders.x, borders.y), t) * 1.0000003 + walk.past;
}

// The reach of a ray; none of a ray that is not a number, as of lanes of a driver that lie outside of a triangle: they
// would never come to an end, and the others wait for them.
fn relief_end(walk: ReliefWalk, ray: ReliefRay, reach: f32) -> f32 {
    let size = walk.spread + abs(walk.origin.x) + abs(walk.origin.y) + abs(ray.h) + abs(ray.dh) + abs(ray.bend);
    return select(0.0, reach, size < 1e20);
}

fn relief_slope_along(ray: ReliefRay, t: f32) -> f32 {
    return ray.dh + 2.0 * ray.bend * t;
}

// No ray is steeper between t and the end of its reach
fn relief_steepest_fall(ray: ReliefRay, t: f32, reach: f32) -> f32 {
    return relief_slope_along(ray, t) + min(ray.bend, 0.0) * max(reach - t, 0.0);
}

// A height that the ray is nowhere below between two places: an arc hangs at most bend s^2 / 4 below its chord
fn relief_lowest(ray: ReliefRay, a: f32, b: f32) -> f32 {
    let s = b - a;
    return min(relief_height_along(ray, a), relief_height_along(ray, b)) - 0.25 * max(ray.bend, 0.0) * s * s;
}

fn relief_highest(ray: ReliefRay, a: f32, b: f32) -> f32 {
    let s = b - a;
    return max(relief_height_along(ray, a), relief_height_along(ray, b)) - 0.25 * min(ray.bend, 0.0) * s * s;
}
