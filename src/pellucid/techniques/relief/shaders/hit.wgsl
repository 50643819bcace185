// What a search along a ray looks for, and what it finds.

const RELIEF_NONE = 0u;
const RELIEF_TRANSLUCENT = 1u;
const RELIEF_SOLID = 2u;

struct ReliefHit {
    t: f32,
    layer: u32,
}

// What a search looks for
const RELIEF_FIRST = 0u;  // the first of both layers, from above both
const RELIEF_BASE = 1u;   // the solid layer alone, from above it
const RELIEF_LEAVE = 2u;  // from within the translucent matter: its upper surface, or the solid layer

const RELIEF_TURNS = 2048u;  // of a loop along a ray; a driver may end an invocation that takes too many
