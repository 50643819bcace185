// What the waiting rays see: one invocation a ray.

//!import surroundings/shaders/irradiance
//!import surroundings/shaders/radiance
//!import techniques/eikonal/shaders/ray_list
//!import techniques/eikonal/shaders/screen
//!struct LookRay from techniques.eikonal.layouts

override HAS_MESHES: bool = true;
override SCREEN_SPACE: bool = false;   // see nearby geometry in the picture drawn so far instead of by rays

@group(0) @binding(0) var<storage, read> look_list: FinishedList;
@group(0) @binding(1) var<storage, read> look_rays: array<LookRay>;
@group(0) @binding(2) var<storage, read_write> look_values: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= look_list.heads[0].count) { return; }
    let slot = look_list.slots[id.x];
    let ray = look_rays[slot];
    var seen = vec3f(0.0);
    if (ray.kind % 8u == 1u) {
        seen = surface_irradiance(ray.origin, ray.direction);
    } else if (SCREEN_SPACE) {
        seen = screen_radiance(ray.origin, ray.direction);
    } else if (HAS_MESHES || ACROSS_WATER) {
        seen = radiance_along(ray.origin, ray.direction);
    } else {
        seen = environment_radiance(ray.direction);
    }
    let value = look_values[slot];
    look_values[slot] = vec4f(value.rgb * seen, value.w);
}
