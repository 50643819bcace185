// What rays see that leave the surface of water: the meshes themselves, or what is infinitely far away.
//!import surroundings/shaders/radiance
//!import techniques/water/shaders/seen_record
//!import techniques/water/shaders/body

// `below` for a ray within the water. What lies beyond its borders is seen as if the index fell off smoothly there:
// rays go on straight, and radiance is n^2 times that outside.
fn seen_rays(p_ws: vec3f, direction_ws: vec3f, below: bool) -> Seen {
    let start = p_ws + frame.ray_epsilon_m * direction_ws;
    let denser = water.n_water / water.n_outside;
    if ACROSS_WATER || ACROSS_GLASS {
        let medium = across_medium(select(ACROSS_AIR, i32(water.region), below));
        let seen = across(AcrossRay(start, direction_ws, vec3f(1.0), medium), !below);
        let radiance = seen.radiance * select(vec3f(1.0), denser * denser, below);
        return Seen(radiance, min(seen.first_m, water_way(p_ws, direction_ws)), seen.first_m < ACROSS_FAR);
    }
    let hit = trace_opaque(start, direction_ws, 1e30);
    var radiance = environment_radiance(direction_ws);
    if hit.valid {
        radiance = shade_hit(hit, direction_ws);
    }
    let way = select(1e30, hit.t, hit.valid);
    let inside = water_way(p_ws, direction_ws);
    let end = start + way * direction_ws;
    let leaves = below && !(hit.valid && water_reaches(end) && end.y < water.level + water.wave_high);
    return Seen(radiance * select(vec3f(1.0), denser * denser, leaves), min(way, inside), hit.valid);
}
