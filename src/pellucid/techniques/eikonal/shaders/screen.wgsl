// Nearby geometry from the picture drawn so far: the cheap stand-in for rays [wyman2005]. It knows only what the camera sees.

//!import surroundings/shaders/bindings
//!import surroundings/shaders/environment

@group(0) @binding(3) var screen_color: texture_2d<f32>;
@group(0) @binding(4) var screen_depth: texture_depth_2d;

const SCREEN_STEPS = 64;
const SCREEN_REFINEMENTS = 6;

struct ScreenPoint { uv: vec2f, depth: f32, visible: bool }

// Along a ray from clip-space point `origin` towards clip-space direction `heading`; s = 1 is infinitely far.
fn screen_point(origin: vec4f, heading: vec4f, s: f32) -> ScreenPoint {
    let clip = (1.0 - s) * origin + s * heading;
    let ndc = clip.xyz / max(clip.w, 1e-9);
    let visible = clip.w > 1e-9 && all(abs(ndc.xy) < vec2f(1.0));
    return ScreenPoint(ndc.xy * vec2f(0.5, -0.5) + 0.5, ndc.z, visible);
}

fn depth_drawn(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(screen_depth));
    return textureLoad(screen_depth, vec2i(clamp(uv * size, vec2f(0.0), size - 1.0)), 0);
}

fn screen_radiance(origin_ws: vec3f, direction_ws: vec3f) -> vec3f {
    let origin = frame.clip_from_world * vec4f(origin_ws, 1.0);
    let reach = max(distance(origin_ws, frame.camera_position), 1e-6);
    let heading = frame.clip_from_world * vec4f(direction_ws * reach, 0.0);
    var before = 0.0;
    for (var i = 1; i < SCREEN_STEPS; i++) {
        let s = f32(i) / f32(SCREEN_STEPS);
        let point = screen_point(origin, heading, s);
        if (!point.visible) { break; }
        if (depth_drawn(point.uv) > point.depth) {
            var low = before;
            var high = s;
            for (var k = 0; k < SCREEN_REFINEMENTS; k++) {
                let middle = 0.5 * (low + high);
                let at = screen_point(origin, heading, middle);
                if (depth_drawn(at.uv) > at.depth) { high = middle; } else { low = middle; }
            }
            let size = vec2f(textureDimensions(screen_color));
            let texel = clamp(screen_point(origin, heading, high).uv * size, vec2f(0.0), size - 1.0);
            return textureLoad(screen_color, vec2i(texel), 0).rgb;
        }
        before = s;
    }
    return environment_radiance(direction_ws);
}
