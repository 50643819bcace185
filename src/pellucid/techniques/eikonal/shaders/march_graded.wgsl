// Curved pieces between sharp surfaces, inside a region whose index varies.

//!import techniques/eikonal/shaders/proxy
//!import techniques/eikonal/shaders/interfaces
//!import techniques/eikonal/shaders/step

// Steps of the integrator, no longer than the distance to the surface.
fn march_graded(walk: ptr<function, Walk>, crossing: ptr<function, Crossing>) -> u32 {
    let p_begin = (*walk).p0 + (*walk).q;
    var stride = FIRST_STRIDE * volume.voxel;
    while ((*walk).steps < volume.max_steps) {
        let room = proxy_span((*walk).x, normalize((*walk).p0 + (*walk).q)).y;
        if (room <= 1e-4 * volume.voxel) { return LEFT; }
        var before = *walk;
        let step = take_step(walk, min(stride, room));
        if (step.opaque_at_probe) { return OPAQUE; }
        let distances = distances_at((*walk).x);
        let signs = signs_of(distances);
        stride = stride_from(distances, (*walk).x);
        if (signs != before.signs) {
            let hit = surface_between(before.x, (*walk).x - before.x, before.signs, distances);
            *walk = before;
            _ = take_step(walk, hit.part * step.length);
            let flipped = before.signs ^ (1u << hit.region);
            if (owner_of(flipped) != before.region) {
                *crossing = crossing_at((*walk).x, (*walk).p0 + (*walk).q, hit.normal, flipped);
                return INTERFACE;
            }
            (*walk).signs = flipped;
            stride = FIRST_STRIDE * volume.voxel;
        }
        if (MEETS_MESHES && distance((*walk).p0 + (*walk).q, p_begin) > volume.pause) { return PAUSED; }
    }
    return EXHAUSTED;
}
