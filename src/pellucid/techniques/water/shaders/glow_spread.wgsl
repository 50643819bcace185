// The mean of 13 texels on the diagonals of a square of 7 x 7 [mihalik2008, 9.3].
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var highlight: texture_2d<f32>;

const GLOW_REACH = 3;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    let last = vec2i(textureDimensions(highlight)) - 1;
    var sum = textureLoad(highlight, at, 0);
    for (var k = 1; k <= GLOW_REACH; k++) {
        for (var corner = 0; corner < 4; corner++) {
            let offset = k * (2 * vec2i(corner & 1, corner >> 1) - 1);
            sum += textureLoad(highlight, clamp(at + offset, vec2i(0), last), 0);
        }
    }
    return sum / f32(4 * GLOW_REACH + 1);
}
