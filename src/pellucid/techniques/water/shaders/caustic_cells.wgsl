// Cells of a surface, of which there are as many as texels of its map, or fewer where the lamp is too wide for that.
//!import techniques/water/shaders/caustic_bindings

const CAUSTIC_UNITS = 1048576.0;  // of flux: what falls on one cell. 4000 times as much still fits

// Cells along a side
fn caustic_side() -> u32 {
    return caustic.cells;
}

fn caustic_cell(xy: vec2u, channel: u32) -> u32 {
    return (channel * caustic_side() + xy.y) * caustic_side() + xy.x;
}

// Place of a point of the maps, in cells from the corner, in metres of the level
fn caustic_place(cells: vec2f) -> vec2f {
    return mix(water.low, water.high, cells / f32(caustic_side()));
}

// The way back, which need not be on the map
fn caustic_texel(seen: vec2f) -> vec2f {
    return (seen - water.low) / (water.high - water.low) * f32(caustic_side());
}
