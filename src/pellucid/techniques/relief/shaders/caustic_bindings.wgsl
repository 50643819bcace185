// Light that matter refracts onto the solid layer: one ray a texel, and sums of flux in fixed point.
//!import techniques/relief/shaders/bindings
//!struct ReliefBeam from techniques.relief.layouts

const CAUSTIC_UNITS = 1048576.0;  // of flux: what falls on one texel of a level surface. 4000 times as much still fits

@group(0) @binding(18) var<storage, read_write> caustic_beams: array<ReliefBeam>;  // a texel of the translucent layer
@group(0) @binding(19) var<storage, read_write> caustic_sums: array<atomic<u32>>;  // RGB a texel of the solid layer

const BEAM_DARK = 0u;  // in matter, where the lamp does not shine
const BEAM_LIT = 1u;
const BEAM_DRY = 2u;   // where there is no matter, or it begins

fn caustic_index(texel: vec2u) -> u32 {
    return texel.y * relief.texels.x + texel.x;
}
