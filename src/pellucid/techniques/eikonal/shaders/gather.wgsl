// What matter does to the light along a piece of path: absorption and emission, both times the length of the piece.

//!import techniques/eikonal/shaders/walk
//!import techniques/eikonal/shaders/bindings

// Emission inside index n leaves it as (ambient/n)^2 of itself: L/n^2 is what stays constant along a ray [born1999, 4.8.3].
fn gather(walk: ptr<function, Walk>, absorption: vec3f, emission: vec3f, n: f32, length: f32) {
    let world_length = length * volume.scale;
    let kept = exp(-absorption * world_length);
    // Mean of exp(-sigma s) over the piece; its series where 1 - exp(-t) would cancel.
    let depth = absorption * world_length;
    let mean = select((1.0 - kept) / max(depth, vec3f(1e-3)), 1.0 - 0.5 * depth, depth < vec3f(1e-3));
    let to_ambient = volume.ambient_n / n;
    (*walk).emitted += (*walk).transmittance * emission * mean * (world_length * to_ambient * to_ambient);
    (*walk).transmittance *= kept;
    (*walk).optical_path += n * world_length;
}
