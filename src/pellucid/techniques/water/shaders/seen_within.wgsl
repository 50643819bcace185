// What rays see in water that has borders of its own: they are refracted and mirrored there, and at the surface from below.
//!import optics/snell
//!import surroundings/shaders/radiance
//!import techniques/water/shaders/dilution
//!import techniques/water/shaders/reflectance
//!import techniques/water/shaders/seen_record
//!import techniques/water/shaders/surface

const WITHIN_TURNS = 16u;  // ways, in the water and out of it
const WITHIN_FAINT = 2e-3;  // share of the light that is not followed apart

// `below` for a ray within the water: then the radiance is that at its start, with all that the water does on the way.
// At each border (1 - F) n^2 goes out to what is there, F goes on within; what is left at the end goes straight out. One
// loop for ways within and outside, since each copy of a search through the meshes costs a software driver its time.
fn seen_within(p_ws: vec3f, direction_ws: vec3f, below: bool, n: f32) -> Seen {
    let denser = water_dilution(n, water.n_outside);
    var within = below;
    var origin = p_ws;
    var way = direction_ws;
    var share = vec3f(1.0);   // of the ray that is followed
    var next = p_ws;          // of what waits within, while a way outside is looked at
    var next_way = direction_ws;
    var next_share = vec3f(0.0);
    var radiance = vec3f(0.0);
    var distance_m = 0.0;
    var met = false;
    for (var turn = 0u; turn < WITHIN_TURNS; turn++) {
        let start = origin + frame.ray_epsilon_m * way;
        let border = outline_way(origin, way);
        let out = max(border.far, 0.0);
        let risen = water_crossing(origin, way, 0.0, select(-1.0, out, within), -1.0);
        let end = select(out, risen, risen >= 0.0);
        let hit = trace_opaque(start, way, select(1e30, max(end - frame.ray_epsilon_m, 0.0), within));
        var seen = environment_radiance(way);
        if hit.valid {
            seen = shade_hit(hit, way);
        }
        let endless = within && !hit.valid && end >= WATER_FAR;
        let path = water_path(origin, way, select(0.0, select(end, hit.t, hit.valid), within));
        radiance += share * path.inscatter;
        share *= path.transmittance;
        let done = hit.valid || !within || endless;
        radiance += select(vec3f(0.0), share * seen * select(1.0, denser, endless), done);
        met = met || hit.valid;
        distance_m = select(distance_m, hit.t, turn == 0u && hit.valid && !within);
        if done && within {
            share = vec3f(0.0);
            break;
        }
        if !within {
            within = true;
            origin = next;
            way = next_way;
            share = next_share;
        } else {
            let p = origin + end * way;
            let slope = wave_point(p.xz, 0.0).slope;
            let normal = water_towards(-select(border.far_n, wave_normal(slope), risen >= 0.0), way);
            let mirrored = water_reflectance(-dot(normal, way), n, water.n_outside);
            next = p;
            next_way = reflect(way, normal);
            next_share = mirrored * share;
            origin = p;
            way = refract(way, normal, n, water.n_outside).direction;
            share *= (1.0 - mirrored) * denser;
            within = false;
            if mirrored >= 1.0 {
                within = true;
                way = next_way;
                share = next_share;
            }
        }
        if within && max(share.r, max(share.g, share.b)) < WITHIN_FAINT {
            break;
        }
    }
    // What still waits, and what was still followed: straight out, as if the index fell off smoothly
    let rest = share * select(1.0, denser, within);
    let waits = select(next_share * denser, vec3f(0.0), within);
    radiance += rest * environment_radiance(way) + waits * environment_radiance(next_way);
    return Seen(radiance, distance_m, met);
}
