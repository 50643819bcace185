// How much light a smooth interface between two dielectrics reflects. cos_i is clamped to [0, 1],
// indices are > 0. Twin of fresnel.py.
//!import optics/normal_momentum

struct PolarisedReflectance {
    s: f32,  // rs^2, electric field perpendicular to the plane of incidence
    p: f32,  // rp^2, electric field in the plane of incidence
}

// Smallest denominator: turns 0/0 (equal indices at grazing incidence) into the limit, 0. Larger than cosines
// whose square underflows
const FRESNEL_TINY = 1e-15;

// Fresnel's formulae, rs^2 and rp^2 [born1999, 1.5.2 and 1.5.3]; both 1 under total reflection.
// With q = n_t cos_t equal indices reflect nothing at any angle.
fn fresnel_polarised(cos_i: f32, n_i: f32, n_t: f32) -> PolarisedReflectance {
    let c = saturate(cos_i);
    let q_squared = normal_momentum_squared(c, n_i, n_t);
    if q_squared < 0.0 {
        return PolarisedReflectance(1.0, 1.0);
    }
    let q = sqrt(q_squared);
    let r_s = (n_i * c - q) / max(n_i * c + q, FRESNEL_TINY);
    let r_p = (n_t * n_t * c - n_i * q) / max(n_t * n_t * c + n_i * q, FRESNEL_TINY);
    return PolarisedReflectance(r_s * r_s, r_p * r_p);
}

// Exact, unpolarised: (rs^2 + rp^2)/2 [timonen2006, eq. 9-12; born1999, 1.5.3]; 1 under total reflection
fn fresnel_dielectric(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    let reflectance = fresnel_polarised(cos_i, n_i, n_t);
    return 0.5 * (reflectance.s + reflectance.p);
}

// ((n_i - n_t)/(n_i + n_t))^2, at normal incidence [born1999, 1.5.3]
fn normal_reflectance(n_i: f32, n_t: f32) -> f32 {
    let r = (n_i - n_t) / (n_i + n_t);
    return r * r;
}

// f0 + (1 - f0)(1 - cos)^q [mihalik2008, eq. 7-8; schlick1994, eq. 15]; cosine on the side of the lower index
fn schlick(f0: f32, cosine: f32, exponent: f32) -> f32 {
    return f0 + (1.0 - f0) * pow(1.0 - saturate(cosine), exponent);
}

// Schlick's approximation, exponent 5 [schlick1994, eq. 15]; from the denser side with the cosine of the
// transmitted angle, hence 1 under total reflection. Error: see fresnel.py
fn fresnel_schlick(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    let c = saturate(cos_i);
    let q_squared = normal_momentum_squared(c, n_i, n_t);
    let cosine = select(c, sqrt(max(q_squared, 0.0)) / n_t, n_i > n_t);
    return schlick(normal_reflectance(n_i, n_t), cosine, 5.0);
}

// Angle at which rp vanishes, tan = n_t/n_i [born1999, 1.5.3], rad
fn brewster_angle(n_i: f32, n_t: f32) -> f32 {
    return atan2(n_t, n_i);
}
