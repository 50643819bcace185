// Second pass: the radiance of what each pixel shows of the water.
//!import surroundings/shaders/full_picture
//!import techniques/water/shaders/dilution
//!import techniques/water/shaders/interface

// A camera within water measures L / n^2, as one does that stands in air behind a round port: so a picture neither
// jumps where it dives, nor does an even sky look brighter from below.
@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let record = textureLoad(water_hits, vec2i(position.xy), 0);
    let hit = water_hit(record);
    let ray = camera_ray(water_pixel(position.xy, water_hit_pick(record)));
    let p_ws = ray.origin + hit.t * ray.direction;
    var radiance = textureLoad(opaque_color, vec2i(position.xy), 0).rgb;  // none where pixels share a ray
    let denser = water_dilution(water.n_water.g, water.n_outside);
    let within = water_is_within(hit.kind);
    let meets = water_meets(hit.kind);
    radiance = select(radiance, vec3f(0.0), meets);
    radiance *= select(1.0, denser, hit.kind == WATER_OUT);
    let light = interface_light(hit, meets, p_ws, ray.direction);
    // The way behind the surface, then that before it: one loop, of which a camera in air takes one turn
    for (var turn = select(1u, 0u, meets); turn < select(1u, 2u, within); turn++) {
        let before = turn == 1u;
        let way = select(light.way, ray.direction, before);
        let path = water_path(select(p_ws, ray.origin, before), way, select(light.way_m, hit.t, before));
        let behind = light.radiance + path.transmittance * light.wet + light.share * path.inscatter;
        radiance = select(behind, (path.transmittance * radiance + path.inscatter) / denser, before);
    }
    if hit.kind == WATER_NONE {
        discard;
    }
    // Where pixels share a ray they look for how deep it went, which is linear in the picture on planes.
    return vec4f(radiance, select(1.0, depth_of(p_ws), water.block.x * water.block.y > 1u));
}
