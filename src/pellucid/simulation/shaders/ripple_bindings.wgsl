// State of a pool of ripples: displacement u of the whole steps, velocity w half a step before it.

//!struct RippleParams from simulation.layouts

@group(0) @binding(0) var<uniform> ripples: RippleParams;
@group(0) @binding(1) var<storage, read> displacement: array<f32>;
@group(0) @binding(2) var<storage, read_write> velocity: array<f32>;
@group(0) @binding(3) var<storage, read> friction: array<f32>;

// Number of a row or column up to two outside of the border: repeated, or mirrored, so that nothing flows out.
fn ripple_line(at: i32, count: u32) -> u32 {
    let n = i32(count);
    let around = ripples.periodic != 0u;
    let low = select(at, select(-1 - at, at + n, around), at < 0);
    return u32(select(low, select(2 * n - 1 - at, at - n, around), at >= n));
}

// c^2 L' u with L' = L - (h^2 - c^2 dt^2)/12 L L, L the nine-point Laplacian [shubin1987]: fields/waves.py, stencil
fn ripple_acceleration(at: vec2i) -> f32 {
    let a = ripple_line(at.x - 2, ripples.size.x);
    let b = ripple_line(at.x - 1, ripples.size.x);
    let c = u32(at.x);
    let d = ripple_line(at.x + 1, ripples.size.x);
    let e = ripple_line(at.x + 2, ripples.size.x);
    let far = ripple_row(ripple_line(at.y - 2, ripples.size.y), a, b, c, d, e)
            + ripple_row(ripple_line(at.y + 2, ripples.size.y), a, b, c, d, e);
    let near = ripple_row(ripple_line(at.y - 1, ripples.size.y), a, b, c, d, e)
             + ripple_row(ripple_line(at.y + 1, ripples.size.y), a, b, c, d, e);
    let here = ripple_row(u32(at.y), a, b, c, d, e);
    return dot(here, ripples.near.xyw) + dot(near, vec3f(ripples.near.yz, ripples.far.x))
         + dot(far, vec3f(ripples.near.w, ripples.far.xy));
}

// Sums of a row's displacements at the columns 0, 1 and 2 away
fn ripple_row(row: u32, a: u32, b: u32, c: u32, d: u32, e: u32) -> vec3f {
    let first = row * ripples.size.x;
    return vec3f(
        displacement[first + c],
        displacement[first + b] + displacement[first + d],
        displacement[first + a] + displacement[first + e],
    );
}

// Velocity half a step after the state; damping by the mean of both velocities
fn ripple_next_velocity(at: vec2i, cell: u32) -> f32 {
    let drag = friction[cell] * ripples.step_s;
    return (velocity[cell] * (1.0 - drag) + ripples.step_s * ripple_acceleration(at)) / (1.0 + drag);
}
