// Blocks of pixels that share a ray, see blocks.py.
//!import surroundings/shaders/camera
//!import techniques/water/shaders/bindings

// A pixel of a block, counted row by row
fn water_block_pixel(k: u32) -> vec2u {
    return vec2u(k % water.block.x, k / water.block.x);
}

// Where the ray of a block goes through the picture, in pixels: the middle of pixel `pick` - 1, or of the block for 0
fn water_pixel(block: vec2f, pick: u32) -> vec2f {
    let size = vec2f(water.block);
    let aside = vec2f(water_block_pixel(max(pick, 1u) - 1u)) + 0.5 - 0.5 * size;
    return size * block + select(aside, vec2f(0.0), pick == 0u);
}
