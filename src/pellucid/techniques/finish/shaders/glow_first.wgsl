// The picture at half its size, in half floats.
//!import optics/colour
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var radiance: texture_2d<f32>;

const GLOW_MAX = 60000.0;  // below the largest half float

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let last = vec2i(textureDimensions(radiance)) - 1;
    var sum = vec3f(0.0);
    for (var k = 0; k < 4; k++) {
        let at = min(2 * vec2i(position.xy) + vec2i(k & 1, k >> 1), last);
        sum += textureLoad(radiance, at, 0).rgb;
    }
    return vec4f(min(into_gamut(0.25 * sum), vec3f(GLOW_MAX)), 1.0);
}
