// The light of each cell lands between the landings of its neighbours.
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/caustic_spread

const SPLAT_TORN = 12.0;  // texels: what lies farther apart was parted by an edge

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let side = caustic_side();
    if id.x >= side {
        return;
    }
    let beam = caustic_beams[caustic_cell(id.xy, id.z)];
    if beam.flux <= 0.0 {
        return;
    }
    let along = landed_beside(id, vec2i(1, 0), beam.landed);
    let across = landed_beside(id, vec2i(0, 1), beam.landed);
    let texel_m = (water.high - water.low) / f32(side);
    let lamp = mix(caustic.lamp_side * beam.depth_m / texel_m, beam.entered, caustic.near);
    caustic_spread(vec2f(along.x, across.y), along.zw, across.zw, lamp, beam.flux, vec3u(side, side, id.z * side));
}

// Middle and extent of the place between the neighbours of a cell on both sides, in texels
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
