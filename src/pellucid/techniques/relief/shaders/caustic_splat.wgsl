// The light between four neighbouring beams is spread over the quadrangle on which they land. Where matter begins, the
// beams beside it land where they are, and have no light.
//!import techniques/relief/shaders/caustic_bindings

const SPLAT_PER_TEXEL = 2.0;  // points along a side of the quadrangle
const SPLAT_SIDE = 32.0;      // points, at most
const SPLAT_TORN = 24.0;      // texels: what lies farther apart was parted by an edge of the layers

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relief.texels) {
        return;
    }
    let beams = array<ReliefBeam, 4>(
        beam_at(id.xy), beam_at(id.xy + vec2u(1u, 0u)), beam_at(id.xy + vec2u(0u, 1u)), beam_at(id.xy + vec2u(1u, 1u))
    );
    var lit = false;
    for (var k = 0u; k < 4u; k++) {
        lit = lit || beams[k].kind == BEAM_LIT;
    }
    if !lit {
        return;
    }
    let size = vec2f(relief.texels);
    let way = array<vec2f, 4>(vec2f(0.0), vec2f(1.0, 0.0), vec2f(0.0, 1.0), vec2f(1.0, 1.0));
    var corners: array<vec2f, 4>;
    var low = vec2f(1e9);
    var high = vec2f(-1e9);
    var torn = false;
    for (var k = 0u; k < 4u; k++) {
        // Beams of the next tile land as far on as they begin
        let began = vec2f(id.xy) + way[k];
        corners[k] = beams[k].landed + floor(began / size) * size;
        torn = torn || beams[k].kind == BEAM_DARK;
        low = min(low, corners[k]);
        high = max(high, corners[k]);
    }
    let wide = max(high.x - low.x, high.y - low.y);
    torn = torn || wide > SPLAT_TORN;
    let side = select(clamp(ceil(SPLAT_PER_TEXEL * wide), 1.0, SPLAT_SIDE), 2.0, torn);
    let per_point = CAUSTIC_UNITS / (side * side);
    var rest = vec3f(0.5);
    for (var k = 0.0; k < side * side; k += 1.0) {
        let cell = vec2f(k % side, floor(k / side));
        let at = select((cell + 0.5) / side, cell, torn);
        let x = mix(mix(corners[0], corners[1], at.x), mix(corners[2], corners[3], at.x), at.y);
        let upper = mix(beams[0].flux, beams[1].flux, at.x);
        rest = splat(x, per_point * mix(upper, mix(beams[2].flux, beams[3].flux, at.x), at.y), rest);
    }
}

fn beam_at(texel: vec2u) -> ReliefBeam {
    let size = relief.texels;
    let at = select(min(texel, size - 1u), texel % size, relief.tiling != 0u);
    return caustic_beams[caustic_index(at)];
}

// By a tent over the four nearest texels; what is rounded off goes on to the next
fn splat(x: vec2f, units: vec3f, carried: vec3f) -> vec3f {
    let base = floor(x);
    let share = x - base;
    let size = vec2i(relief.texels);
    var rest = carried;
    for (var k = 0; k < 4; k++) {
        let step = vec2f(f32(k & 1), f32(k >> 1));
        let weight = mix(1.0 - share, share, step);
        let value = weight.x * weight.y * units + rest;
        let whole = floor(value);
        rest = value - whole;
        let texel = vec2i(base + step);
        let wrapped = (texel % size + size) % size;
        if relief.tiling != 0u || all(wrapped == texel) {
            let place = 3u * caustic_index(vec2u(wrapped));
            atomicAdd(&caustic_sums[place], u32(whole.x));
            atomicAdd(&caustic_sums[place + 1u], u32(whole.y));
            atomicAdd(&caustic_sums[place + 2u], u32(whole.z));
        }
    }
    return rest;
}
