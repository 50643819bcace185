// The state of a ray on its way through a volume, and the ways in which a march can end.

const MISSED = 0u;      // never met the box
const LEFT = 1u;        // left the box
const OPAQUE = 2u;      // met an opaque voxel
const EXHAUSTED = 3u;   // ran out of steps
const INTERFACE = 4u;   // stands at an interface; see Crossing
const PAUSED = 5u;      // went far enough for the caller to look around

const AMBIENT = 4u;     // region of what lies outside all regions

struct Walk {
    x: vec3f,             // object metres
    p0: vec3f,            // optical momentum at the last new start ...
    q: vec3f,             // ... and what the field has added since: kept apart, so that 1e-4 radians survive in 32 bits
    optical_path: f32,    // world metres
    transmittance: vec3f, // what extinction has left since the walk began
    emitted: vec3f,       // radiance picked up from emission and scattering, seen from where the walk began
    steps: u32,
    radius: f32,          // object metres around x in which nothing changes
    slope2: f32,          // |grad n|^2 met last, 1/m^2
    region: u32,          // owner of x in a sharp volume; AMBIENT outside all of them
    signs: u32,           // bit k: x is inside region k
}

// An interface that a walk stands at.
struct Crossing {
    n_i: f32,
    n_t: f32,
    normal: vec3f,        // unit, towards where the light comes from
    d: vec3f,             // unit direction of arrival
    region: u32,          // owner of the far side
    signs: u32,
}

fn begin_walk(x: vec3f, d: vec3f, n: f32) -> Walk {
    return Walk(x, n * d, vec3f(0.0), 0.0, vec3f(1.0), vec3f(0.0), 0u, 0.0, 0.0, 0u, 0u);
}

// Carry on from here with a new direction in index n.
fn redirect(walk: ptr<function, Walk>, d: vec3f, n: f32) {
    (*walk).p0 = n * d;
    (*walk).q = vec3f(0.0);
    (*walk).slope2 = 0.0;
    (*walk).radius = 0.0;
}
