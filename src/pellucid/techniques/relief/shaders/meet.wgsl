// Rays of the caller through the searches that draw: one invocation a ray.
//!import techniques/relief/shaders/search
//!struct ReliefAsked from techniques.relief.layouts

@group(0) @binding(16) var<storage, read> asked_rays: array<ReliefAsked>;
@group(0) @binding(17) var<storage, read_write> met: array<ReliefHit>;

override RELIEF_LOOKS_FOR: u32 = 0u;  // RELIEF_FIRST, RELIEF_BASE or RELIEF_LEAVE

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let k = id.x + id.y * groups.x * 64u;
    if k >= arrayLength(&asked_rays) {
        return;
    }
    let asked = asked_rays[k];
    let ray = ReliefRay(asked.uv, asked.h, asked.duv, asked.dh, asked.bend);
    if RELIEF_LOOKS_FOR == RELIEF_FIRST {
        met[k] = relief_first(ray, asked.reach);
    } else if RELIEF_LOOKS_FOR == RELIEF_BASE {
        met[k] = relief_solid(ray, asked.reach);
    } else {
        met[k] = relief_leave(ray, asked.reach);
    }
}
