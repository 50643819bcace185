// How the pixels of a rectangle are dealt out to invocations, and where the lists of the pixels of each body begin.

const UNSEEN = -1.0;      // for a depth: the picture stays as it is

// A pixel for each invocation of an 8 x 8 workgroup; eight neighbours in a row of lanes form a block of 4 x 2.
fn pixel_of(group: vec2u, lane: u32) -> vec2u {
    let x = (lane & 3u) | (((lane >> 3u) & 1u) << 2u);
    let y = ((lane >> 2u) & 1u) | ((lane >> 4u) << 1u);
    return group * 8u + vec2u(x, y);
}

// Of one buffer: first the arguments of an indirect dispatch for each body, the last of the four being the number of
// pixels; then a bit for each body and pixel that is set when the pixel is in the list; then the lists.
fn mark_words(bodies: u32) -> u32 {
    return (bodies + 31u) / 32u;
}

fn list_start(body: u32, bodies: u32, pixels: u32) -> u32 {
    return 4u * bodies + (mark_words(bodies) + body) * pixels;
}
