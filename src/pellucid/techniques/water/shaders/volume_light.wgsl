// Light that water scatters towards the viewer along a straight way, once, in closed form: that of lamps far away, and of
// the sky. Beams of the first lamp may be cut out of it.
//!import surroundings/shaders/submerged_scatter
//!import techniques/water/shaders/bindings
//!import techniques/water/shaders/god_rays

override WATER_GOD_RAYS: bool = false;

fn water_inscatter(p_ws: vec3f, direction_ws: vec3f, length_m: f32) -> vec3f {
    let depth_m = max(water.level - p_ws.y, 0.0);
    var radiance = beam_inscatter(sky_beam(water.region, direction_ws), depth_m, direction_ws.y, length_m);
    for (var light = 0u; light < light_count(); light++) {
        let towards = lights[light].direction;
        if lights[light].kind != LIGHT_DIRECTIONAL || towards.y <= 0.0 {
            continue;
        }
        let beam = sun_beam(water.region, light, direction_ws);
        if WATER_GOD_RAYS && lights[light].water_layer == 0 {
            let to_light = submerged_direction(towards, water.n_water.g / water.n_outside);
            radiance += god_rays(beam, p_ws, direction_ws, length_m, to_light.xz / to_light.y);
        } else {
            radiance += beam_inscatter(beam, depth_m, direction_ws.y, length_m);
        }
    }
    return radiance;
}
