// One step of a ray in a field of refractive index: position x (m), optical momentum p = n d.
// Leapfrog is drift(dsigma/2), kick(dsigma) with the field looked up there, drift(dsigma/2);
// its arc length is n dsigma. Twin of eikonal.py, whose *_step functions take the field as a
// callback, which WGSL does not have.

// dx/dsigma = p [sharma1982]
fn drift(x: vec3f, p: vec3f, dsigma: f32) -> vec3f {
    return x + dsigma * p;
}

// dp/dsigma = n grad n = grad(n^2)/2 [sharma1982]
fn kick(p: vec3f, n: f32, grad_n: vec3f, dsigma: f32) -> vec3f {
    return p + (dsigma * n) * grad_n;
}

// Euler in the arc length, dx/ds = p/n [tevs2007, eq. 4.8]
fn euler_position(x: vec3f, p: vec3f, n: f32, ds: f32) -> vec3f {
    return x + (ds / n) * p;
}

// Euler in the arc length, dp/ds = grad n [tevs2007, eq. 4.9]
fn euler_momentum(p: vec3f, grad_n: vec3f, ds: f32) -> vec3f {
    return p + ds * grad_n;
}
