// Light of a surface whose slopes are normally distributed, such as the sea. Directions are unit vectors away from the
// surface, y up, towards the viewer and towards the light. Slopes (dh/dx, dh/dz) have a mean and the covariance
// `variance`: xx, zz, xz. Twin of rough_water.py.

const ROUGH_TINY = 1e-24;
const STEEPEST = 0.2;  // least cosine of the normal of a facet of water with y: about 80 degrees

// Normal density of slopes `offset` from their mean, per unit of slope squared [cox1954, eq. 7]
fn slope_density(offset: vec2f, variance: vec3f) -> f32 {
    let determinant = max(variance.x * variance.y - variance.z * variance.z, ROUGH_TINY);
    let crossed = 2.0 * variance.z * offset.x * offset.y;
    let square = (variance.y * offset.x * offset.x - crossed + variance.x * offset.y * offset.y) / determinant;
    return exp(-0.5 * square) / (6.2831853 * sqrt(determinant));
}

// Share of a normal distribution below `a` standard deviations, to 1.5e-7 [abramowitz1964, 7.1.26]
fn gaussian_below(a: f32) -> f32 {
    let x = abs(a) * 0.70710678;
    let t = 1.0 / (1.0 + 0.3275911 * x);
    let series = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t;
    let tail = 0.5 * series * exp(-x * x);
    return select(1.0 - tail, tail, a < 0.0);
}

// Standard deviation of d.y - slope . d.xz, the area of facets that is seen: sqrt(d_xz variance d_xz)
fn slope_spread(direction: vec3f, variance: vec3f) -> f32 {
    let d = direction.xz;
    return sqrt(max(variance.x * d.x * d.x + variance.y * d.y * d.y + 2.0 * variance.z * d.x * d.y, 0.0));
}

// Area of facets that face a direction, seen from there, for each area of ground: E[max(d.y - s . d.xz, 0)]. With
// a = mean / spread it is spread (phi(a) + a Phi(a)), [smith1967] in closed form.
fn visible_area(direction: vec3f, slope: vec2f, variance: vec3f) -> f32 {
    let mean = direction.y - dot(slope, direction.xz);
    let spread = max(slope_spread(direction, variance), 1e-6);
    let a = clamp(mean / spread, -10.0, 10.0);
    let bell = exp(-0.5 * a * a) * 0.39894228;
    return select(spread * (bell + a * gaussian_below(a)), mean, mean > 10.0 * spread);
}

// Mean slope of what is seen from a direction: slope - variance d_xz Phi(a) / visible_area. From Stein's lemma,
// E[(s - mean) w(s)] = variance E[grad w], of the areas w that are seen.
fn visible_slope(direction: vec3f, slope: vec2f, variance: vec3f) -> vec2f {
    let mean = direction.y - dot(slope, direction.xz);
    let a = clamp(mean / max(slope_spread(direction, variance), 1e-6), -10.0, 10.0);
    let share = gaussian_below(a) / max(visible_area(direction, slope, variance), 1e-6);
    let moved = mat2x2f(variance.xz, variance.zy) * direction.xz;
    return slope - share * moved;
}

// Along the normal of facets that send light to the viewer, not unit; y > 0 where there are any. On one side of the
// surface v + l: they mirror. Else -(n_view v + n_light l), towards the smaller index: they refract
// [walter2007, eq. 16].
fn facet_normal(view: vec3f, light: vec3f, n_view: f32, n_light: f32) -> vec3f {
    return select(-(n_view * view + n_light * light), view + light, view.y * light.y > 0.0);
}

// Covariance of the facets that show the points of a disc about a light, whose half angle has the tangent `radius`: a
// normal distribution of its mean square, radius^2 / 4 along any axis. `n_light` is 1 for mirrored light. A change of
// the light by q moves the facet's slopes by -(q_xz + zeta q_y) n / m_y.
fn disc_variance(light: vec3f, facet: vec3f, radius: f32, n_light: f32) -> vec3f {
    let up = select(facet.y, STEEPEST, abs(facet.y) < STEEPEST * length(facet));
    let zeta = -facet.xz / up;
    let one = vec3f(1.0, zeta.x, 0.0);
    let two = vec3f(0.0, zeta.y, 1.0);
    let c = vec2f(dot(one, light), dot(two, light));
    let scale = 0.5 * radius * n_light / up;
    return scale * scale * (vec3f(dot(one, one), dot(two, two), dot(one, two)) - vec3f(c * c, c.x * c.y));
}

// Radiance over the light's irradiance, 1/sr, without Fresnel's share: how often facets send it to the viewer. A facet
// of slope zeta has the area 1 / cos of the ground below it. Mirrored light fills 4 (l.h) of the solid angle of
// normals, refracted light that of [walter2007, eq. 17]; over the area seen [ross2005; bruneton2010, sec. 5].
fn glint(view: vec3f, light: vec3f, slope: vec2f, variance: vec3f, n_view: f32, n_light: f32) -> f32 {
    let m = facet_normal(view, light, n_view, n_light);
    let size = max(length(m), 1e-12);
    let h = select(m, -m, m.y < 0.0) / size;
    let up = max(h.y, STEEPEST);
    let v_h = dot(view, h);
    let l_h = dot(light, h);
    let refracted = abs(l_h * v_h) * (n_view / size) * (n_view / size);
    let share = select(refracted, 0.25, view.y * light.y > 0.0);
    let density = slope_density(-h.xz / up - slope, variance);
    // Facets turn each side to its medium: those count that viewer and light see from the side that they are on.
    let faced = v_h * view.y > 0.0 && l_h * light.y > 0.0 && h.y > STEEPEST;
    let area = max(visible_area(select(view, -view, view.y < 0.0), slope, variance), 1e-6);
    return select(0.0, share * density / (up * up * up * up * area), faced);
}
