// Light from everywhere under level water: the sky through Snell's window, and what the surface throws back.
//!import optics/fresnel
//!import surroundings/shaders/environment
//!import surroundings/shaders/submerged_open
//!import surroundings/shaders/submersion

const SUBMERGED_PI = 3.14159265358979;
const DIFFUSE_ROWS = 32u;  // layouts.DIFFUSE_ENTRIES

// Diffuse attenuation of light that comes down, 1/m: what is absorbed or scattered back. The share that goes back is
// (1 - g)/2, exact for even scattering.
fn submerged_attenuation(water: u32) -> vec3f {
    let scattering = submersion.scattering[water];
    return submersion.absorption[water].rgb + 0.5 * (1.0 - scattering.a) * scattering.rgb;
}

// Share of the sky's irradiance that is left at a depth
fn submerged_down(water: u32, depth_m: f32) -> vec3f {
    let rows = submerged_rows(water, depth_m);
    return vec3f(
        mix(submersion.down[rows.index.r].r, submersion.down[rows.index.r + 1u].r, rows.share.r),
        mix(submersion.down[rows.index.g].g, submersion.down[rows.index.g + 1u].g, rows.share.g),
        mix(submersion.down[rows.index.b].b, submersion.down[rows.index.b + 1u].b, rows.share.b),
    );
}

// Share of the light of a matt level surface at a depth that comes back to it from the water's
fn submerged_back(water: u32, depth_m: f32) -> vec3f {
    let rows = submerged_rows(water, depth_m);
    return vec3f(
        mix(submersion.back[rows.index.r].r, submersion.back[rows.index.r + 1u].r, rows.share.r),
        mix(submersion.back[rows.index.g].g, submersion.back[rows.index.g + 1u].g, rows.share.g),
        mix(submersion.back[rows.index.b].b, submersion.back[rows.index.b + 1u].b, rows.share.b),
    );
}

struct DiffuseRows {
    index: vec3u,
    share: vec3f,
}

fn submerged_rows(water: u32, depth_m: f32) -> DiffuseRows {
    let once = exp(-submerged_attenuation(water) * depth_m);
    let at = saturate(once) * f32(DIFFUSE_ROWS - 1u);
    let k = min(vec3u(at), vec3u(DIFFUSE_ROWS - 2u));
    return DiffuseRows(k + water * DIFFUSE_ROWS, at - vec3f(k));
}

// Irradiance on a matt surface of albedo A. Of what its own light comes back from the surface the series is summed:
//     E = (E_window(n) down + (1 - w) E_ground down) / (1 - A q back / back_0),
// w = (1 + n.y)/2 the share of the upper half of all directions, q = w - (1 - back_0) g(n.y) that of those in which the
// surface mirrors the water. Level and clear it is E_window / (1 - A back_0) [saunderson1942]; in a uniform environment
// a white surface receives pi n^2 L whichever way it faces. In an uneven one, E_window and E_ground know no more of the
// sky than an axis: what that misses in air, where environment_irradiance knows more, is taken to be missed in water.
// Meshes hide some of what comes through the window (submerged_open.wgsl).
fn submerged_irradiance(p_ws: vec3f, n_ws: vec3f, albedo: vec3f, at: Submerged) -> vec3f {
    let window = submersion.window[at.water];
    let down = submerged_down(at.water, at.depth_m);
    let back = submerged_back(at.water, at.depth_m);
    let upper = 0.5 + 0.5 * n_ws.y;
    let n = environment_space(n_ws);
    let seen = cap_irradiance(dot(n, submersion.sky_axis[at.water].xyz), window.a);
    let seen_in_air = 0.5 + 0.5 * dot(n, submersion.air_axis[at.water].xyz);
    let in_air = submersion.air_sky[at.water].rgb * seen_in_air + submersion.air_ground[at.water].rgb * (1.0 - upper);
    let known = max(frame.environment_intensity * in_air, vec3f(1e-9));
    let missed = clamp(environment_irradiance(n_ws) / known, vec3f(0.0), vec3f(2.0));
    let left = submerged_sky_left(p_ws, n_ws, at.water);
    let sky = submersion.sky[at.water].rgb * left * seen * down + submersion.ground[at.water].rgb * (1.0 - upper) * down;
    let mirrored = max(upper - (1.0 - window.rgb) * cap_irradiance(n_ws.y, window.a), vec3f(0.0));
    let again = 1.0 - albedo * mirrored * back / max(window.rgb, vec3f(1e-6));
    return missed * frame.environment_intensity * sky / max(again, vec3f(1e-3));
}

