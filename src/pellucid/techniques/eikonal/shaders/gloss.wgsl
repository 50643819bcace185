// What the lobe about a mirrored ray sees: lamps, nearby meshes, and the environment behind them [tevs2007, eq. 5.8].

//!import surroundings/shaders/radiance
//!import techniques/eikonal/shaders/brdf_table
//!import techniques/eikonal/shaders/visible_normal
//!struct LookRay from techniques.eikonal.layouts

override HAS_MESHES: bool = true;

const GLOSS_MIN_ALPHA = 1e-4;
const GLOSS_LOBE_SALT = 7919u;   // apart from the numbers that lights.wgsl draws

struct Lobe {
    n: vec3f,
    v: vec3f,
    alpha: f32,
    table: u32,       // layer of a tabulated BRDF; 0: GGX
    per_albedo: f32,  // GGX: so that its lobe sends back all that arrives
}

fn lobe_of(ray: LookRay, table: u32) -> Lobe {
    let v = ray.direction - 2.0 * dot(ray.direction, ray.normal) * ray.normal;
    let n_dot_v = clamp(dot(-v, ray.normal), 1e-4, 1.0);
    let by_table = table_lobe_albedo(table, n_dot_v).a;
    let alpha = select(ray.roughness * ray.roughness, by_table, table > 0u);
    return Lobe(ray.normal, -v, max(alpha, GLOSS_MIN_ALPHA), table, 1.0 / ggx_directional_albedo(n_dot_v, ray.roughness));
}

// f_r, 1/sr, but for Fresnel's factor
fn lobe_value(lobe: Lobe, l: vec3f) -> vec3f {
    if (lobe.table > 0u) { return tabulated_brdf(lobe.table, lobe.n, lobe.v, l); }
    let h = normalize(lobe.v + l);
    // 1 - (n.h)^2 from the cross product: a cosine near 1 has lost the digits that a sharp lobe lives on.
    let a2 = lobe.alpha * lobe.alpha;
    let off = cross(lobe.n, h);
    let d = a2 + (1.0 - a2) * dot(off, off);
    let n_dot_v = clamp(dot(lobe.n, lobe.v), 1e-4, 1.0);
    return vec3f(a2 / (GGX_PI * d * d) * ggx_visibility(dot(lobe.n, l), n_dot_v, lobe.alpha) * lobe.per_albedo);
}

// Radiance that lamps send into the viewer's direction by the lobe
fn lamps_in_lobe(lobe: Lobe, p_ws: vec3f) -> vec3f {
    var radiance = vec3f(0.0);
    for (var light = 0u; light < light_count(); light++) {
        let wide = lights[light].kind == LIGHT_AREA;
        let samples = light_sample_count(light);
        for (var k = 0u; k < samples; k++) {
            let sample = sample_light(light, k, p_ws, lobe.n);
            let n_dot_l = dot(lobe.n, sample.direction);
            if (n_dot_l > 0.0 && any(sample.irradiance > vec3f(0.0))) {
                let share = select(1.0, share_of_light_sample(lobe, light, p_ws, sample.direction), wide);
                radiance += share * lobe_value(lobe, sample.direction) * sample.irradiance * n_dot_l;
            }
            if (wide) { radiance += rectangle_in_lobe(lobe, light, k, p_ws) / f32(samples); }
        }
    }
    return radiance;
}

// A rectangle is sampled both ways, by its area and by the lobe, and each sample is trusted as the other way would have found it
// [veach1995, balance heuristic]: lobes may be far sharper, or far wider, than the lamp.
fn share_of_light_sample(lobe: Lobe, light: u32, p_ws: vec3f, l: vec3f) -> f32 {
    let by_area = area_light_density(light, p_ws, l);
    return by_area / max(by_area + lobe_density(lobe, l), 1e-20);
}

fn lobe_density(lobe: Lobe, l: vec3f) -> f32 {
    return visible_normal_density(lobe.n, lobe.v, normalize(lobe.v + l), lobe.alpha) / max(4.0 * dot(lobe.v, normalize(lobe.v + l)), 1e-6);
}

// Of directions that sample the area evenly, 1/sr
fn area_light_density(light: u32, p_ws: vec3f, l: vec3f) -> f32 {
    let facing = -dot(l, lights[light].direction);
    let t = dot(lights[light].position - p_ws, lights[light].direction) / min(-facing, -1e-6);
    let area = length(cross(lights[light].edge_u, lights[light].edge_v));
    return t * t / max(facing * area, 1e-20);
}

fn rectangle_in_lobe(lobe: Lobe, light: u32, k: u32, p_ws: vec3f) -> vec3f {
    let h = visible_normal(lobe.n, lobe.v, lobe.alpha, light_jitter(p_ws, GLOSS_LOBE_SALT + k + 31u * light));
    let l = 2.0 * dot(lobe.v, h) * h - lobe.v;
    let facing = -dot(l, lights[light].direction);
    let n_dot_l = dot(lobe.n, l);
    if (facing <= 1e-6 || n_dot_l <= 0.0) { return vec3f(0.0); }
    let t = -dot(lights[light].position - p_ws, lights[light].direction) / facing;
    let at = p_ws + t * l - lights[light].position;
    // Coordinates in edges that need not be perpendicular
    let normal = cross(lights[light].edge_u, lights[light].edge_v);
    let s = dot(cross(at, lights[light].edge_v), normal) / dot(normal, normal);
    let r = dot(cross(lights[light].edge_u, at), normal) / dot(normal, normal);
    if (t <= 0.0 || abs(s) > 0.5 || abs(r) > 0.5) { return vec3f(0.0); }
    if (!light_reaches(light, p_ws, lobe.n, l, t)) { return vec3f(0.0); }
    return lobe_value(lobe, l) * lights[light].power * n_dot_l / (lobe_density(lobe, l) + area_light_density(light, p_ws, l));
}

// All that the lobe sees. Meshes are sought by one ray of it, which makes noise near them that averages out over samples; where it
// finds none, the blurred environment stands for all of its rays.
fn radiance_in_lobe(lobe: Lobe, p_ws: vec3f) -> vec3f {
    let n_dot_v = clamp(dot(lobe.n, lobe.v), 1e-4, 1.0);
    let mirrored = 2.0 * dot(lobe.v, lobe.n) * lobe.n - lobe.v;
    var seen = environment_glossy(mirrored, lobe.alpha);
    if (HAS_MESHES) {
        let h = visible_normal(lobe.n, lobe.v, lobe.alpha, light_jitter(p_ws, GLOSS_LOBE_SALT));
        let l = 2.0 * dot(lobe.v, h) * h - lobe.v;
        let way = select(mirrored, l, dot(l, lobe.n) > 0.0);
        let hit = trace_opaque(p_ws + lobe.n * frame.ray_epsilon_m, way, 1e30);
        if (hit.valid) { seen = shade_hit(hit, way); }
    }
    if (lobe.table == 0u) { return seen; }
    let matt = table_matt_albedo(lobe.table) * environment_irradiance(lobe.n) / GGX_PI;
    return table_lobe_albedo(lobe.table, n_dot_v).rgb * seen + matt;
}
