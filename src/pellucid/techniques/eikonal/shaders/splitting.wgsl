// What an interface does to a ray: how much is reflected, and where both parts go.

//!import optics/fresnel
//!import optics/snell
//!import techniques/eikonal/shaders/walk

struct Split {
    reflectance: f32,
    reflected: vec3f,
    refracted: vec3f,
    total: bool,         // nothing is refracted
}

// Fresnel and Snell at a crossing [tevs2007, 3.2.5, with eq. 3.6 put right].
fn split_at(crossing: Crossing) -> Split {
    let bent = refract(crossing.d, crossing.normal, crossing.n_i, crossing.n_t);
    let reflectance = fresnel_dielectric(-dot(crossing.d, crossing.normal), crossing.n_i, crossing.n_t);
    return Split(select(reflectance, 1.0, !bent.valid), reflect(crossing.d, crossing.normal), bent.direction, !bent.valid);
}

// Step through the interface.
fn pass_through(walk: ptr<function, Walk>, crossing: Crossing, refracted: vec3f) {
    redirect(walk, refracted, crossing.n_t);
    (*walk).region = crossing.region;
    (*walk).signs = crossing.signs;
}
