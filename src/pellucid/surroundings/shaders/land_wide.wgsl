// A bundle that is very wide, or torn by an edge, is cut into 8 x 8 parts: one workgroup a bundle, one invocation a
// part. The middle of each part is traced; its light lies around there.
//!import surroundings/shaders/landing
//!struct LookCount from surroundings.layouts

const PARTS = 8u;
const POINT_EXTENT = 0.5;  // texels

@group(0) @binding(3) var<storage, read> wide_queue: LookCount;
@group(0) @binding(4) var<storage, read> wide_bundles: array<u32>;

var<workgroup> corners: array<vec2f, 4>;
var<workgroup> charts: array<u32, 4>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    clear_missed(local);
    for (var k = group.x; k < wide_queue.count; k += groups.x) {
        let index = wide_bundles[k];
        if local < 4u {
            let landed = land_ray(bundle_corner(outgoing[index], local), bundle_way(outgoing[index], local));
            corners[local] = landed.at;
            charts[local] = landed.chart;
        }
        workgroupBarrier();
        land_part(index, local);
        workgroupBarrier();
    }
    add_missed(local);
}

fn land_part(index: u32, part: u32) {
    let bundle = outgoing[index];
    let low = vec2f(f32(part % PARTS), f32(part / PARTS)) / f32(PARTS);
    let middle = low + 0.5 / f32(PARTS);
    let point = land_ray(bundle_point(bundle, middle), bundle_direction(bundle, middle));
    let units = bundle.flux * (landing.units_per_flux / f32(PARTS * PARTS));
    let noise = bundle_noise(bundle, 1u + part);
    if point.chart == 0u {
        miss(units, bundle.kind, noise);
        return;
    }
    var q = quad_part(Quad(corners[0], corners[1], corners[2], corners[3]), low, low + 1.0 / f32(PARTS));
    if any(vec4u(charts[0], charts[1], charts[2], charts[3]) != vec4u(point.chart)) {
        q = torn_part(bundle, low, landed_triangle, point);
    }
    spread(q, point, units, bundle.kind, noise);
}

// Where a part lies whose bundle is torn: on the plane that its middle hits. A small one goes to that point alone, for
// nobody knows how much of it hangs over the edge; a large one would leave dots.
fn torn_part(bundle: OutPatch, low: vec2f, triangle: u32, point: ChartPoint) -> Quad {
    let high = low + 1.0 / f32(PARTS);
    let q = Quad(
        land_on_plane(bundle, low, triangle, point), land_on_plane(bundle, vec2f(high.x, low.y), triangle, point),
        land_on_plane(bundle, vec2f(low.x, high.y), triangle, point), land_on_plane(bundle, high, triangle, point)
    );
    if quad_extent(q) < POINT_EXTENT {
        return Quad(point.at, point.at, point.at, point.at);
    }
    return q;
}
