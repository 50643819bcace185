// Rays through what bounds a water besides its surface, see scene/water_outline.py. Points are those from the middle of the
// surface at rest.

const MOST_CORNERS = 16u;  // of scene.water_outline
const OUTLINE_FAR = 1e30;
const OUTLINE_LONG = 1e12;  // of which squares are finite
const OUTLINE_TINY = 1e-12;

// Where a ray is within, and the normals out of the water there; far < near where it passes
struct OutlineWay {
    near: f32,
    far: f32,
    near_n: vec3f,
    far_n: vec3f,
}

fn outline_everywhere() -> OutlineWay {
    let up = vec3f(0.0, 1.0, 0.0);
    return OutlineWay(-OUTLINE_FAR, OUTLINE_FAR, up, up);
}

// What is left of a way where n.p <= d
fn outline_cut(way: OutlineWay, n: vec3f, d: f32, o: vec3f, direction: vec3f) -> OutlineWay {
    let rise = dot(n, direction);
    let room = d - dot(n, o);
    let t = room / select(rise, select(-OUTLINE_TINY, OUTLINE_TINY, room >= 0.0), abs(rise) < OUTLINE_TINY);
    let outward = rise > 0.0 || (abs(rise) < OUTLINE_TINY && room >= 0.0);
    let unit = n * inverseSqrt(max(dot(n, n), OUTLINE_TINY));
    let near = !outward && t > way.near;
    let far = outward && t < way.far;
    return OutlineWay(
        select(way.near, t, near), select(way.far, t, far), select(way.near_n, unit, near), select(way.far_n, unit, far)
    );
}

// (x/a)^2 + (z/b)^2 <= 1 + b h + c h^2, from where the ray is nearest to the middle, so that little is lost to rounding
fn outline_ellipse(half: vec2f, bend: vec2f, o: vec3f, direction: vec3f) -> OutlineWay {
    let turned = -dot(o, direction) / dot(direction, direction);
    let p = o + turned * direction;
    let scale = 1.0 / (half * half);
    let a_full = dot(direction.xz * direction.xz, scale) - bend.y * direction.y * direction.y;
    let least = OUTLINE_TINY * max(scale.x, scale.y);
    let a = select(a_full, select(least, -least, a_full < 0.0), abs(a_full) < least);
    let b = dot(p.xz * direction.xz, scale) + direction.y * (0.5 * bend.x - bend.y * p.y);
    let c = dot(p.xz * p.xz, scale) - 1.0 + p.y * (bend.x - bend.y * p.y);
    let square = b * b - a * c;
    let root = sqrt(max(square, 0.0));
    let q = -(b + select(root, -root, b < 0.0));
    let one = q / a;
    let other = c / select(q, OUTLINE_TINY, abs(q) < OUTLINE_TINY);
    let low = turned + min(one, other);
    let high = turned + max(one, other);
    // A steep ray is within a cone before it and beyond it: the upper part counts.
    let down = direction.y < 0.0;
    let near = select(low, select(high, -OUTLINE_FAR, down), a < 0.0);
    let far = select(high, select(OUTLINE_FAR, low, down), a < 0.0);
    return OutlineWay(
        select(near, OUTLINE_FAR, square < 0.0),
        select(far, -OUTLINE_FAR, square < 0.0),
        outline_normal(scale, bend, o + max(near, -OUTLINE_LONG) * direction),
        outline_normal(scale, bend, o + min(far, OUTLINE_LONG) * direction),
    );
}

fn outline_normal(scale: vec2f, bend: vec2f, p: vec3f) -> vec3f {
    let slope = vec3f(p.x * scale.x, 0.5 * bend.x - bend.y * p.y, p.z * scale.y);
    return slope * inverseSqrt(max(dot(slope, slope), 1e-30));
}
