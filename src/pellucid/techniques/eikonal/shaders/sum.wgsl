// Adds to each pixel what its waiting rays have seen, and to the picture what that is worth at the wavelength of this draw.

//!struct DrawParams from techniques.eikonal.layouts

@group(0) @binding(0) var<uniform> draw: DrawParams;
@group(0) @binding(1) var<storage, read> drawn: array<vec4f>;
@group(0) @binding(2) var<storage, read> look_values: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> picture: array<vec4f>;
@group(0) @binding(4) var screen_color: texture_2d<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let pixels = draw.size.x * draw.size.y;
    let index = id.x;
    if (index >= pixels) { return; }
    var value = drawn[index];
    for (var left = u32(look_values[index].w); left != 0u; left &= left - 1u) {
        value += vec4f(look_values[countTrailingZeros(left) * pixels + index].rgb, 0.0);
    }
    // Another wavelength may show the volume where this one does not.
    let at = draw.corner + vec2u(index % draw.size.x, index / draw.size.x);
    if (value.w < 0.0) { value = vec4f(textureLoad(screen_color, at, 0).rgb, value.w); }
    let share = draw.weights * value.rgb;
    let before = picture[index];
    let goes_on = draw.first == 0u;
    picture[index] = vec4f(share + select(vec3f(0.0), before.rgb, goes_on), select(value.w, max(before.w, value.w), goes_on));
}
