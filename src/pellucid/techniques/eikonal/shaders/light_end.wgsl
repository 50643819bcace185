// What is still on its way after the last generation is given up, and said so.

//!import techniques/eikonal/shaders/light_bindings

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= atomicLoad(&counters.lists[generation.index + 1u].count)) { return; }
    add_flux(TOTAL_ENDED, patches[id.x].flux);
}
