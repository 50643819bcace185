// What the search records for each pixel: kind, negative where the normal of a border looks down; way to the surface; the
// normal along x and z.

const WATER_NONE = 0u;   // nothing of the water
const WATER_ABOVE = 1u;  // its surface, from above
const WATER_BELOW = 2u;  // its surface, from within
const WATER_SIDE = 3u;   // an open border, from outside
const WATER_RIM = 4u;    // the same from within, where the water has borders of its own
const WATER_FOG = 5u;    // from within, something in the water before the surface
const WATER_OUT = 6u;    // from within, through a cut
const HIT_KINDS = 8u;

struct WaterHit {
    kind: u32,
    t: f32,         // to the surface, metres
    normal: vec3f,  // unit, of an open border out of the water; up elsewhere
}

fn water_record(hit: WaterHit, pick: u32) -> vec4f {
    let facing = select(1.0, -1.0, hit.normal.y < 0.0);
    return vec4f(facing * f32(hit.kind + HIT_KINDS * pick), hit.t, hit.normal.xz);
}

// Which ray of a block it is, see block.wgsl
fn water_hit_pick(record: vec4f) -> u32 {
    return u32(abs(record.x) + 0.5) / HIT_KINDS;
}

fn water_hit(record: vec4f) -> WaterHit {
    let kind = u32(abs(record.x) + 0.5) % HIT_KINDS;
    let aside = record.zw;
    let upright = sqrt(max(1.0 - dot(aside, aside), 0.0)) * select(1.0, -1.0, record.x < 0.0);
    let normal = select(vec3f(0.0, 1.0, 0.0), vec3f(aside.x, upright, aside.y), water_is_border(kind));
    return WaterHit(kind, record.y, normal);
}

fn water_is_border(kind: u32) -> bool {
    return kind == WATER_SIDE || kind == WATER_RIM;
}

// Whether the camera sees something of the surface or a border
fn water_meets(kind: u32) -> bool {
    return kind != WATER_NONE && kind < WATER_FOG;
}

// Whether the ray comes from within the water
fn water_is_within(kind: u32) -> bool {
    return kind == WATER_BELOW || kind >= WATER_RIM;
}
