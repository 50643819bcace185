// The light of a lamp enters the water at each cell of its surface and is followed to the first mesh.
//!import optics/fresnel
//!import optics/snell
//!import surroundings/shaders/bindings
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/caustic_iteration
//!import techniques/water/shaders/caustic_march
//!import techniques/water/shaders/caustic_wave

override CAUSTIC_ITERATION: bool = false;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < caustic_side() {
        caustic_beams[caustic_cell(id.xy, id.z)] = caustic_beam(id.xy, id.z);
    }
}

// What a level surface receives counts as 1: (l.n) / n.y of light on a slope, over l.y there
fn caustic_beam(cell: vec2u, channel: u32) -> CausticBeam {
    let xz = caustic_place(vec2f(cell) + 0.5);
    let wave = caustic.focus * caustic_wave(xz);
    let n_ws = normalize(vec3f(-wave.y, 1.0, -wave.z));
    let origin = vec3f(xz.x, water.level + wave.x, xz.y);
    let facing = dot(n_ws, caustic.to_light);
    let lost = caustic.loss * fresnel_dielectric(facing, 1.0, caustic.index[channel]);
    let density = caustic.share * max(facing, 0.0) / (n_ws.y * caustic.to_light.y);
    let flux = density * (1.0 - lost) * caustic_lit(origin);
    let inside = refract(-caustic.to_light, n_ws, 1.0, caustic.index[channel]).direction;
    let ray = caustic_ray(origin, inside);
    var depth_m = 0.0;
    if CAUSTIC_ITERATION {
        depth_m = caustic_iteration(ray);
    } else {
        depth_m = caustic_march(ray);
    }
    let landed = caustic_texel(caustic_seen(ray, depth_m));
    return CausticBeam(landed, flux, depth_m - ray.depth_m, caustic_texel(ray.seen), ray.depth_m);
}

// Share of the lamp that meshes over the surface do not hide
fn caustic_lit(p_ws: vec3f) -> f32 {
    let seen = p_ws.xz + caustic.slope_above * (water.level - p_ws.y);
    let uv = (seen - water.low) / (water.high - water.low);
    let depth = 1.0 - (p_ws.y - water.level - water.wave_low) / caustic.reach_above_m;
    let free = textureSampleCompareLevel(caustic_above, shadow_sampler, uv, caustic.layer, depth);
    return mix(1.0, free, caustic.shadows);
}
