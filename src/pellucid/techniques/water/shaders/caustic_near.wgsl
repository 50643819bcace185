// The light of a lamp nearby enters the water at each cell of its surface and is followed to the first mesh by rays: no
// camera sees what a bent perspective would. Its place on the map is where the least way through level water, from where
// it has landed to the middle of the lamp, crosses the level.
//!import optics/fresnel
//!import optics/snell
//!import surroundings/shaders/raycast
//!import surroundings/shaders/submerged_lamp
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/caustic_wave

const NEAR_BRIGHTEST = 1000.0;  // over level water
const NEAR_EDGE_ON = 0.05;      // cosine of a rectangle below which what it sends is not told apart from its neighbours'
const NEAR_GAUSS = 0.2886751;   // of an edge: the two places whose mean is exact for cubic changes along it

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < caustic_side() {
        caustic_beams[caustic_cell(id.xy, id.z)] = near_beam(id.xy, id.z);
    }
}

fn near_beam(cell: vec2u, channel: u32) -> CausticBeam {
    let xz = caustic_place(vec2f(cell) + 0.5);
    let wave = caustic.focus * caustic_wave(xz);
    let n_ws = normalize(vec3f(-wave.y, 1.0, -wave.z));
    let origin = vec3f(xz.x, water.level + wave.x, xz.y);
    let way = caustic.place - origin;
    let above_m = length(way);
    let to_lamp = way / above_m;
    let facing = dot(n_ws, to_lamp);
    let lost = caustic.loss * fresnel_dielectric(facing, 1.0, caustic.index[channel]);
    var flux = caustic.share * max(facing, 0.0) / n_ws.y * (1.0 - lost) * near_shine(to_lamp) / (above_m * above_m);
    if occluded(origin, to_lamp, above_m) {
        flux *= 1.0 - caustic.shadows;
    }
    let inside = refract(-to_lamp, n_ws, 1.0, caustic.index[channel]).direction;
    let begun_m = water.wave_high - wave.x;
    let hit = nearest_surface(origin, inside, (caustic.reach_m - begun_m) / max(-inside.y, 0.05), false);
    let landed = near_level(origin + hit.t * inside);
    let f = hit.t / (caustic.index.g * above_m + hit.t);
    return CausticBeam(
        caustic_texel(landed.xy), clamp(flux / max(landed.z, 1e-12), 0.0, NEAR_BRIGHTEST), hit.t,
        f * near_breadth(to_lamp), begun_m
    );
}

// Light that the whole lamp sends in a direction, over its power
fn near_shine(to_lamp: vec3f) -> f32 {
    return mix(1.0, max(-dot(to_lamp, caustic.facing), 0.0), caustic.is_area);
}

// Where the level water is crossed on the way from a point to the middle of the lamp; and the flux through a square metre
// there that would give the point what all of the lamp does through level water that mirrors nothing
fn near_level(p_ws: vec3f) -> vec3f {
    var crossing = vec2f(0.0);
    var metres = 0.0;
    var received = 0.0;
    for (var k = 0u; k < min(caustic.places, arrayLength(&caustic_beams)); k++) {
        let corner = select(vec2f(0.0), vec2f(f32(k & 1u), f32((k >> 1u) & 1u)) * 2.0 - 1.0, k > 0u);
        let lamp_ws = caustic.middle + NEAR_GAUSS * (corner.x * caustic.edge_u + corner.y * caustic.edge_v);
        let way = submerged_way(p_ws, lamp_ws, water.level, caustic.index.g);
        let sent = max(near_shine(way.above), NEAR_EDGE_ON) * way.below.y / way.spread_m2;
        if k == 0u {
            crossing = way.crossing.xz;
            metres = way.above.y / (way.above_m * way.above_m) * way.spread_m2 / way.below.y;
            received = select(0.0, sent, caustic.places == 1u);
        } else {
            received += 0.25 * sent;
        }
    }
    return vec3f(crossing, metres * received);
}

// Sides of a part of the lamp as the surface sees it, in cells: the box of as much variance by axis
fn near_breadth(to_lamp: vec3f) -> vec2f {
    let slope = to_lamp.xz / max(to_lamp.y, 0.05);
    let u = (caustic.edge_u.xz - caustic.edge_u.y * slope) / caustic.divided.x;
    let v = (caustic.edge_v.xz - caustic.edge_v.y * slope) / caustic.divided.y;
    return sqrt(u * u + v * v) / ((water.high - water.low) / f32(caustic_side()));
}
