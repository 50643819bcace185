// Texels of a relief that lies on one plane: where each of them is, and in which frame.
//!import techniques/relief/shaders/frame
//!struct ReliefPlane from techniques.relief.layouts

@group(0) @binding(16) var<uniform> plane: ReliefPlane;

// Centre of a texel (or a point between centres), in tiles
fn plane_uv(texel: vec2f) -> vec2f {
    let at = (texel + 0.5) / vec2f(relief.texels);
    return vec2f(at.x, 1.0 - at.y);
}

fn plane_point(uv: vec2f, h: f32) -> vec3f {
    return plane.origin + uv.x * plane.tangent + uv.y * plane.bitangent + h * plane.normal;
}

fn plane_frame(uv: vec2f, h: f32) -> ReliefFrame {
    let flat = vec3f(0.0);
    return relief_frame_at_height(
        plane_point(uv, h), uv, h, plane.tangent, plane.bitangent, plane.normal, flat, flat
    );
}
