// Interfaces of a sharp volume: which side belongs to what, and where on a step the surface lies.

//!import techniques/eikonal/shaders/surface
//!import techniques/eikonal/shaders/walk

override WATERS: bool = false;     // the scene holds water that the volume may reach into
override GRADED: bool = false;     // the first region (or the whole box) has an index that varies

const FIRST_STRIDE = 0.25;         // voxels: leaves the surface that the ray stands on
const SHORTEST_STRIDE = 0.3;       // voxels
const CAUTION = 0.9;               // of the sampled distance, whose interpolation is not exactly a distance

fn region_index(region: u32, x: vec3f) -> f32 {
    if (region >= AMBIENT) {
        if (WATERS) { return ambient_index(x); }
        return volume.ambient_n;
    }
    if (GRADED && region == 0u) { return index_at(x); }
    return volume.region_n[region];
}

// Air, or level water that the volume reaches into
fn ambient_index(x: vec3f) -> f32 {
    let p_ws = (volume.world_from_object * vec4f(x, 1.0)).xyz;
    let within = all(p_ws.xz >= volume.wet_low) && all(p_ws.xz <= volume.wet_high);
    return select(volume.dry_n, volume.wet_n, within && p_ws.y < volume.wet_level_m);
}

fn is_graded(region: u32) -> bool {
    return GRADED && region == 0u;
}

fn stride_from(distances: vec4f, x: vec3f) -> f32 {
    let nearest = min(min(abs(distances.x), abs(distances.y)), min(abs(distances.z), abs(distances.w)));
    let stride = max(CAUTION * nearest, SHORTEST_STRIDE) * volume.voxel;
    if (!BLOCKS) { return stride; }
    return min(stride, max(force_at(x).radius, 0.5 * volume.voxel));
}

// p: optical momentum of arrival; the normal may point to either side.
fn crossing_at(x: vec3f, p: vec3f, facing: vec3f, signs: u32) -> Crossing {
    let n_i = length(p);
    let far = owner_of(signs);
    let normal = select(facing, -facing, dot(facing, p) > 0.0);
    return Crossing(n_i, region_index(far, x), normal, p / n_i, far, signs);
}

struct Met {
    region: u32,
    part: f32,        // of the chord
    normal: vec3f,    // unit, out of the region
}

// The first surface on a chord between whose ends signs change: found by linear interpolation, then put on the exact distances by
// one step of Newton; where the ray grazes, the linear guess stands.
fn surface_between(from_x: vec3f, chord: vec3f, signs: u32, distances: vec4f) -> Met {
    let a = distances_at(from_x);
    let changed = signs ^ signs_of(distances);
    var region = 0u;
    var part = 2.0;
    for (var k = 0u; k < 4u; k++) {
        if ((changed & (1u << k)) == 0u) { continue; }
        // A start on the surface may round to the wrong side of it.
        let from_value = select(max(a[k], 1e-4), min(a[k], -1e-4), (signs & (1u << k)) != 0u);
        let guess = clamp(from_value / (from_value - distances[k]), 0.0, 1.0);
        if (guess < part) { region = k; part = guess; }
    }
    let boundary = boundary_at(from_x + part * chord, region);
    let steepest = per_metre(boundary);
    let slope = dot(steepest, chord);
    let correction = select(0.0, boundary.distance / slope, abs(slope) > 0.05 * length(chord) / volume.voxel);
    return Met(region, clamp(part - correction, 0.0, 1.0), normalize(select(steepest, -chord, dot(steepest, steepest) < 1e-6)));
}
