// Pictures that stand for the scene below the surface, layer 0, and above it, layer 1: where points lie in them.
//!import techniques/water/shaders/bindings

const PICTURE_UNKNOWN = 0u;    // the picture does not show where the ray goes
const PICTURE_SOMETHING = 1u;
const PICTURE_NOTHING = 2u;    // no mesh on the way
const PICTURE_HIDDEN = 3u;     // it ends behind what the picture shows there

struct PicturePlace {
    uv: vec2f,
    t: f32,      // way along the ray, metres
    found: u32,
}

fn picture_clip(layer: u32, p_ws: vec3f) -> vec4f {
    return water_views.clip_from_world[layer] * vec4f(p_ws, 1.0);
}

// Transformation T of [mihalik2008, 7.2]
fn picture_uv(clip: vec4f) -> vec2f {
    return vec2f(0.5, -0.5) * clip.xy / clip.w + 0.5;
}

fn picture_shows(clip: vec4f) -> bool {
    return clip.w > 0.0 && all(abs(clip.xy) <= vec2f(clip.w));
}

// Reversed depth of the texel around a point
fn picture_depth(layer: u32, uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(picture_depths));
    return textureLoad(picture_depths, vec2i(clamp(uv * size, vec2f(0.0), size - 1.0)), layer, 0).r;
}

// The same between the centres of four texels: exact on planes, since reversed depth is linear in the picture
fn picture_depth_between(layer: u32, uv: vec2f) -> f32 {
    let last = vec2f(textureDimensions(picture_depths)) - 1.0;
    let at = clamp(uv * (last + 1.0) - 0.5, vec2f(0.0), last);
    let low = floor(at);
    let share = at - low;
    let four = textureGather(0, picture_depths, picture_sampler, (low + 1.0) / (last + 1.0), layer);
    return mix(mix(four.w, four.z, share.x), mix(four.x, four.y, share.x), share.y);
}

// Metres along the axis of the camera
fn picture_metres(layer: u32, depth: f32) -> f32 {
    let near_m = water_views.position[layer].w;
    let far_m = water_views.forward[layer].w;
    return select(near_m / max(depth, 1e-6), far_m - depth * (far_m - near_m), far_m > 0.0);
}

// Where the camera's ray through a point, `metres` deep, is `found` metres deep: points A of [mihalik2008, 7.1]
fn picture_point(layer: u32, p_ws: vec3f, metres: f32, found: f32) -> vec3f {
    let to_p = (p_ws - water_views.position[layer].xyz) / max(metres, 1e-6);
    let parallel = water_views.forward[layer].w > 0.0;
    return p_ws + (found - metres) * select(to_p, water_views.forward[layer].xyz, parallel);
}
