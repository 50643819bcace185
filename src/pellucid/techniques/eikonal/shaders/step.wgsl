// One step of a ray through the continuous field: the equations of motion, and how long a step may be.

//!import optics/eikonal
//!import techniques/eikonal/shaders/walk
//!import techniques/eikonal/shaders/fields
//!import techniques/eikonal/shaders/gather

override EULER: bool = false;      // first-order steps in arc length [tevs2007, eq. 5.11-5.12], for comparison
override ADAPTIVE: bool = true;    // jump where nothing changes, shorten where the ray bends

// Largest change of direction in one step, radians for each voxel that a step may be long.
const BEND_PER_STEP = 0.4;
const NO_LIMIT = 1e30;

struct Step {
    length: f32,
    opaque_at_probe: bool,
}

// How far the integrator may go from here, in index n.
fn step_length(walk: ptr<function, Walk>, n: f32) -> f32 {
    if (!ADAPTIVE) { return volume.step; }
    return min(volume.step, BEND_PER_STEP * (volume.step / volume.voxel) * n * inverseSqrt(max((*walk).slope2, 1e-20)));
}

// Move by at most `limit` along the ray: a jump through homogeneous matter, or a step of the integrator.
fn take_step(walk: ptr<function, Walk>, limit: f32) -> Step {
    let p = (*walk).p0 + (*walk).q;
    let per_n = inverseSqrt(dot(p, p));
    let n = dot(p, p) * per_n;
    let stride = step_length(walk, n);
    let jumps = ADAPTIVE && (*walk).radius > stride;
    let reach = min(select(stride, (*walk).radius, jumps), limit);
    let ahead = select(select(0.5, 0.0, EULER), 1.0, jumps) * reach;
    let probe = drift((*walk).x, p, ahead * per_n);
    let here = force_at(probe);
    let after = select(reach - ahead, 0.0, jumps);
    let kept_n = select(n, index_for_euler(n, probe), EULER);
    if (EULER) {
        (*walk).x = euler_position((*walk).x, p, kept_n, reach);
        (*walk).q += here.force * reach;
        (*walk).slope2 = dot(here.force, here.force);
    } else {
        // Half drift, kick, half drift; in a jump the second half has no length and no force acts.
        let force = select(here.force, vec3f(0.0), jumps);
        (*walk).q += force * (reach * per_n);
        (*walk).x = drift(probe, (*walk).p0 + (*walk).q, after * per_n);
        (*walk).slope2 = dot(force, force) * per_n * per_n;
    }
    (*walk).radius = max(here.radius - after, 0.0);
    (*walk).steps += 1u;
    if (ABSORBS || EMITS || SCATTERS) {
        let p_after = (*walk).p0 + (*walk).q;
        gather_at(walk, probe, normalize(p + p_after), kept_n, reach);
    } else {
        (*walk).optical_path += kept_n * reach * volume.scale;
    }
    return Step(reach, BLOCKS && opaque_at(probe).a > 0.5);
}

fn index_for_euler(n: f32, x: vec3f) -> f32 {
    if (!EULER) { return n; }
    return index_at(x);
}
