// Rays that have left the refractive matter wait in a list: what they see is found out by a kernel of its own, which is much
// cheaper than to carry the shading of a whole scene through the loops of the march [laine2013].

//!import techniques/eikonal/shaders/ray_list
//!struct DrawParams from techniques.eikonal.layouts
//!struct LookRay from techniques.eikonal.layouts

const EVERY_PLANE = 0xffu;         // resources.LOOKS_PER_PIXEL bits
const LOOK_ALONG = 0u;            // radiance along a ray
const LOOK_IRRADIANCE = 1u;       // light that falls on an opaque voxel: origin and normal
const LOOK_GLINT = 2u;            // lamps in the lobe about a mirrored ray
const LOOK_GLOSS = 3u;            // all that a GGX lobe about a mirrored ray sees
const LOOK_TABLE = 4u;            // all that a tabulated BRDF reflects; its layer in place of the roughness

const LOOK_KIND = 7u;             // the bits that say which of these
// What else is known of a ray that goes from body to body
const RAY_UNTOUCHED = 8u;         // a camera ray as it began
const RAY_SURFACELESS = 16u;      // one that has met no surface yet: its pixel still has no depth
const RAY_ENTERS = 32u;           // goes into `body`; the others have left it

// Rays go from body to body: lists are of rays that may enter another, and lobes wait among them.
override RELAYED: bool = false;

@group(0) @binding(8) var<uniform> draw: DrawParams;
@group(0) @binding(10) var<storage, read_write> look_list: GrowingList;
// Planes of one ray a pixel; a place in them is a slot
@group(0) @binding(11) var<storage, read_write> look_rays: array<LookRay>;
// rgb: weight of the ray; w of the first plane: bits of the planes that a pixel uses
@group(0) @binding(12) var<storage, read_write> look_values: array<vec4f>;

var<private> look_pixel: u32;
var<private> look_used: u32;
var<private> look_body: u32;      // that they leave

fn slot_of(plane: u32) -> u32 {
    return plane * draw.size.x * draw.size.y + look_pixel;
}

fn wait(queue: u32, weight: vec3f, ray: LookRay) {
    let plane = countTrailingZeros(~look_used);
    look_used |= 1u << plane;
    let slot = slot_of(plane);
    look_rays[slot] = ray;
    look_values[slot] = vec4f(weight, 0.0);
    put_in(select(queue, 0u, RELAYED), slot);
}

fn put_in(queue: u32, slot: u32) {
    let place = atomicAdd(&look_list.heads[queue].count, 1u);
    atomicMax(&look_list.heads[queue].groups_x, place / LIST_GROUP + 1u);
    look_list.slots[select(place, arrayLength(&look_list.slots) - 1u - place, queue == 1u)] = slot;
}

// False when the pixel has no slot left.
fn look_later(kind: u32, origin_ws: vec3f, direction_ws: vec3f, weight: vec3f) -> bool {
    if (look_used == EVERY_PLANE) { return false; }
    wait(0u, weight, LookRay(origin_ws, kind, direction_ws, look_body, vec3f(0.0), 0.0));
    return true;
}

// The same for the lobe about a ray that a boundary with this normal has mirrored.
fn look_into_lobe_later(kind: u32, origin_ws: vec3f, direction_ws: vec3f, normal_ws: vec3f, roughness: f32, weight: vec3f) -> bool {
    if (look_used == EVERY_PLANE) { return false; }
    wait(1u, weight, LookRay(origin_ws, kind, direction_ws, look_body, normal_ws, roughness));
    return true;
}
