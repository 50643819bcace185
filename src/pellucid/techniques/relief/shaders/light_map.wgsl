// Once per move of a light: what of it reaches each texel of the solid layer.
//!import techniques/relief/shaders/light_plane
//!import techniques/relief/shaders/light_rays

@group(0) @binding(17) var light_map_out: texture_storage_2d_array<rgba16float, write>;

override RELIEF_CAUSTICS: bool = false;  // light that has passed matter comes from the caustic map instead

const LIGHT_SIDE = 2u;  // points along a side of a texel, so that borders of shadows have no teeth

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= relief.texels) {
        return;
    }
    var share = vec3f(0.0);
    for (var k = 0u; k < LIGHT_SIDE * LIGHT_SIDE; k++) {
        let within = (vec2f(f32(k % LIGHT_SIDE), f32(k / LIGHT_SIDE)) + 0.5) / f32(LIGHT_SIDE) - 0.5;
        share += share_at(vec2f(id.xy), within, id.z);
    }
    share /= f32(LIGHT_SIDE * LIGHT_SIDE);
    textureStore(light_map_out, vec2i(id.xy), id.z, vec4f(share, 1.0));
}

// Beams of a caustic begin in whole texels: a texel is either under matter or not
fn share_at(texel: vec2f, within: vec2f, light: u32) -> vec3f {
    var uv = plane_uv(texel);
    var both = relief_heights(uv);
    let finer = plane_uv(texel + within);
    let there = relief_heights(finer);
    if !RELIEF_CAUSTICS || (both.y <= both.x && there.y <= there.x) {
        uv = finer;
        both = there;
    }
    let frame_at = plane_frame(uv, both.x);
    if RELIEF_CAUSTICS && meets_matter(frame_at, uv, both, light) {
        return vec3f(0.0);
    }
    return relief_light_rays(frame_at, frame_at.p_ws, uv, both.x, light);
}

fn meets_matter(frame_at: ReliefFrame, uv: vec2f, both: vec2f, light: u32) -> bool {
    if both.y > both.x {
        return true;
    }
    let ray = relief_ray(frame_at, uv, both.x, relief_lamp(light, frame_at.p_ws).to_ws);
    let reach = relief_reach(ray);
    return light_crossing(ray, 0.0, reach, RELIEF_TRANSLUCENT, false) < reach;
}
