// A parallel beam that weakens with the depth, scattered once into a straight way.

struct WaterBeam {
    scattered: vec3f,  // radiance that a metre of the way gains just below the surface
    fade: vec3f,       // of the beam, 1/m of depth
    loss: vec3f,       // of what is scattered, 1/m of the way
}

const BEAM_SERIES = 1e-3;  // exponents below this are summed as a series

// Integral of scattered exp(-fade depth(s)) exp(-loss s) over a way that begins at a depth and rises by `rise` a metre
fn beam_inscatter(beam: WaterBeam, depth_m: f32, rise: f32, length_m: f32) -> vec3f {
    let change = beam.loss - rise * beam.fade;
    let first = exp(-beam.fade * depth_m);
    let grown = change * length_m;
    // Both exponents are those of ways within the water, so neither grows.
    let last = exp(min(-beam.fade * depth_m - grown, vec3f(0.0)));
    let few = abs(grown) < vec3f(BEAM_SERIES);
    let closed = (first - last) / select(change, vec3f(1.0), few);
    return beam.scattered * select(closed, first * length_m * (1.0 - 0.5 * grown), few);
}
