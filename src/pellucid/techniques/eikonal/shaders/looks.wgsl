// Rays that have left the refractive matter wait in a list: what they see is found out by a kernel of its own, which is much
// cheaper than to carry the shading of a whole scene through the loops of the march [laine2013].

//!import techniques/eikonal/shaders/bindings
//!struct DrawParams from techniques.eikonal.layouts
//!struct LookRay from techniques.eikonal.layouts

const LOOKS_PER_PIXEL = 8u;       // resources.LOOKS_PER_PIXEL
const LOOK_GROUP = 64u;
const LOOK_ALONG = 0u;            // radiance along a ray
const LOOK_IRRADIANCE = 1u;       // light that falls on an opaque voxel: origin and normal
const LOOK_GLINT = 2u;            // lamps in the lobe about a mirrored ray
const LOOK_GLOSS = 3u;            // all that a GGX lobe about a mirrored ray sees
const LOOK_TABLE = 4u;            // all that a tabulated BRDF reflects; its layer in place of the roughness

struct LookQueue {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

@group(0) @binding(8) var<uniform> draw: DrawParams;
@group(0) @binding(10) var<storage, read_write> look_queue: array<LookQueue, 2>;
// Filled from the beginning with single rays, which queue 0 counts, and from the end with lobes (queue 1)
@group(0) @binding(11) var<storage, read_write> look_rays: array<LookRay>;
// LOOKS_PER_PIXEL planes of one value a pixel: rgb weight; w of the first plane: how many of them a pixel uses
@group(0) @binding(12) var<storage, read_write> look_values: array<vec4f>;

var<private> look_pixel: u32;
var<private> look_used: u32;

fn slot_for(weight: vec3f) -> u32 {
    let slot = look_used * draw.size.x * draw.size.y + look_pixel;
    look_used += 1u;
    look_values[slot] = vec4f(weight, 0.0);
    return slot;
}

fn place_in(queue: u32) -> u32 {
    let place = atomicAdd(&look_queue[queue].count, 1u);
    atomicMax(&look_queue[queue].groups_x, place / LOOK_GROUP + 1u);
    return place;
}

// False when the pixel has no slot left.
fn look_later(kind: u32, origin_ws: vec3f, direction_ws: vec3f, weight: vec3f) -> bool {
    if (look_used >= LOOKS_PER_PIXEL) { return false; }
    look_rays[place_in(0u)] = LookRay(origin_ws, slot_for(weight), direction_ws, kind, vec3f(0.0), 0.0);
    return true;
}

// The same for the lobe about a ray that a boundary with this normal has mirrored.
fn look_into_lobe_later(kind: u32, origin_ws: vec3f, direction_ws: vec3f, normal_ws: vec3f, roughness: f32, weight: vec3f) -> bool {
    if (look_used >= LOOKS_PER_PIXEL) { return false; }
    let last = arrayLength(&look_rays) - 1u;
    look_rays[last - place_in(1u)] = LookRay(origin_ws, slot_for(weight), direction_ws, kind, normal_ws, roughness);
    return true;
}
