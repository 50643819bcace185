// What the waiting lobes see: one invocation a lobe.

//!import techniques/eikonal/shaders/gloss
//!import techniques/eikonal/shaders/ray_list

override LOBES: bool = true;   // some ask for all that a lobe sees, and not for lamps alone

@group(0) @binding(0) var<storage, read> look_list: FinishedList;
@group(0) @binding(1) var<storage, read> look_rays: array<LookRay>;
@group(0) @binding(2) var<storage, read_write> look_values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= look_list.heads[1].count) { return; }
    let slot = look_list.slots[arrayLength(&look_list.slots) - 1u - id.x];
    let ray = look_rays[slot];
    let kind = ray.kind % 8u;
    // Kinds as in looks.wgsl: 2 lamps alone, 3 all that a GGX lobe sees, 4 all that a table reflects.
    let lobe = lobe_of(ray, select(0u, u32(ray.roughness), kind == 4u));
    var seen = lamps_in_lobe(lobe, ray.origin);
    if (LOBES && kind >= 3u) { seen += radiance_in_lobe(lobe, ray.origin); }
    let value = look_values[slot];
    look_values[slot] = vec4f(value.rgb * seen, value.w);
}
