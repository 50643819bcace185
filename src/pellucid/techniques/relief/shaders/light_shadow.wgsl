// Shadow of the solid layer on itself: the share of a lamp's disc that stands over it.
//!import techniques/relief/shaders/light_horizon
//!import techniques/relief/shaders/light_stepped
//!import techniques/relief/shaders/light_walk

// `tan_radius`: of the angle that the lamp's radius is seen under. The ray begins on the layer, or over it; what lies
// beyond the lamp throws no shadow.
fn relief_shadow(ray: ReliefRay, tan_radius: f32, distance_m: f32) -> f32 {
    if RELIEF_SHADOWS == 0u {
        return 1.0;
    }
    let radius = select(0.0, tan_radius, RELIEF_SHADOWS >= 2u);
    if RELIEF_SHADOWS == 3u {
        return relief_horizon_shadow(ray, radius);
    }
    if RELIEF_LIGHT_STEPPED {
        return relief_stepped_shadow(ray, radius, distance_m);
    }
    return relief_disc_over(ray, max(radius, SHADOW_LEAST_TAN), distance_m);
}

// What stands h under the ray a horizontal way s off is seen at the elevation e' below that of the lamp, e:
// tan e' = tan e - h/s, and tan(e - e') = h/s / (1 + tan e tan e'). h/d of [timonen2006, eq. 1] is cos e h/s.
fn relief_disc_over(ray: ReliefRay, radius: f32, distance_m: f32) -> f32 {
    let cosine = sqrt(max(1.0 - ray.dh * ray.dh, 1e-6));
    let rise = ray.dh / cosine;
    let wide = radius * (1.0 + rise * rise);
    let most = cosine * wide / max(1.0 + rise * radius, 0.1);
    let least = -cosine * wide / max(1.0 - rise * radius, 1e-6);
    let nearest = relief_least_gap(ray, most, least, distance_m) / cosine;
    return disc_share(nearest / (radius * max(1.0 + rise * (rise - nearest), 1e-6)));
}

// min(most, least h/d along the ray), d metres [timonen2006, eq. 1]; ends as soon as it is below `enough`. Squares that
// cannot hold anything nearer than the nearest so far are passed at once. The first texel is left out: there the ray
// would see the facets of the very surface that it starts from.
fn relief_least_gap(ray: ReliefRay, most: f32, enough: f32, distance_m: f32) -> f32 {
    let walk = relief_walk(ray);
    let reach = min(relief_shadow_reach(ray, most), distance_m);
    var t = 1.0 / max(max(abs(walk.step.x), abs(walk.step.y)), 1e-12);
    var least = most;
    var level = min(1u, light_top_level());
    for (var turn = 0u; turn < LIGHT_TURNS && t < reach && least > enough; turn++) {
        let cell = relief_cell(walk, t);
        let node = relief_node(walk, cell, level);
        let leaves = relief_leaves(walk, t, node.far);
        let gap = relief_lowest(ray, t, leaves) - node.bounds.x;
        let free = gap / select(t, leaves, gap > 0.0) >= least;
        if !free && level > 0u {
            level -= 1u;
            continue;
        }
        if !free {
            least = min(least, least_gap_in_cell(solid_gap_in_cell(ray, walk, cell, t), t, min(leaves, reach)));
        }
        t = leaves;
        level = light_next_level(walk, node, cell, t, level);
    }
    return least;
}

// Height of the ray over the solid layer within a cell, as c.x + c.y s + c.z s^2, s metres after t
fn solid_gap_in_cell(ray: ReliefRay, walk: ReliefWalk, cell: vec2f, t: f32) -> vec3f {
    let heights = relief_corners(walk, cell, RELIEF_SOLID);
    let p = walk.origin + t * walk.step - cell;
    let along = heights.y - heights.x;
    let across = heights.z - heights.x;
    let twist = heights.w - heights.z - along;
    let d = walk.step;
    return vec3f(
        relief_height_along(ray, t) - (heights.x + along * p.x + across * p.y + twist * p.x * p.y),
        relief_slope_along(ray, t) - (along * d.x + across * d.y + twist * (p.x * d.y + p.y * d.x)),
        ray.bend - twist * d.x * d.y
    );
}

// Least of (c.x + c.y s + c.z s^2) / t, s = t - begin: at the ends, or where the derivative A / t^2 = C vanishes
fn least_gap_in_cell(c: vec3f, begin: f32, end: f32) -> f32 {
    let s_end = end - begin;
    let a = c.x - begin * (c.y - begin * c.z);
    let t = clamp(sqrt(max(a / select(1e-20, c.z, abs(c.z) > 1e-20), 0.0)), begin, end);
    let s = t - begin;
    let ends = min(c.x / begin, (c.x + s_end * (c.y + s_end * c.z)) / end);
    return min(ends, (c.x + s * (c.y + s * c.z)) / t);
}

// Metres after which even the top of the layer is farther below the ray than `most`
fn relief_shadow_reach(ray: ReliefRay, most: f32) -> f32 {
    let far = min(RELIEF_FAR_TILES / max(length(ray.duv), 1e-9), relief_clip(ray));
    let climb = ray.dh - most;
    let clear = max(relief.solid_high - ray.h, 0.0) / max(climb, 1e-9);
    return select(far, min(far, clear), climb > 0.0 && ray.bend >= 0.0);
}
