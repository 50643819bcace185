// State of a pool of ripples: displacement u of the whole steps, velocity w half a step before it.

//!struct RippleParams from simulation.layouts

@group(0) @binding(0) var<uniform> ripples: RippleParams;
@group(0) @binding(1) var<storage, read> displacement: array<f32>;
@group(0) @binding(2) var<storage, read_write> velocity: array<f32>;
@group(0) @binding(3) var<storage, read> friction: array<f32>;

// Place of a cell up to two outside of the border: repeated, or mirrored so that nothing flows through the border.
fn ripple_cell(at: vec2i) -> u32 {
    let size = vec2i(ripples.size);
    let repeated = (at + size) % size;
    let mirrored = select(select(at, 2 * size - 1 - at, at >= size), -1 - at, at < vec2i(0));
    let cell = select(mirrored, repeated, ripples.periodic != 0u);
    return u32(cell.y * size.x + cell.x);
}

fn ripple_u(at: vec2i) -> f32 {
    return displacement[ripple_cell(at)];
}

// Four neighbours that lie alike
fn ripple_ring(at: vec2i, a: vec2i, b: vec2i) -> f32 {
    return ripple_u(at + a) + ripple_u(at - a) + ripple_u(at + b) + ripple_u(at - b);
}

// c^2 L' u with L' = L - (h^2 - c^2 dt^2)/12 L L, L the nine-point Laplacian [shubin1987]: fields/waves.py, stencil
fn ripple_acceleration(at: vec2i) -> f32 {
    let centre = ripple_u(at);
    var sum = ripples.near.x * centre;
    sum += ripples.near.y * ripple_ring(at, vec2i(1, 0), vec2i(0, 1));
    sum += ripples.near.z * ripple_ring(at, vec2i(1, 1), vec2i(1, -1));
    sum += ripples.near.w * ripple_ring(at, vec2i(2, 0), vec2i(0, 2));
    sum += ripples.far.x * (ripple_ring(at, vec2i(2, 1), vec2i(1, 2)) + ripple_ring(at, vec2i(2, -1), vec2i(1, -2)));
    sum += ripples.far.y * ripple_ring(at, vec2i(2, 2), vec2i(2, -2));
    return sum;
}

// Velocity half a step after the state; damping by the mean of both velocities
fn ripple_next_velocity(at: vec2i, cell: u32) -> f32 {
    let drag = friction[cell] * ripples.step_s;
    return (velocity[cell] * (1.0 - drag) + ripples.step_s * ripple_acceleration(at)) / (1.0 + drag);
}