// Irradiance of an even round patch of sky on a surface tilted against its middle, over that on one that faces it:
// cosine until the patch sinks below the horizon [snyder1996; lagarde2014]
fn cap_irradiance(cosine: f32, sine2: f32) -> f32 {
    let sine_tilt = sqrt(max(1.0 - cosine * cosine, 1e-12));
    let cosine_cap = sqrt(max(1.0 - sine2, 0.0));
    if cosine >= sqrt(sine2) {
        return cosine;
    }
    if cosine <= -sqrt(sine2) {
        return 0.0;
    }
    let x = cosine_cap * inverseSqrt(sine2);
    let y = clamp(-x * cosine / sine_tilt, -1.0, 1.0);
    let part = sine_tilt * sqrt(max(1.0 - y * y, 0.0));
    let whole = (cosine * acos(y) - x * part) * sine2 + atan2(part, x);
    return max(whole / (SUBMERGED_PI * sine2), 0.0);
}

// Unit direction in which a ray goes on above level water; level where it is totally reflected
fn submerged_way_out(direction_ws: vec3f, at: Submerged) -> vec3f {
    let aside = submersion.index[at.water].g * direction_ws.xz;
    return normalize(vec3f(aside.x, sqrt(max(1.0 - dot(aside, aside), 0.0)), aside.y));
}

// Radiance that a glossy surface in the water mirrors: through the window the sky, n^2 as bright, around it and below
// what the water holds, which is as bright as what comes up from below. `above` is the sky's on the way out.
fn submerged_glossy(above: vec3f, direction_ws: vec3f, at: Submerged) -> vec3f {
    let n = submersion.index[at.water].rgb;
    let ground = frame.environment_intensity * submersion.ground[at.water].rgb / SUBMERGED_PI;
    let up = max(direction_ws.y, 1e-4);
    let passed = select(vec3f(0.0), 1.0 - submerged_exit_reflectance(up, n), direction_ws.y > 0.0);
    let sky = n * n * above;
    let path_m = min(at.depth_m / up, 1e6);
    let left = exp(-submerged_attenuation(at.water) * select(at.depth_m, path_m, direction_ws.y > 0.0));
    return left * (passed * sky + (1.0 - passed) * ground);
}

// Reflectance of the level surface by channel, from above and from below
fn submerged_reflectance(cosine: f32, n: vec3f) -> vec3f {
    return vec3f(
        fresnel_dielectric(cosine, 1.0, n.r), fresnel_dielectric(cosine, 1.0, n.g), fresnel_dielectric(cosine, 1.0, n.b)
    );
}

fn submerged_exit_reflectance(cosine: f32, n: vec3f) -> vec3f {
    return vec3f(
        fresnel_dielectric(cosine, n.r, 1.0), fresnel_dielectric(cosine, n.g, 1.0), fresnel_dielectric(cosine, n.b, 1.0)
    );
}

// Reflectance of a coat at normal incidence in water, from that in air: of its index against the water's
// [born1999, 1.5.3]
fn submerged_coat(f0: f32, index: f32) -> f32 {
    let root = sqrt(min(f0, 0.998));
    let coat = (1.0 + root) / (1.0 - root);
    return normal_reflectance(index, coat);
}
