// Where a ray meets the layers, by the search that RELIEF_SEARCH names.
//!import techniques/relief/shaders/search_linear
//!import techniques/relief/shaders/search_distance
//!import techniques/relief/shaders/search_cone
//!import techniques/relief/shaders/search_max_mip

override RELIEF_SEARCH: u32 = 0u;

const RELIEF_LINEAR = 0u;
const RELIEF_DISTANCE = 1u;
const RELIEF_CONE = 2u;
const RELIEF_MAX_MIP = 3u;

const RELIEF_DISTANCE_TURNS = 8u;  // steps by distance for each linear step that the quality asks for

fn relief_search(ray: ReliefRay, reach: f32, kind: u32, linear: u32, binary: u32) -> ReliefHit {
    if RELIEF_SEARCH == RELIEF_LINEAR {
        return relief_linear(ray, reach, kind, linear, binary);
    }
    // Maps of free space are about the outside: from within, bounds of both layers are the only ones that serve.
    if RELIEF_SEARCH == RELIEF_MAX_MIP || kind == RELIEF_LEAVE {
        return relief_by_bounds(ray, reach, kind);
    }
    if RELIEF_SEARCH == RELIEF_DISTANCE {
        return relief_by_distance(ray, reach, kind, RELIEF_DISTANCE_TURNS * linear, binary);
    }
    return relief_by_cones(ray, reach, kind);
}

// A ray that has entered the translucent matter: within it as `relief_leave`, over it as `relief_first`. Both in one
// search, which each turn of a loop may use another way; what it enters and leaves is mostly near.
fn relief_onwards(ray: ReliefRay, reach: f32, is_inside: bool) -> ReliefHit {
    let kind = select(RELIEF_FIRST, RELIEF_LEAVE, is_inside);
    if RELIEF_SEARCH == RELIEF_LINEAR {
        return relief_linear(ray, reach, kind, relief.refraction_linear, relief.refraction_binary);
    }
    return relief_by_bounds(ray, reach, kind);
}

// First of both layers, from outside
fn relief_first(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_search(ray, reach, RELIEF_FIRST, relief.linear_steps, relief.binary_steps);
}

// Solid layer alone, from above it
fn relief_solid(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_search(ray, reach, RELIEF_BASE, relief.linear_steps, relief.binary_steps);
}

// From inside the translucent matter: its upper surface, or the solid layer
fn relief_leave(ray: ReliefRay, reach: f32) -> ReliefHit {
    return relief_search(ray, reach, RELIEF_LEAVE, relief.refraction_linear, relief.refraction_binary);
}
