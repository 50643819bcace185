// Bundles that leave refractive matter land on the meshes: one invocation a bundle. Those that are very wide,
// or that parts of different charts receive, wait for land_wide.wgsl.
//!import surroundings/shaders/landing
//!struct LookCount from surroundings.layouts

const WIDE = 64.0;           // texels across that a bundle is taken at its corners' word
const NARROW_COS = 0.95;     // rays of a bundle less than 18 degrees apart: when all miss, so does what is between

struct WideQueue {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

@group(0) @binding(3) var<storage, read> outgoing_queue: LookCount;
@group(0) @binding(4) var<storage, read_write> wide_queue: WideQueue;
@group(0) @binding(5) var<storage, read_write> wide_bundles: array<u32>;

const WIDE_GROUPS = 16384u;   // at most; each then takes several rounds

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    clear_missed(local);
    if id.x < min(outgoing_queue.count, arrayLength(&outgoing)) {
        land(id.x);
    }
    workgroupBarrier();
    add_missed(local);
}

fn land(index: u32) {
    let bundle = outgoing[index];
    var corners = array<vec2f, 4>();
    var point = ChartPoint(0u, vec2f(0.0), vec2f(0.0), vec2f(0.0));
    var torn = false;
    var least_cos = 1.0;
    for (var k = 0u; k < 4u; k++) {
        let way = bundle_way(bundle, k);
        let landed = land_ray(bundle_corner(bundle, k), way);
        corners[k] = landed.at;
        torn = torn || (k > 0u && landed.chart != point.chart);
        least_cos = min(least_cos, dot(way, bundle.way_0));
        point = landed;
    }
    let q = Quad(corners[0], corners[1], corners[2], corners[3]);
    let units = bundle.flux * landing.units_per_flux;
    let noise = bundle_noise(bundle, 0u);
    let lost = !torn && point.chart == 0u && least_cos > NARROW_COS;
    if lost {
        miss(units, bundle.kind, noise);
    } else if torn || point.chart == 0u || quad_extent(q) > WIDE {
        let place = atomicAdd(&wide_queue.count, 1u);
        atomicMax(&wide_queue.groups_x, min(place + 1u, WIDE_GROUPS));
        wide_bundles[place] = index;
    } else {
        spread(q, point, units, bundle.kind, noise);
    }
}
