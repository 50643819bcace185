// Heights of a layer that moves, as they come from a simulation or from the caller, and the maps that are made of them.
//!struct ReliefMoving from techniques.relief.layouts

@group(0) @binding(0) var<uniform> moving: ReliefMoving;

// A texel of a map of that size: the map repeats, or goes on as it ends
fn moving_texel(at: vec2i, size: vec2i) -> vec2i {
    let repeated = at - size * vec2i(floor(vec2f(at) / vec2f(size)));
    return select(clamp(at, vec2i(0), size - 1), clamp(repeated, vec2i(0), size - 1), moving.tiling != 0u);
}
