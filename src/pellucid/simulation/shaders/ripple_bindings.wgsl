// State of a pool of ripples: displacement u of the whole steps, velocity w half a step before it.

//!struct RippleParams from simulation.layouts

@group(0) @binding(0) var<uniform> ripples: RippleParams;
@group(0) @binding(1) var<storage, read> displacement: array<f32>;
@group(0) @binding(2) var<storage, read_write> velocity: array<f32>;
@group(0) @binding(3) var<storage, read> friction: array<f32>;
// Displacement with what floats on the water on top; the displacement itself where nothing does.
@group(0) @binding(6) var<storage, read> pressed: array<f32>;

const RIPPLE_STRIP = 8u;  // cells of a column that one invocation follows: sums of a row serve five of them (ripples.STRIP)

// Number of a row or column up to two outside of the border: repeated, or mirrored, so that nothing flows out.
fn ripple_line(at: i32, count: u32) -> u32 {
    let n = i32(count);
    let around = ripples.periodic != 0u;
    let low = select(at, select(-1 - at, at + n, around), at < 0);
    return u32(select(low, select(2 * n - 1 - at, at - n, around), at >= n));
}

// Columns around one, up to two away
struct RippleColumns {
    left_2: u32,
    left: u32,
    middle: u32,
    right: u32,
    right_2: u32,
}

fn ripple_columns(column: u32) -> RippleColumns {
    let at = i32(column);
    let n = ripples.size.x;
    return RippleColumns(
        ripple_line(at - 2, n), ripple_line(at - 1, n), column, ripple_line(at + 1, n), ripple_line(at + 2, n)
    );
}

// Sums of what is in a row at the columns 0, 1 and 2 away; a row may be up to two outside
fn ripple_sums(row: i32, columns: RippleColumns) -> vec3f {
    let first = ripple_line(row, ripples.size.y) * ripples.size.x;
    return vec3f(
        pressed[first + columns.middle],
        pressed[first + columns.left] + pressed[first + columns.right],
        pressed[first + columns.left_2] + pressed[first + columns.right_2],
    );
}

// Sums of five rows, the one in the middle and those around it
struct RippleRows {
    above_2: vec3f,
    above: vec3f,
    here: vec3f,
    below: vec3f,
    below_2: vec3f,
}

// Rows around the one before `row`: the last of the five is still to come
fn ripple_rows_before(row: i32, columns: RippleColumns) -> RippleRows {
    return RippleRows(
        vec3f(0.0), ripple_sums(row - 2, columns), ripple_sums(row - 1, columns), ripple_sums(row, columns),
        ripple_sums(row + 1, columns)
    );
}

// The same around the next row
fn ripple_rows_next(rows: RippleRows, row: i32, columns: RippleColumns) -> RippleRows {
    return RippleRows(rows.above, rows.here, rows.below, rows.below_2, ripple_sums(row + 2, columns));
}

// c^2 L' u with L' = L - (h^2 - c^2 dt^2)/12 L L, L the nine-point Laplacian [shubin1987]: fields/waves/ripples.py, stencil
fn ripple_acceleration(rows: RippleRows) -> f32 {
    let far = rows.above_2 + rows.below_2;
    let near = rows.above + rows.below;
    return dot(rows.here, ripples.near.xyw) + dot(near, vec3f(ripples.near.yz, ripples.far.x))
         + dot(far, vec3f(ripples.near.w, ripples.far.xy));
}

// Velocity half a step after the state; damping by the mean of both velocities
fn ripple_next_velocity(rows: RippleRows, cell: u32) -> f32 {
    let drag = friction[cell] * ripples.step_s;
    return (velocity[cell] * (1.0 - drag) + ripples.step_s * ripple_acceleration(rows)) / (1.0 + drag);
}
