// Opaque meshes that reach into the box stop light.

//!import surroundings/shaders/raycast
//!import techniques/eikonal/shaders/bindings

const MESH = 6u;              // how a way can end, beside those of walk.wgsl
const BEFORE_MESH = 0.05;     // voxels: view.wgsl, CONTACT

// How far along a ray light goes before a mesh stops it, or `reach` and more; object metres.
fn mesh_before(x: vec3f, d: vec3f, reach: f32) -> f32 {
    if (!MEETS_MESHES) { return reach; }
    let gap = BEFORE_MESH * volume.voxel;
    let from_ws = (volume.world_from_object * vec4f(x + gap * d, 1.0)).xyz;
    let way_ws = normalize((volume.world_from_object * vec4f(d, 0.0)).xyz);
    let hit = trace_opaque(from_ws, way_ws, max(reach - 2.0 * gap, 0.0) * volume.scale);
    return select(reach, max(hit.t / volume.scale, 0.0), hit.valid);
}
