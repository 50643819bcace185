// Distance of the first surface from a directional light; which light is told by group 0.
//!import surroundings/shaders/surface

@group(0) @binding(0) var<uniform> shadow_light: vec4u;  // light, layer

const MATERIAL_CASTS_SHADOW = 16u;  // layouts.MATERIAL_CASTS_SHADOW

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let triangle = vertex / 3u;
    let flags = materials[bvh_triangles[triangle].material].flags;
    if (flags & (MATERIAL_CASTS_SHADOW << shadow_light.y)) == 0u {
        return vec4f(2.0, 2.0, 2.0, 1.0);  // clipped
    }
    return lights[shadow_light.x].shadow_from_world * vec4f(triangle_corner(triangle, vertex % 3u), 1.0);
}
