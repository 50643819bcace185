// Pieces of a ray between the surfaces of crystals: straight, or bent where axis or indices vary.

//!import techniques/eikonal/shaders/crystals
//!import techniques/eikonal/shaders/march_sharp

// Evaluations of the field in one step; 2 are the explicit midpoint rule, 3 come near to the implicit one [hairer2006, II.1.1].
const MIDPOINTS = 3;

// As march_sharp, for the ray of a wave; the wave is carried along.
fn march_crystal(walk: ptr<function, Walk>, wave: ptr<function, Wave>, crossing: ptr<function, Crossing>) -> u32 {
    if (bends((*walk).region, (*wave).mode)) { return march_bent(walk, wave, crossing); }
    let event = march_sharp(walk, crossing);
    if (is_graded((*walk).region)) { (*wave).p = (*walk).p0 + (*walk).q; }
    return event;
}

// Steps of the extraordinary ray, no longer than the distance to the surface.
fn march_bent(walk: ptr<function, Walk>, wave: ptr<function, Wave>, crossing: ptr<function, Crossing>) -> u32 {
    let p_begin = (*wave).p;
    var stride = FIRST_STRIDE * volume.voxel;
    while ((*walk).steps < volume.max_steps) {
        let room = proxy_span((*walk).x, normalize((*walk).p0)).y;
        if (room <= 1e-4 * volume.voxel) { return LEFT; }
        let before = *walk;
        let p_before = (*wave).p;
        let reach = min(min(stride, volume.step), room);
        bent_step(walk, wave, reach);
        let distances = distances_at((*walk).x);
        let signs = signs_of(distances);
        stride = stride_from(distances, (*walk).x);
        if (signs != before.signs) {
            let hit = surface_between(before.x, (*walk).x - before.x, before.signs, distances);
            *walk = before;
            (*wave).p = p_before;
            bent_step(walk, wave, hit.part * reach);
            let flipped = before.signs ^ (1u << hit.region);
            if (owner_of(flipped) != before.region) {
                *crossing = crossing_at((*walk).x, (*walk).p0, hit.normal, flipped);
                return INTERFACE;
            }
            (*walk).signs = flipped;
            stride = FIRST_STRIDE * volume.voxel;
        }
        if (BLOCKS && opaque_at((*walk).x).a > 0.5) { return OPAQUE; }
        if (MEETS_MESHES && distance((*wave).p, p_begin) > volume.pause) { return PAUSED; }
    }
    return EXHAUSTED;
}

// A step of arc length `reach`: implicit midpoint for dx = Mp, dp = -grad(p.Mp)/2 [kravtsov1990], then p.Mp = 1 again.
fn bent_step(walk: ptr<function, Walk>, wave: ptr<function, Wave>, reach: f32) {
    let x = (*walk).x;
    let p = (*wave).p;
    let dsigma = reach * length((*walk).p0);
    var change = Motion(vec3f(0.0), vec3f(0.0));
    for (var k = 0; k < MIDPOINTS; k++) {
        change = motion_at(x + 0.5 * dsigma * change.velocity, p + 0.5 * dsigma * change.force);
    }
    let middle = x + 0.5 * dsigma * change.velocity;
    (*walk).x = x + dsigma * change.velocity;
    let pushed = p + dsigma * change.force;
    let crystal = varying_crystal(region_index(0u, (*walk).x), (*walk).x);
    (*wave).p = pushed * inverseSqrt(2.0 * crystal_hamiltonian(pushed, crystal.axis, crystal.n_o, crystal.n_e) + 1.0);
    let halfway = varying_crystal(region_index(0u, middle), middle);
    ray_absorption = absorption_of(Wave(0.5 * (p + (*wave).p), EXTRAORDINARY), halfway, 0u);
    let n = length((*walk).p0);
    gather_at(walk, middle, (*walk).p0 / n, n, reach);
    let ray = extraordinary_ray((*wave).p, crystal.axis, crystal.n_o, crystal.n_e);
    (*walk).p0 = ray / dot(ray, ray);
    (*walk).steps += 1u;
}

struct Motion {
    velocity: vec3f,
    force: vec3f,
}

// Slopes are taken over two voxels.
fn motion_at(x: vec3f, p: vec3f) -> Motion {
    let h = volume.voxel;
    let here = varying_crystal(region_index(0u, x), x);
    var slopes = array<vec3f, 3>();      // along each axis: of n_o, of n_e, of a.p
    for (var k = 0u; k < 3u; k++) {
        let step = h * vec3f(f32(k == 0u), f32(k == 1u), f32(k == 2u));
        let ahead = varying_crystal(region_index(0u, x + step), x + step);
        let behind = varying_crystal(region_index(0u, x - step), x - step);
        slopes[k] = vec3f(ahead.n_o - behind.n_o, ahead.n_e - behind.n_e, dot(ahead.axis - behind.axis, p)) / (2.0 * h);
    }
    let force = crystal_force(
        p, here.axis, here.n_o, here.n_e, vec3f(slopes[0].x, slopes[1].x, slopes[2].x),
        vec3f(slopes[0].y, slopes[1].y, slopes[2].y), vec3f(slopes[0].z, slopes[1].z, slopes[2].z));
    return Motion(extraordinary_ray(p, here.axis, here.n_o, here.n_e), force);
}
