// Rays that have left the refractive matter wait in a list: what they see is found out by a kernel of its own, which is much
// cheaper than to carry the shading of a whole scene through the loops of the march [laine2013].

//!import techniques/eikonal/shaders/bindings
//!struct DrawParams from techniques.eikonal.layouts
//!struct LookRay from techniques.eikonal.layouts

const LOOKS_PER_PIXEL = 8u;       // resources.LOOKS_PER_PIXEL
const LOOK_GROUP = 64u;
const LOOK_ALONG = 0u;            // radiance along a ray
const LOOK_IRRADIANCE = 1u;       // light that falls on an opaque voxel: origin and normal

struct LookQueue {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

@group(0) @binding(8) var<uniform> draw: DrawParams;
@group(0) @binding(10) var<storage, read_write> look_queue: LookQueue;
@group(0) @binding(11) var<storage, read_write> look_rays: array<LookRay>;
// LOOKS_PER_PIXEL planes of one value a pixel: rgb weight; w of the first plane: how many of them a pixel uses
@group(0) @binding(12) var<storage, read_write> look_values: array<vec4f>;

var<private> look_pixel: u32;
var<private> look_used: u32;

// False when the pixel has no slot left.
fn look_later(kind: u32, origin_ws: vec3f, direction_ws: vec3f, weight: vec3f) -> bool {
    if (look_used >= LOOKS_PER_PIXEL) { return false; }
    let slot = look_used * draw.size.x * draw.size.y + look_pixel;
    look_used += 1u;
    let place = atomicAdd(&look_queue.count, 1u);
    atomicMax(&look_queue.groups_x, place / LOOK_GROUP + 1u);
    look_rays[place] = LookRay(origin_ws, slot, direction_ws, kind);
    look_values[slot] = vec4f(weight, 0.0);
    return true;
}
