// Squares of pixels that share a ray.
//!import surroundings/shaders/camera

override WATER_RATE: u32 = 1u;  // pixels along the side of a square

// Where the ray of a square goes through the picture, in pixels: the middle of pixel `pick` - 1, row by row, or of the
// square for 0
fn water_pixel(square: vec2f, pick: u32) -> vec2f {
    let k = max(pick, 1u) - 1u;
    let aside = vec2f(vec2u(k % WATER_RATE, k / WATER_RATE)) + 0.5 - 0.5 * f32(WATER_RATE);
    return f32(WATER_RATE) * square + select(aside, vec2f(0.0), pick == 0u);
}
