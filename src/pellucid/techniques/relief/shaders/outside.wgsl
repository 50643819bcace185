// What a ray sees that leaves a relief for good.
//!import surroundings/shaders/radiance
//!import techniques/relief/shaders/bindings

override RELIEF_RAYS: bool = true;  // whether it may meet meshes; else it sees the environment

override RELIEF_CUBE: bool = false;  // whether it looks into a cube map of the scene

fn relief_outside(origin_ws: vec3f, direction_ws: vec3f, alpha: f32) -> vec3f {
    if RELIEF_CUBE {
        return textureSampleLevel(scene_cube, surface_sampler, direction_ws, 0.0).rgb;
    }
    if ACROSS_WATER || ACROSS_GLASS {
        let seen = across_viewed(origin_ws, direction_ws);
        if seen.first_m < ACROSS_FAR {
            return seen.radiance;
        }
    }
    if RELIEF_RAYS && !ACROSS_WATER && !ACROSS_GLASS {
        let hit = trace_opaque(origin_ws, direction_ws, 1e30);
        if hit.valid {
            return shade_hit(hit, direction_ws);
        }
    }
    return environment_glossy(direction_ws, alpha);
}
