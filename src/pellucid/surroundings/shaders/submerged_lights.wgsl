// Light of all lamps where some surfaces stand in water. In air it is that of lights.wgsl.
//!import surroundings/shaders/submerged_lamp
//!import surroundings/shaders/submerged_sky
//!import surroundings/shaders/submerged_sun

// `seen` is what lamp_seen tells.
fn sample_light_anywhere(
    light: u32, index: u32, p_ws: vec3f, n_ws: vec3f, at: Submerged, seen: f32
) -> LightSample {
    if LAMPS_FAR && (!LAMPS_NEAR || lights[light].kind == LIGHT_DIRECTIONAL) {
        let wet = sample_submerged_sun(light, p_ws, n_ws, at, seen);
        let direction = select(lights[light].direction, wet.direction, at.inside);
        return LightSample(direction, select(lights[light].power * seen, wet.irradiance, at.inside));
    }
    if LAMPS_NEAR {
        return sample_near_light_anywhere(light, index, p_ws, n_ws, at);
    }
    return LightSample(n_ws, vec3f(0.0));
}

// Share of a lamp far away that meshes leave: by the map of the water that a point is in, as far as that reaches. Past
// walls, if there are any, light has not come in through the surface, and casts shadows as in air.
fn lamp_seen(light: u32, p_ws: vec3f, n_ws: vec3f, at: Submerged) -> f32 {
    if !LAMPS_FAR {
        return 1.0;
    }
    let in_air = shadow_visibility(light, p_ws, n_ws);
    let layer = u32(max(lights[light].water_layer, 0));
    let camera = submersion.slope[at.water * MAX_WATER_LIGHTS + layer];
    let mapped = submerged_mapped(at.water, submerged_entry(p_ws, submersion.level[at.water].x, camera.xy));
    let map = u32(submersion.level[at.water].z) + layer;
    let below = mix(1.0, submerged_visibility(at.water, map, p_ws, n_ws, camera.xy), camera.z);
    return select(in_air, below, at.inside && mapped);
}

// As sample_near_light. A lamp over the water lights what is in it through the level surface, exactly, times what its map
// says of waves and of shadows above them (caustic_near.wgsl); in air, or from a lamp in the water, light goes straight,
// and is weakened in the water. Both parts of a bent way share the code of one shadow ray.
fn sample_near_light_anywhere(light: u32, index: u32, p_ws: vec3f, n_ws: vec3f, at: Submerged) -> LightSample {
    let is_area = lights[light].kind == LIGHT_AREA;
    let cell = vec2f(f32(index % AREA_STRATA), f32(index / AREA_STRATA));
    let st = (cell + light_jitter(p_ws, index + 31u * light)) / f32(AREA_STRATA) - 0.5;
    let aside = st.x * lights[light].edge_u + st.y * lights[light].edge_v;
    let lamp_ws = lights[light].position + select(vec3f(0.0), aside, is_area);
    let layer = u32(max(lights[light].water_layer, 0));
    let has_map = lights[light].water_layer >= 0 && submersion.slope[at.water * MAX_WATER_LIGHTS + layer].w > 0.5;
    let level_m = select(p_ws.y + at.depth_m, submersion.level[at.water].x, has_map);
    let bent = at.inside && lamp_ws.y > level_m;
    let n = submersion.index[at.water].rgb;
    // Of the lamp's middle first, which tells the place on its map
    var way = WetWay(p_ws, n_ws, n_ws, 1.0, 1.0, 1.0);
    var came = p_ws.xz;
    for (var part = 0u; part < select(1u, 2u, is_area && has_map); part++) {
        let from_ws = select(lamp_ws, lights[light].position, part == 0u);
        way = submerged_way(p_ws, from_ws, select(p_ws.y - 1.0, level_m, bent), n.g);
        came = select(came, way.crossing.xz, part == 0u);
    }
    let uv = submerged_uv(at.water, came);
    let mapped = bent && has_map && submerged_mapped(at.water, came);
    let straight = lamp_ws - p_ws;
    let d2 = max(dot(straight, straight), 1e-12);
    let direction = select(straight * inverseSqrt(d2), way.below, bent);
    let from_lamp = select(direction, way.above, bent);
    let cosine = -dot(from_lamp, lights[light].direction);
    let area = length(cross(lights[light].edge_u, lights[light].edge_v)) / f32(AREA_STRATA * AREA_STRATA);
    let strength = select(1.0, cosine * area, is_area) / select(d2, way.spread_m2, bent);
    if strength <= 0.0 || dot(n_ws, direction) <= 0.0 {
        return LightSample(direction, vec3f(0.0));
    }
    var reaches = true;
    if lights[light].shadow_layer >= 0 {
        for (var part = 0u; part < 2u; part++) {
            let start = select(p_ws + n_ws * frame.ray_epsilon_m, way.crossing, part == 1u);
            let length_m = select(select(sqrt(d2), way.below_m, bent), way.above_m, part == 1u);
            let shortened = length_m - 2.0 * frame.ray_epsilon_m;
            let needed = reaches && (part == 0u || bent && !mapped);
            if needed && occluded(start, select(direction, way.above, part == 1u), shortened) {
                reaches = false;
            }
        }
    }
    let extinction = submersion.absorption[at.water].rgb + submersion.scattering[at.water].rgb;
    let risen_m = select(0.0, submerged_wave(at.water, way.crossing.xz) / max(way.below.y, 0.05), mapped);
    let wet_m = max(select(0.0, select(sqrt(d2), way.below_m + risen_m, bent), at.inside), 0.0);
    let through = textureSampleLevel(submerged_light, caustic_sampler, uv, u32(submersion.level[at.water].z) + layer, 0.0);
    let passed = select(select(vec3f(1.0), 1.0 - submerged_reflectance(way.above.y, n), bent), through.rgb, mapped);
    return LightSample(direction, lights[light].power * passed * exp(-extinction * wet_m) * select(0.0, strength, reaches));
}
