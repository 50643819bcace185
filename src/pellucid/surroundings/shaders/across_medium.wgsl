// Where a ray that may meet water and glass ends, goes on or is split.
//!import surroundings/shaders/across_water
//!import surroundings/shaders/raycast
//!import surroundings/shaders/surface

override ACROSS_WATER: bool = false;  // whether waters stand in the way of rays

const ACROSS_COVER = 2e-5;  // a mesh that stands on the border of a water may lie this share of the way behind it
const ACROSS_GRAZING = 1e-4;  // least cosine between an interpolated normal and a ray

const ACROSS_NOTHING = 0u;
const ACROSS_MESH = 1u;
const ACROSS_SPLITS = 2u;
const ACROSS_PASSES = 3u;

// What a ray goes through
struct AcrossMedium {
    index: f32,         // over that of air
    water: i32,         // number of the water, or ACROSS_AIR
    glass: bool,
    absorption: vec3f,  // 1/m, of glass
}

struct AcrossEvent {
    kind: u32,
    t: f32,
    normal: vec3f,        // unit, towards where the ray comes from
    behind: AcrossMedium,
}

fn across_medium(water: i32) -> AcrossMedium {
    let index = submersion.index[max(water, 0)].g;
    return AcrossMedium(select(1.0, index, water >= 0), water, false, vec3f(0.0));
}

fn across_event(origin_ws: vec3f, direction_ws: vec3f, medium: AcrossMedium, hit: SurfaceHit) -> AcrossEvent {
    var event = AcrossEvent(ACROSS_NOTHING, ACROSS_FAR, -direction_ws, medium);
    if hit.valid {
        event.kind = ACROSS_MESH;
        event.t = hit.t;
        let inner = materials[bvh_triangles[hit.triangle].material].inner;
        if inner.w > 0.0 {
            event = across_boundary(origin_ws, direction_ws, medium, hit);
        }
    }
    if ACROSS_WATER {
        let edge = across_water_edge(origin_ws, direction_ws, medium.water);
        let flat = abs(edge.normal.y) > 0.5 && edge.splits;
        if !medium.glass && edge.t * select(1.0 + ACROSS_COVER, 1.0, flat) < event.t {
            let kind = select(ACROSS_PASSES, ACROSS_SPLITS, edge.splits);
            let normal = select(-direction_ws, edge.normal, edge.splits);
            event = AcrossEvent(kind, edge.t, normal, across_medium(edge.behind));
        }
    }
    return event;
}

// The surface of a body of glass. One that a ray leaves without having entered is passed: the ray began just below it.
fn across_boundary(origin_ws: vec3f, direction_ws: vec3f, medium: AcrossMedium, hit: SurfaceHit) -> AcrossEvent {
    let surface = surface_at(hit.triangle, hit.barycentric, -direction_ws);
    let face = face_normal(hit.triangle, -direction_ws);
    let n = select(surface.n_ws, face, dot(surface.n_ws, direction_ws) > -ACROSS_GRAZING);
    let inner = materials[surface.material].inner;
    let outer = materials[surface.material].outer;
    let corner = bvh_triangles[hit.triangle].corner_0;
    let outward = cross(bvh_triangles[hit.triangle].corner_1 - corner, bvh_triangles[hit.triangle].corner_2 - corner);
    let enters = dot(outward, direction_ws) < 0.0;
    var behind = AcrossMedium(inner.w, ACROSS_AIR, true, inner.rgb);
    if !enters {
        behind = AcrossMedium(outer.w, ACROSS_AIR, true, outer.rgb);
        if outer.w <= 0.0 {
            behind = across_medium(ACROSS_AIR);
            if ACROSS_WATER {
                behind = across_medium(across_water_at(surface.p_ws, ACROSS_AIR));
            }
        }
    }
    let passes = !enters && !medium.glass;
    if passes {
        behind = medium;
    }
    // What is passed has to be left behind.
    let t = hit.t + select(0.0, 2.0 * frame.ray_epsilon_m, passes);
    return AcrossEvent(select(ACROSS_SPLITS, ACROSS_PASSES, passes), t, select(n, -direction_ws, passes), behind);
}
