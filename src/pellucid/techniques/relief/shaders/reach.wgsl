// How far a ray can run between the bottom and the top of a relief, and within its borders.
//!import techniques/relief/shaders/frame

const RELIEF_FAR_TILES = 100.0;

// Metres until a ray that starts between them is below the lowest or above the highest of all heights, or outside
// of the rectangle of the mesh; a ray that starts on the top goes down.
fn relief_reach(ray: ReliefRay) -> f32 {
    var reach = RELIEF_FAR_TILES / max(length(ray.duv), 1e-9);
    reach = min(reach, relief_rising(ray, relief.hull_high));
    reach = min(reach, relief_falling(ray, relief.hull_low));
    return max(min(reach, relief_clip(ray)), 0.0);
}

// Where h(t) grows through a height: the root of bend t^2 + dh t + (h - height) with a positive slope
fn relief_rising(ray: ReliefRay, height: f32) -> f32 {
    let c = ray.h - height;
    let under = ray.dh * ray.dh - 4.0 * ray.bend * c;
    if under < 0.0 {
        return 1e30;
    }
    let root = sqrt(under);
    let flat = -2.0 * c / max(ray.dh + root, 1e-20);
    let curved = (root - ray.dh) / select(1e-20, 2.0 * ray.bend, abs(ray.bend) > 1e-20);
    let t = select(curved, flat, ray.dh >= 0.0);
    return select(1e30, max(t, 0.0), ray.dh >= 0.0 || ray.bend > 1e-20);
}

// Where h(t) sinks through a height
fn relief_falling(ray: ReliefRay, height: f32) -> f32 {
    return relief_rising(ReliefRay(ray.uv, -ray.h, ray.duv, -ray.dh, -ray.bend), -height);
}

// Where texture coordinates leave the rectangle of the mesh
fn relief_clip(ray: ReliefRay) -> f32 {
    let t = relief_clips(ray);
    return min(t.x, t.y);
}

// The same for u and v apart
fn relief_clips(ray: ReliefRay) -> vec2f {
    let ahead = select(relief.clip_low, relief.clip_high, ray.duv > vec2f(0.0));
    let t = (ahead - ray.uv) / select(vec2f(1e-20), ray.duv, abs(ray.duv) > vec2f(1e-20));
    return select(vec2f(1e30), t, abs(ray.duv) > vec2f(1e-20));
}

fn relief_inside(uv: vec2f) -> bool {
    return all(uv >= relief.clip_low - 1e-5) && all(uv <= relief.clip_high + 1e-5);
}
