// The crystals of a sharp volume: what two kinds of rays meet in them, and what an interface makes of each [born1999, 15.3].

//!import optics/crystal
//!import techniques/eikonal/shaders/interfaces
//!import techniques/eikonal/shaders/matter
//!struct CrystalParams from techniques.eikonal.layouts

override VARIES: bool = false;     // axis or indices of the first region change from place to place

@group(0) @binding(18) var axis_field: texture_3d<f32>;   // of the first region, where it varies: axis, n_e - ambient_n
@group(0) @binding(28) var<uniform> crystals: CrystalParams;

const ORDINARY = 0u;               // also the one mode of an isotropic medium, in which light is unpolarised
const EXTRAORDINARY = 1u;

struct Crystal {
    n_o: f32,
    n_e: f32,
    axis: vec3f,                   // of an isotropic medium: a direction that tells s and p apart
    splits: bool,
}

fn crystal_at(region: u32, x: vec3f, normal: vec3f) -> Crystal {
    let n_o = region_index(region, x);
    let known = crystals.axis[min(region, AMBIENT - 1u)];
    if (region >= AMBIENT || known.w == 0.0) { return Crystal(n_o, n_o, normal, false); }
    if (VARIES && region == 0u) { return varying_crystal(n_o, x); }
    return Crystal(n_o, crystals.n_e[region], known.xyz, true);
}

fn varying_crystal(n_o: f32, x: vec3f) -> Crystal {
    let here = textureSampleLevel(axis_field, volume_sampler, texture_position(x), 0.0);
    return Crystal(n_o, volume.ambient_n + here.w, normalize(here.xyz), true);
}

// A wave on its way: its momentum, and the kind of ray that it is.
struct Wave {
    p: vec3f,
    mode: u32,
}

fn bends(region: u32, mode: u32) -> bool {
    return VARIES && region == 0u && mode == EXTRAORDINARY;
}

// Let a walk follow the ray of a wave, with the absorption that is its own; |p0| is the index of the ray.
fn set_out(walk: ptr<function, Walk>, wave: Wave) {
    let crystal = crystal_at((*walk).region, (*walk).x, vec3f(0.0, 0.0, 1.0));
    let ray = extraordinary_ray(wave.p, crystal.axis, crystal.n_o, crystal.n_e);
    let along = select(wave.p, ray / dot(ray, ray), wave.mode == EXTRAORDINARY);
    redirect(walk, along, 1.0);
    ray_absorption = absorption_of(wave, crystal, (*walk).region);
}

// Pleochroism: along an extraordinary ray absorption depends on its direction [tevs2007, A.3].
fn absorption_of(wave: Wave, crystal: Crystal, region: u32) -> vec3f {
    if (region >= AMBIENT) { return vec3f(0.0); }
    let of_o = volume.region_absorption[region].xyz;
    if (wave.mode == ORDINARY) { return of_o; }
    return extraordinary_extinction(wave.p, crystal.axis, crystal.n_o, crystal.n_e, of_o, crystals.absorption_e[region].xyz);
}

// What leaves an interface, in the order of ModeSplit. An isotropic side has one wave for both polarisations.
struct Leaving {
    waves: array<Wave, 4>,
    powers: vec4f,                 // they sum to 1
}

fn leave_interface(wave: Wave, x: vec3f, near_region: u32, crossing: Crossing) -> Leaving {
    let near = crystal_at(near_region, x, crossing.normal);
    let far = crystal_at(crossing.region, x, crossing.normal);
    let polarised = select(vec2f(1.0, 0.0), vec2f(0.0, 1.0), wave.mode == EXTRAORDINARY);
    let shares = select(vec2f(0.5), polarised, near.splits);
    let split = split_modes(
        wave.p, shares, crossing.normal, near.n_o, near.n_e, near.axis, far.n_o, far.n_e, far.axis);
    var powers = split.powers;
    powers = select(vec4f(powers.x + powers.y, 0.0, powers.zw), powers, near.splits);
    powers = select(vec4f(powers.xy, powers.z + powers.w, 0.0), powers, far.splits);
    // Rounding, which at grazing incidence may leave nothing: then the wave passes by, and goes on as if it were reflected.
    let sum = dot(powers, vec4f(1.0));
    let passes_by = sum < 0.5;
    let itself = select(vec4f(1.0, 0.0, 0.0, 0.0), vec4f(0.0, 1.0, 0.0, 0.0), wave.mode == EXTRAORDINARY);
    let mirrored = wave.p - 2.0 * dot(wave.p, crossing.normal) * crossing.normal;
    return Leaving(
        array<Wave, 4>(
            Wave(select(split.reflected_o, mirrored, passes_by), ORDINARY),
            Wave(select(split.reflected_e, mirrored, passes_by), EXTRAORDINARY),
            Wave(split.transmitted_o, ORDINARY), Wave(split.transmitted_e, EXTRAORDINARY)),
        select(powers / max(sum, 0.5), itself, passes_by));
}
