// What a ray meets that leaves a place in level water for the sky; see open_sky.py.
//!import surroundings/shaders/raycast
//!struct OpenSky from surroundings.layouts

@group(0) @binding(0) var<uniform> open_sky: OpenSky;
@group(0) @binding(1) var<storage, read> open_ways: array<vec4f>;  // unit directions in air
@group(0) @binding(2) var<storage, read_write> open_met: array<u32>;  // place by place, direction by direction

const OPEN_SIZE = vec3u(24u, 8u, 24u);  // layouts.OPEN_SIZE
const OPEN_BACK = 0x80000000u;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= OPEN_SIZE.x * OPEN_SIZE.y * OPEN_SIZE.z {
        return;
    }
    let cell = vec3u(id.x % OPEN_SIZE.x, (id.x / OPEN_SIZE.x) % OPEN_SIZE.y, id.x / (OPEN_SIZE.x * OPEN_SIZE.y));
    let p_ws = mix(open_sky.low, open_sky.high, (vec3f(cell) + 0.5) / vec3f(OPEN_SIZE));
    let above = open_ways[id.y].xyz;
    let aside = above.xz / open_sky.index;
    let inside = vec3f(aside.x, sqrt(max(1.0 - dot(aside, aside), 1e-4)), aside.y);
    let wet_m = max(open_sky.level - p_ws.y, 0.0) / inside.y;
    var met = 0u;
    for (var part = 0u; part < 2u; part++) {
        let dry = part == 1u;
        let direction = select(inside, above, dry);
        let hit = nearest_surface(p_ws + select(0.0, wet_m, dry) * inside, direction, select(wet_m, 1e30, dry), false);
        if hit.valid {
            let back = triangle_plane_entry(hit.triangle, p_ws, direction).w < 0.0;
            met = select(met, (hit.triangle + 1u) | select(0u, OPEN_BACK, back), met == 0u);
        }
        if met != 0u {
            break;
        }
    }
    open_met[id.y * (OPEN_SIZE.x * OPEN_SIZE.y * OPEN_SIZE.z) + id.x] = met;
}
