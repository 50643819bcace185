// One level of the pyramid from the finer one: the mean of 4 x 4 texels, so that neighbours overlap.
//!import surroundings/shaders/full_picture

@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var glow_sampler: sampler;

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(finer));
    let middle = 2.0 * position.xy;
    var sum = vec4f(0.0);
    for (var k = 0; k < 4; k++) {
        let offset = 2.0 * vec2f(f32(k & 1), f32(k >> 1)) - 1.0;
        sum += textureSampleLevel(finer, glow_sampler, (middle + offset) / size, 0.0);
    }
    return 0.25 * sum;
}
