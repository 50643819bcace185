// Directions at an interface. `direction` travels, `normal` faces the side it comes from
// (direction . normal < 0), both unit. Twin of snell.py. `reflect` and `refract` replace the
// WGSL built-ins in every module that imports this one: those return a zero vector under total
// reflection, which no later stage could tell from a direction.
//!import optics/normal_momentum

struct RefractResult {
    direction: vec3f,  // unit; the incident direction, unchanged, where valid is false
    valid: bool,       // false under total internal reflection: there is no refracted ray
}

// d - 2 (d.n) n [timonen2006, eq. 14, sign corrected; born1999, 1.5.1]
fn reflect(direction: vec3f, normal: vec3f) -> vec3f {
    return direction - 2.0 * dot(direction, normal) * normal;
}

// Snell's law as a vector [timonen2006, eq. 17; born1999, 1.5.1]. With c = -d.n and
// q = n_t cos_t the law eta d + (eta c - cos_t) n, eta = n_i/n_t, becomes (n_i (d + c n) - q n) / n_t,
// in which nothing cancels when the indices are close, or equal at grazing incidence.
fn refract(direction: vec3f, normal: vec3f, n_i: f32, n_t: f32) -> RefractResult {
    let c = -dot(direction, normal);
    let q_squared = normal_momentum_squared(c, n_i, n_t);
    if q_squared < 0.0 {
        return RefractResult(direction, false);
    }
    let refracted = (n_i * (direction + c * normal) - sqrt(q_squared) * normal) / n_t;
    return RefractResult(refracted, true);
}

// Angle of incidence beyond which reflection is total, sin = n_t/n_i [born1999, 1.5.4], rad;
// pi/2, never reached from inside, where n_i <= n_t
fn critical_angle(n_i: f32, n_t: f32) -> f32 {
    return asin(min(n_t / n_i, 1.0));
}
