// What matter does to the light along a piece of path: extinction, emission and scattering, all times the length of the piece.

//!import techniques/eikonal/shaders/scatter

// A piece of an object length, short enough to take everything from its middle x; d: its direction.
fn gather_at(walk: ptr<function, Walk>, x: vec3f, d: vec3f, n: f32, length: f32) {
    let matter = matter_at(x, (*walk).region);
    gather(walk, matter.extinction, matter.emission + in_scattered(x, d, n, matter.scattering), n, length);
}

// A piece in which nothing changes. source: radiance per world metre. What arises inside
// index n leaves it as (ambient/n)^2 of itself: L/n^2 is what stays constant along a ray [born1999, 4.8.3].
fn gather(walk: ptr<function, Walk>, extinction: vec3f, source: vec3f, n: f32, length: f32) {
    let world_length = length * volume.scale;
    let kept = exp(-extinction * world_length);
    // Mean of exp(-sigma s) over the piece; its series where 1 - exp(-t) would cancel.
    let depth = extinction * world_length;
    let mean = select((1.0 - kept) / max(depth, vec3f(1e-3)), 1.0 - 0.5 * depth, depth < vec3f(1e-3));
    let to_ambient = volume.ambient_n / n;
    (*walk).emitted += (*walk).transmittance * source * mean * (world_length * to_ambient * to_ambient);
    (*walk).transmittance *= kept;
    (*walk).optical_path += n * world_length;
}
