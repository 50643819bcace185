// What a volume shows, into colour and depth of the frame.

//!import surroundings/shaders/full_picture
//!struct DrawParams from techniques.eikonal.layouts

@group(0) @binding(0) var<uniform> draw: DrawParams;
@group(0) @binding(1) var<storage, read> picture: array<vec4f>;

struct Composited {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> Composited {
    let pixel = vec2u(position.xy) - draw.corner;
    let seen = picture[pixel.y * draw.size.x + pixel.x];
    if (seen.w < 0.0) { discard; }
    return Composited(vec4f(seen.rgb, 1.0), seen.w);
}
