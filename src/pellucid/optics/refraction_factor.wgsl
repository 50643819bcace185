// Refraction by a factor instead of an angle [oliveira2000b, eq. 8]; Snell's law is the same with a factor that depends
// on the angle of incidence. Twin of refraction_factor.py.
//!import optics/normal_momentum
//!import optics/snell

// d - k n of unit length [oliveira2000b, eq. 8]; not valid where it does not pass the surface
fn refract_by_factor(direction: vec3f, normal: vec3f, factor: f32) -> RefractResult {
    let bent = direction - factor * normal;
    let valid = dot(bent, normal) < 0.0;
    return RefractResult(select(direction, normalize(select(direction, bent, valid)), valid), valid);
}

// (n_t cos_t - n_i cos_i) / n_i: Snell's law [born1999, 1.5.1] as a factor; -cos_i under total reflection
fn exact_factor(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    let c = saturate(cos_i);
    let q_squared = normal_momentum_squared(c, n_i, n_t);
    return sqrt(max(q_squared, 0.0)) / n_i - c;
}

// The fixed factor with the least largest error for angles from 0 to one, rad: exact where the sine is sqrt(3)/2 of the
// largest, by Chebyshev's polynomial of degree 3
fn fitted_factor(n_i: f32, n_t: f32, largest_angle: f32) -> f32 {
    let sine = sin(largest_angle);
    return exact_factor(sqrt(max(1.0 - 0.75 * sine * sine, 0.0)), n_i, n_t);
}

// The factor that undoes another from the other side at small angles
fn opposite_factor(factor: f32) -> f32 {
    return 1.0 / (1.0 + factor) - 1.0;
}
