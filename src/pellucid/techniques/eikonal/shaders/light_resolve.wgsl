// From fixed-point sums to the fluence and the mean direction of light that the view looks up.

//!struct LightParams from techniques.eikonal.layouts

@group(0) @binding(0) var<uniform> light: LightParams;
@group(0) @binding(1) var<storage, read> fluence: array<i32>;
@group(0) @binding(2) var<storage, read> directions: array<i32>;
@group(0) @binding(3) var fluence_image: texture_storage_3d<rgba16float, write>;
@group(0) @binding(4) var direction_image: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) at: vec3u) {
    let size = light.grid;
    if (any(at >= size)) { return; }
    let voxel = 3u * ((at.z * size.y + at.y) * size.x + at.x);
    let sum = vec3f(f32(fluence[voxel]), f32(fluence[voxel + 1u]), f32(fluence[voxel + 2u]));
    textureStore(fluence_image, at, vec4f(sum * light.fluence_per_quantum, 0.0));
}

@compute @workgroup_size(64)
fn turn(@builtin(global_invocation_id) at: vec3u) {
    if (any(at >= light.cells)) { return; }
    let cell = 4u * ((at.z * light.cells.y + at.y) * light.cells.x + at.x);
    let way = vec3f(f32(directions[cell]), f32(directions[cell + 1u]), f32(directions[cell + 2u]));
    let turn = way / max(f32(directions[cell + 3u]), 1.0);
    textureStore(direction_image, at, vec4f(turn / max(length(turn), 1.0), 0.0));
}
