// As shading.wgsl, but light that a map of water tells of goes to a picture of its own: see sunlit.wgsl.
//!import surroundings/shaders/shade
//!import surroundings/shaders/full_picture

struct ShadedApart {
    @location(0) rest: vec4f,  // all other light; the share of it that came from elsewhere, and is not the surface's own
    // What a surface sends for the share of the lamp that comes to it, and its shadow, in halves; its depth, metres.
    @location(1) sun: vec4u,
}

@group(0) @binding(0) var visible_triangles: texture_2d<u32>;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> ShadedApart {
    let triangle = max(textureLoad(visible_triangles, vec2i(position.xy), 0).r, 1u) - 1u;
    let ray = camera_ray(position.xy);
    let found = triangle_plane_entry(triangle, ray.origin, ray.direction);
    let u = saturate(found.y);
    let view_ws = -ray.direction;
    let surface = surface_at(triangle, vec2f(u, clamp(found.z, 0.0, 1.0 - u)), view_ws);
    let shaded = shade_parts(surface, triangle, view_ws);
    let own = materials[surface.material].emission;
    let lit = 1.0 - saturate(dot(own, vec3f(1.0)) / max(dot(shaded.radiance, vec3f(1.0)), 1e-30));
    let sun = vec4f(min(shaded.sun, vec3f(SHADED_MAX)), shaded.sun_seen);
    let depth_m = dot(surface.p_ws - frame.camera_position, frame.camera_forward);
    let kept = vec4u(pack2x16float(sun.rg), pack2x16float(sun.ba), bitcast<u32>(depth_m), 0u);
    return ShadedApart(vec4f(shaded.radiance, lit), kept);
}

const SHADED_MAX = 60000.0;  // below the largest half float
