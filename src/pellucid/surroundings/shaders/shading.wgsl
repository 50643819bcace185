// Radiance of the triangle that each pixel shows, by the same shading as a ray that hits it.
//!import surroundings/shaders/shade
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var visible_triangles: texture_2d<u32>;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let triangle = max(textureLoad(visible_triangles, vec2i(position.xy), 0).r, 1u) - 1u;
    let ray = camera_ray(position.xy);
    let found = triangle_plane_entry(triangle, ray.origin, ray.direction);
    let u = saturate(found.y);
    let hit = SurfaceHit(found.x, true, triangle, vec2f(u, clamp(found.z, 0.0, 1.0 - u)));
    return vec4f(shade_hit(hit, ray.direction), 1.0);
}
