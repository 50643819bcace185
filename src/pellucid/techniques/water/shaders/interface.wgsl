// Radiance that the surface of water sends to a viewer on either side of it.
//!import optics/rough_water
//!import optics/snell
//!import techniques/water/shaders/dilution
//!import techniques/water/shaders/foam
//!import techniques/water/shaders/glitter
//!import techniques/water/shaders/hit
//!import techniques/water/shaders/reflectance
//!import techniques/water/shaders/seen
//!import techniques/water/shaders/surface
//!import techniques/water/shaders/underside
//!import techniques/water/shaders/volume

override WATER_DISPERSION: bool = false;

// What a surface sends: radiance that goes no way through water, and what one ray in the water sees at its end
struct InterfaceLight {
    radiance: vec3f,
    wet: vec3f,     // at the end of that ray, times its share
    share: vec3f,   // of all that the ray brings
    way: vec3f,     // its direction
    way_m: f32,
}

// (1 - F) (n_i / n_t)^2 of what the refracted ray sees, F of what the mirrored one sees [born1999, 4.8.3]. All rays go
// through one place.
fn interface_light(hit: WaterHit, meets: bool, p_ws: vec3f, direction_ws: vec3f) -> InterfaceLight {
    let from_within = hit.kind == WATER_BELOW || hit.kind == WATER_RIM;
    let border = water_is_border(hit.kind);
    // That of a pixel where a block of them shares this too: its mean slope would mirror less than all of theirs.
    let footprint = footprint_m(p_ws) * inverseSqrt(max(abs(direction_ws.y), 1e-3));
    let at = wave_point(p_ws.xz, footprint);
    // Of waves that a pixel hides those are seen that lean towards the viewer.
    let towards = select(-direction_ws, direction_ws, from_within);
    let up = wave_normal(visible_slope(towards, at.slope, at.variance));
    let outward = select(up, hit.normal, border);
    let n_ws = water_towards(select(outward, -outward, from_within), direction_ws);
    let cos_i = -dot(n_ws, direction_ws);
    let refracted_rays = select(1u, 3u, WATER_DISPERSION);
    // None for pixels that show no surface: of loops a software driver executes one turn for them, of branches all
    let rays = select(0u, refracted_rays + 1u, meets);
    var radiance = vec3f(0.0);
    var wet = InterfaceLight(vec3f(0.0), vec3f(0.0), vec3f(0.0), direction_ws, 0.0);
    var reflected = vec3f(0.0);
    for (var k = 0u; k < rays; k++) {
        let mirrors = k == refracted_rays;
        let n = select(water.n_water[min(k, 2u)], water.n_water.g, !WATER_DISPERSION || mirrors);
        let n_i = select(water.n_outside, n, from_within);
        let n_t = select(n, water.n_outside, from_within);
        let channels = select(vec3f(1.0), vec3f(vec3u(k) == vec3u(0u, 1u, 2u)), WATER_DISPERSION);
        var passing = refract(direction_ws, n_ws, n_i, n_t).direction;
        var share = water_reflectance(cos_i, n_i, n_t);
        if WATER_UNDERSIDE == 1u {
            passing = select(passing, underside_way(direction_ws, n_ws, n_i, n_t), from_within);
            share = select(share, underside_reflectance(cos_i, n_i, n_t), from_within);
        }
        let weight = select(channels * (1.0 - share) * water_dilution(n_i, n_t), reflected, mirrors);
        if !mirrors {
            reflected += channels * share;
        }
        let below = mirrors == from_within;
        let way = select(passing, water_mirrored(direction_ws, n_ws, hit.kind), mirrors);
        if any(weight > vec3f(0.0)) {
            let seen = seen_along(p_ws, way, below, border, n);
            if WATER_DISPERSION {
                radiance += weight * water_look(seen, p_ws, way, below);
            } else if below {
                wet = InterfaceLight(vec3f(0.0), weight * seen.radiance, weight, way, seen.distance_m);
            } else {
                radiance += weight * seen.radiance;
            }
        }
    }
    if meets {
        let glints = water_glitter(p_ws, at, -direction_ws, from_within);
        radiance += select(glints, vec3f(0.0), border);
        if WATER_FOAM {
            let covered = foam_cover(p_ws.xz, at.fold, footprint_m(p_ws));
            let cover = select(covered, 0.0, border);
            radiance = mix(radiance, foam_radiance(p_ws, wave_normal(at.slope), from_within), cover);
            wet.wet *= 1.0 - cover;
            wet.share *= 1.0 - cover;
        }
    }
    return InterfaceLight(radiance, wet.wet, wet.share, wet.way, wet.way_m);
}

// What a ray sees, through water where it is within
fn water_look(seen: Seen, p_ws: vec3f, direction_ws: vec3f, below: bool) -> vec3f {
    if !below {
        return seen.radiance;
    }
    let path = water_path(p_ws, direction_ws, seen.distance_m);
    return path.transmittance * seen.radiance + path.inscatter;
}

// A ray that a wave mirrors towards other waves is mirrored there once more, as if they were level
fn water_mirrored(direction_ws: vec3f, n_ws: vec3f, kind: u32) -> vec3f {
    let way = reflect(direction_ws, n_ws);
    let upright = vec3f(way.x, select(abs(way.y), -abs(way.y), kind == WATER_BELOW), way.z);
    return select(upright, way, water_is_border(kind));
}
