// The end of a batch: what is still on its way is given up, and said so; patches are counted.

//!import techniques/eikonal/shaders/light_bindings

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= atomicLoad(&counters.lists[generation.index + 1u].count)) { return; }
    add_flux(TOTAL_ENDED, patches[id.x].flux);
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    if (id.x > generation.index) { return; }
    add_quanta(TOTAL_PATCHES, atomicLoad(&counters.lists[id.x + 1u].count));
}
