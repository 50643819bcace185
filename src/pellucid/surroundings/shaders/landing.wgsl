// Where the light of a bundle meets the atlas of caustics.
//!import surroundings/shaders/raycast
//!import surroundings/shaders/splat

@group(0) @binding(2) var<storage, read> outgoing: array<OutPatch>;

var<workgroup> missed: array<atomic<u32>, 6>;

fn land_ray(origin_ws: vec3f, way_ws: vec3f) -> ChartPoint {
    let hit = nearest_surface(origin_ws, way_ws, 1e30, false);
    let chart = select(0u, chart_of(hit.triangle, -way_ws), hit.valid);
    return chart_point(chart, origin_ws + select(0.0, hit.t, hit.valid) * way_ws);
}

fn bundle_corner(bundle: OutPatch, corner: u32) -> vec3f {
    switch corner {
        case 0u: { return bundle.corner_0; }
        case 1u: { return bundle.corner_1; }
        case 2u: { return bundle.corner_2; }
        default: { return bundle.corner_3; }
    }
}

fn bundle_way(bundle: OutPatch, corner: u32) -> vec3f {
    switch corner {
        case 0u: { return bundle.way_0; }
        case 1u: { return bundle.way_1; }
        case 2u: { return bundle.way_2; }
        default: { return bundle.way_3; }
    }
}

// Light that no chart receives is counted, so that energy can be checked: in the workgroup first, which is quicker
fn miss(units: vec3f, kind: u32, noise: f32) {
    let whole = floor(units + noise);
    atomicAdd(&missed[3u * kind], u32(whole.x));
    atomicAdd(&missed[3u * kind + 1u], u32(whole.y));
    atomicAdd(&missed[3u * kind + 2u], u32(whole.z));
}

// Drivers have been met that hand out workgroup memory as the last kernel left it
fn clear_missed(local: u32) {
    if local < SUMS_PER_TEXEL {
        atomicStore(&missed[local], 0u);
    }
    workgroupBarrier();
}

fn add_missed(local: u32) {
    if local < SUMS_PER_TEXEL {
        atomicAdd(&flux_sums[SUMS_PER_TEXEL * landing.width * landing.height + local], atomicLoad(&missed[local]));
    }
}
