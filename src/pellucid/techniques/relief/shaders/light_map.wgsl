// Once per move of a light: what of it reaches each texel of the solid layer.
//!import techniques/relief/shaders/light_plane
//!import techniques/relief/shaders/light_rays

@group(0) @binding(17) var light_map_out: texture_storage_2d_array<rgba16float, write>;

override RELIEF_CAUSTICS: bool = false;  // light that has passed matter comes from the caustic map instead

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relief.texels) {
        return;
    }
    let uv = plane_uv(vec2f(id.xy));
    let both = relief_heights(uv);
    let frame_at = plane_frame(uv, both.x);
    var share = vec3f(0.0);
    if !(RELIEF_CAUSTICS && meets_matter(frame_at, uv, both, id.z)) {
        share = relief_light_rays(frame_at, frame_at.p_ws, uv, both.x, id.z);
    }
    textureStore(light_map_out, vec2i(id.xy), id.z, vec4f(share, 1.0));
}

fn meets_matter(frame_at: ReliefFrame, uv: vec2f, both: vec2f, light: u32) -> bool {
    if both.y > both.x {
        return true;
    }
    let ray = relief_ray(frame_at, uv, both.x, relief_lamp(light, frame_at.p_ws).to_ws);
    let reach = relief_reach(ray);
    return light_crossing(ray, 0.0, reach, RELIEF_TRANSLUCENT, false) < reach;
}
