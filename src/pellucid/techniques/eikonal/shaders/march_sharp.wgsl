// The sharp boundary model: straight or curved pieces between surfaces that are met exactly.

//!import techniques/eikonal/shaders/march_straight
//!import techniques/eikonal/shaders/march_graded

// Where a walk begins, it must know what it is in.
fn enter_sharp(walk: ptr<function, Walk>) {
    (*walk).signs = signs_of(distances_at((*walk).x));
    (*walk).region = owner_of((*walk).signs);
    let n = region_index((*walk).region, (*walk).x);
    redirect(walk, normalize((*walk).p0), n);
}

// Go on until the ray leaves the box, stands at an interface, meets something opaque, or has turned by `pause`. On a curved piece
// matter has acted by then, on a straight one it has not: see `gather_straight`.
fn march_sharp(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    if (is_graded((*walk).region)) { return march_graded(walk, crossing); }
    return march_straight(walk, crossing);
}
