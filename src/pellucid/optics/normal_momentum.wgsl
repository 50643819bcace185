// How steeply a refracted ray leaves an interface: what Snell, Fresnel and the factor of refraction have in common.
// Twin of normal_momentum.py.

// (n_t cos_t)^2 = n_t^2 - n_i^2 + (n_i cos_i)^2 [born1999, 1.5.1]; negative under total internal reflection. Nothing cancels
// when the indices are close, and there is no n_i/n_t, whose division a GPU may round away from 1.
fn normal_momentum_squared(cos_i: f32, n_i: f32, n_t: f32) -> f32 {
    return (n_t - n_i) * (n_t + n_i) + n_i * cos_i * (n_i * cos_i);
}
