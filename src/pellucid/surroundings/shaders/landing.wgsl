// Where the light of a bundle meets the atlas of caustics.
//!import surroundings/shaders/raycast
//!import surroundings/shaders/splat
//!import surroundings/shaders/bundles

@group(0) @binding(2) var<storage, read> outgoing: array<OutPatch>;

var<workgroup> missed: array<atomic<i32>, 6>;

fn land_ray(origin_ws: vec3f, way_ws: vec3f) -> ChartPoint {
    let hit = nearest_surface(origin_ws, way_ws, 1e30, false);
    landed_triangle = hit.triangle;
    let chart = select(0u, chart_of(hit.triangle, -way_ws), hit.valid);
    return chart_point(chart, origin_ws + select(0.0, hit.t, hit.valid) * way_ws);
}

var<private> landed_triangle: u32;  // of the last ray that was landed

// Where a ray of a bundle meets the plane of a triangle, on the triangle's chart
fn land_on_plane(bundle: OutPatch, st: vec2f, triangle: u32, point: ChartPoint) -> vec2f {
    let origin_ws = bundle_point(bundle, st);
    let way_ws = bundle_direction(bundle, st);
    let t = triangle_plane_entry(triangle, origin_ws, way_ws).x;
    let at = chart_point(point.chart, origin_ws + t * way_ws).at;
    return select(point.at, at, t > 0.0);
}

// Light that no chart receives is counted, so that energy can be checked: in the workgroup first, which is quicker
fn miss(units: vec3f, kind: u32, noise: f32) {
    let whole = floor(units + noise);
    atomicAdd(&missed[3u * kind], i32(whole.x));
    atomicAdd(&missed[3u * kind + 1u], i32(whole.y));
    atomicAdd(&missed[3u * kind + 2u], i32(whole.z));
}

// Drivers have been met that hand out workgroup memory as the last kernel left it
fn clear_missed(local: u32) {
    if local < SUMS_PER_TEXEL {
        atomicStore(&missed[local], 0);
    }
    workgroupBarrier();
}

fn add_missed(local: u32) {
    if local < SUMS_PER_TEXEL {
        atomicAdd(&flux_sums[SUMS_PER_TEXEL * landing.width * landing.height + local], atomicLoad(&missed[local]));
    }
}
