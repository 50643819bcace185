// What a ray sees that leaves a relief for good.
//!import surroundings/shaders/radiance

override RELIEF_RAYS: bool = true;  // whether it may meet meshes; else it sees the environment

fn relief_outside(origin_ws: vec3f, direction_ws: vec3f, alpha: f32) -> vec3f {
    if RELIEF_RAYS {
        let hit = trace_opaque(origin_ws, direction_ws, 1e30);
        if hit.valid {
            return shade_hit(hit, origin_ws, direction_ws);
        }
    }
    return environment_glossy(direction_ws, alpha);
}
