// What a ray sees where there is more than opaque surfaces: what stands for bodies of water and of glass mirrors it and
// lets it through, branch by branch, the heavier first.
//!import optics/fresnel
//!import optics/snell
//!import surroundings/shaders/across_medium
//!import surroundings/shaders/shade
//!import surroundings/shaders/submerged_scatter

override ACROSS_GLASS: bool = false;  // whether bodies of glass stand in the way of rays
override ACROSS_FIRST: bool = true;   // whether they do so before a ray has met anything else

const ACROSS_TURNS = 16u;   // pieces of the way of one ray and its branches
const ACROSS_STACK = 4u;
const ACROSS_LEAST = 0.01;  // share of a branch that is followed; one below it ends in the environment

struct AcrossRay {
    origin: vec3f,
    direction: vec3f,
    weight: vec3f,       // of basic radiance, L / n^2 with n over that of air
    medium: AcrossMedium,
}

struct Across {
    radiance: vec3f,     // basic
    first_m: f32,        // way to the first surface, ACROSS_FAR where there is none
}

// As one sees it who stands where the camera does: radiance in water is n^2 times as large. What lies beside the
// camera's water is seen as from the air there; the water does the rest.
fn across_viewed(origin_ws: vec3f, direction_ws: vec3f) -> Across {
    let viewer = submerged_at(frame.camera_position);
    let beside = !submerged_within(viewer.water, origin_ws);
    let n = select(vec3f(1.0), submersion.index[viewer.water].rgb, viewer.inside && !beside);
    let medium = across_medium(across_water_at(origin_ws, ACROSS_AIR));
    let seen = across(AcrossRay(origin_ws, direction_ws, vec3f(1.0), medium), true);
    return Across(n * n * seen.radiance, seen.first_m);
}

// `fades` : whether water takes and gives light on the first piece of the way
fn across(first: AcrossRay, fades: bool) -> Across {
    var stack: array<AcrossRay, ACROSS_STACK>;
    var waiting = 0u;
    var ray = first;
    var seen = Across(vec3f(0.0), ACROSS_FAR);
    var going = true;
    for (var turn = 0u; turn < ACROSS_TURNS && going; turn++) {
        let root = select(0u, frame.joint_root, ACROSS_GLASS && (ACROSS_FIRST || turn > 0u));
        let hit = nearest_below(root, ray.origin, ray.direction, ACROSS_FAR, true);
        let event = across_event(ray.origin, ray.direction, ray.medium, hit);
        seen.first_m = select(seen.first_m, event.t, turn == 0u);
        let fading = select(0.0, event.t, turn > 0u || fades);
        seen.radiance += ray.weight * across_glow(ray, fading);
        ray.weight *= across_transmittance(ray.medium, fading);
        let n = submersion.index[max(ray.medium.water, 0)].rgb;
        let dilution = select(vec3f(1.0), 1.0 / (n * n), ray.medium.water >= 0);
        going = false;
        if event.kind == ACROSS_NOTHING {
            seen.radiance += ray.weight * environment_radiance(ray.direction);
        } else if event.kind == ACROSS_MESH {
            seen.radiance += ray.weight * dilution * shade_hit(hit, ray.direction);
        } else {
            going = true;
            let lighter = across_split(&ray, event);
            if waiting == ACROSS_STACK || all(lighter.weight < vec3f(ACROSS_LEAST)) {
                seen.radiance += lighter.weight * environment_radiance(lighter.direction);
            } else {
                stack[waiting] = lighter;
                waiting += 1u;
            }
        }
        if !going && waiting > 0u {
            waiting -= 1u;
            ray = stack[waiting];
            going = true;
        }
    }
    // What is left when the turns are over
    seen.radiance += select(vec3f(0.0), ray.weight, going) * environment_radiance(ray.direction);
    for (var k = 0u; k < waiting; k++) {
        seen.radiance += stack[k].weight * environment_radiance(stack[k].direction);
    }
    return seen;
}

// Whether a ray meets glass, or in air a water, within a way: what no picture of meshes shows
fn across_stands(origin_ws: vec3f, direction_ws: vec3f, way_m: f32, water: i32) -> bool {
    var stands = false;
    if ACROSS_WATER {
        let edge = across_water_edge(origin_ws, direction_ws, water);
        stands = water == ACROSS_AIR && edge.t < way_m;
    }
    if ACROSS_GLASS {
        // The node over all triangles, where there is one, comes just before the first one over glass.
        let all = bvh_nodes[frame.joint_root].link == 0u && bvh_nodes[frame.joint_root].count == 0u;
        let glass = frame.joint_root + select(0u, 1u, all);
        stands = stands || nearest_below(glass, origin_ws, direction_ws, way_m, false).valid;
    }
    return stands;
}

// (1 - F) through, F back [born1999, 1.5.2]: the heavier goes on as the ray, the other is returned
fn across_split(ray: ptr<function, AcrossRay>, event: AcrossEvent) -> AcrossRay {
    let begun = *ray;
    let splits = event.kind == ACROSS_SPLITS;
    let cosine = -dot(event.normal, begun.direction);
    let reflectance = select(0.0, fresnel_dielectric(cosine, begun.medium.index, event.behind.index), splits);
    let bent = refract(begun.direction, event.normal, begun.medium.index, event.behind.index).direction;
    let p_ws = begun.origin + event.t * begun.direction;
    // Triangles may be met again by rounding; the surface of water is left by the medium that the ray is in.
    let solid = begun.medium.glass || event.behind.glass;
    let away = select(0.0, 2.0 * frame.ray_epsilon_m, solid) * event.normal;
    let back = AcrossRay(p_ws + away, reflect(begun.direction, event.normal), reflectance * begun.weight, begun.medium);
    let passing = select(begun.direction, bent, splits);
    let through = AcrossRay(p_ws - away, passing, (1.0 - reflectance) * begun.weight, event.behind);
    if reflectance > 0.5 {
        *ray = back;
        return through;
    }
    *ray = through;
    return back;
}

fn across_transmittance(medium: AcrossMedium, way_m: f32) -> vec3f {
    let k = max(medium.water, 0);
    let wet = submersion.absorption[k].rgb + submersion.scattering[k].rgb;
    // A way through glass without an end has met a gap between triangles.
    let dry = select(medium.absorption, vec3f(0.0), way_m >= ACROSS_FAR);
    return exp(-select(dry, wet, medium.water >= 0) * min(way_m, ACROSS_LONGEST_M));
}

const ACROSS_LONGEST_M = 1e6;

// Basic radiance that water scatters into a piece of the way
fn across_glow(ray: AcrossRay, way_m: f32) -> vec3f {
    let k = u32(max(ray.medium.water, 0));
    let n = submersion.index[k].rgb;
    if !ACROSS_WATER || ray.medium.water < 0 {
        return vec3f(0.0);
    }
    return submerged_inscatter(k, ray.origin, ray.direction, min(way_m, ACROSS_LONGEST_M)) / (n * n);
}
