// One face of a cube map of the scene: meshes and the sky along rays from one point.
//!import surroundings/shaders/full_picture
//!import surroundings/shaders/radiance

struct CubeFace {
    center_ws: vec3f,
    face: f32,         // +x, -x, +y, -y, +z, -z
    side: f32,         // texels
}

@group(0) @binding(0) var<uniform> cube_face: CubeFace;

const CUBE_MOST = 65504.0;  // the largest half float

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = 2.0 * position.xy / cube_face.side - 1.0;
    let direction_ws = normalize(cube_direction(u32(cube_face.face), at));
    return vec4f(min(radiance_along(cube_face.center_ws, direction_ws), vec3f(CUBE_MOST)), 1.0);
}

// Direction of a place of a face, from -1 to 1 to the right and down [W3C WebGPU, cube textures]
fn cube_direction(face: u32, at: vec2f) -> vec3f {
    switch face {
        case 0u: { return vec3f(1.0, -at.y, -at.x); }
        case 1u: { return vec3f(-1.0, -at.y, at.x); }
        case 2u: { return vec3f(at.x, 1.0, at.y); }
        case 3u: { return vec3f(at.x, -1.0, -at.y); }
        case 4u: { return vec3f(at.x, -at.y, 1.0); }
        default: { return vec3f(-at.x, -at.y, -1.0); }
    }
}
