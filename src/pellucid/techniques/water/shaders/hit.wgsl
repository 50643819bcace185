// What the search records for each pixel: kind, way to the surface, normal of an open border.

const WATER_NONE = 0u;   // nothing of the water
const WATER_ABOVE = 1u;  // its surface, from above
const WATER_BELOW = 2u;  // its surface, from within
const WATER_SIDE = 3u;   // an open border, from outside
const WATER_FOG = 4u;    // from within, something in the water before the surface
const HIT_KINDS = 8u;
const WATER_OUT = 5u;    // from within, through an open border

struct WaterHit {
    kind: u32,
    t: f32,         // to the surface, metres
    normal: vec3f,  // unit, of an open border out of the water; up elsewhere
}

fn water_record(hit: WaterHit, pick: u32) -> vec4f {
    return vec4f(f32(hit.kind + HIT_KINDS * pick), hit.t, hit.normal.xz);
}

// Which ray of a block it is, see block.wgsl
fn water_hit_pick(record: vec4f) -> u32 {
    return u32(record.x + 0.5) / HIT_KINDS;
}

fn water_hit(record: vec4f) -> WaterHit {
    let kind = u32(record.x + 0.5) % HIT_KINDS;
    let normal = select(vec3f(0.0, 1.0, 0.0), vec3f(record.z, 0.0, record.w), kind == WATER_SIDE);
    return WaterHit(kind, record.y, normal);
}
