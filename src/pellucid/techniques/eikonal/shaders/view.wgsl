// From a pixel to the volume and back: what both view shaders share.

//!import surroundings/shaders/camera
//!import surroundings/shaders/irradiance
//!import surroundings/shaders/radiance
//!import techniques/eikonal/shaders/screen
//!import techniques/eikonal/shaders/box
//!import techniques/eikonal/shaders/splitting
//!import techniques/eikonal/shaders/bindings
//!import techniques/eikonal/shaders/fields

//!struct DrawParams from techniques.eikonal.layouts

override SCREEN_SPACE: bool = false;   // see nearby geometry in the picture drawn so far instead of by rays

struct Seen {
    radiance: vec3f,
    distance: f32,      // along the viewing ray to the first surface, world metres
    touched: bool,      // false: the ray passed as if the volume were not there
}

struct ViewRay {
    x: vec3f,           // where it enters the proxy box, object space
    d: vec3f,           // unit, object space
    distance: f32,      // to there, world metres
    meets: bool,
}

const EVERY_CHANNEL = 3u;
const UNSEEN = -1.0;

@group(0) @binding(8) var<uniform> draw: DrawParams;
// rgb: radiance; w: value for the depth buffer, or UNSEEN where the picture stays as it is
@group(0) @binding(9) var<storage, read_write> drawn: array<vec4f>;

// A pixel for each invocation of an 8 x 8 workgroup; eight neighbours in a row of lanes form a block of 4 x 2.
fn pixel_of(group: vec2u, lane: u32) -> vec2u {
    let x = (lane & 3u) | (((lane >> 3u) & 1u) << 2u);
    let y = ((lane >> 2u) & 1u) | ((lane >> 4u) << 1u);
    return group * 8u + vec2u(x, y);
}

fn to_object(ray: CameraRay) -> ViewRay {
    let x = (volume.object_from_world * vec4f(ray.origin, 1.0)).xyz;
    let d = normalize((volume.object_from_world * vec4f(ray.direction, 0.0)).xyz);
    let span = intersect_box(x, d, volume.proxy_half);
    let near = max(span.x, 0.0);
    return ViewRay(x + near * d, d, near * volume.scale, span.x < span.y && span.y > 0.0);
}

fn to_world(x: vec3f) -> vec3f {
    return (volume.world_from_object * vec4f(x, 1.0)).xyz;
}

fn direction_to_world(d: vec3f) -> vec3f {
    return normalize((volume.world_from_object * vec4f(d, 0.0)).xyz);
}

// What a ray that leaves the volume at x sees.
fn outside_radiance(x: vec3f, d: vec3f) -> vec3f {
    if (SCREEN_SPACE) { return screen_radiance(to_world(x), direction_to_world(d)); }
    return radiance_along(to_world(x), direction_to_world(d));
}

// Where the budget ends: the environment, so that no energy is lost from a uniform one.
fn far_radiance(d: vec3f) -> vec3f {
    return environment_radiance(direction_to_world(d));
}

// The nearest opaque mesh on the piece from `a` to `b`, where meshes reach into the box.
fn mesh_between(a: vec3f, b: vec3f) -> SurfaceHit {
    let reach = distance(a, b);
    if ((volume.fields & MEETS_MESHES) == 0u || reach <= 0.0) { return SurfaceHit(); }
    return trace_opaque(to_world(a), direction_to_world(b - a), reach * volume.scale);
}

// An opaque voxel is matt; its normal is where its coverage falls.
fn opaque_radiance(x: vec3f, d: vec3f) -> vec3f {
    let h = volume.voxel;
    let slope = vec3f(
        opaque_at(x + vec3f(h, 0.0, 0.0)).a - opaque_at(x - vec3f(h, 0.0, 0.0)).a,
        opaque_at(x + vec3f(0.0, h, 0.0)).a - opaque_at(x - vec3f(0.0, h, 0.0)).a,
        opaque_at(x + vec3f(0.0, 0.0, h)).a - opaque_at(x - vec3f(0.0, 0.0, h)).a);
    let normal = normalize(select(-slope, -d, dot(slope, slope) < 1e-6));
    return opaque_at(x).rgb * surface_irradiance(to_world(x), direction_to_world(normal)) / 3.14159265;
}

// Keep what a pixel sees: one channel of it, or all; nothing where something nearer is drawn already.
fn keep(pixel: vec2u, ray: CameraRay, seen: Seen) {
    let at = draw.corner + pixel;
    let index = pixel.y * draw.size.x + pixel.x;
    let before = textureLoad(screen_depth, at, 0);
    let own = depth_of(ray.origin + seen.distance * ray.direction);
    let visible = seen.touched && own >= before;
    let radiance = select(textureLoad(screen_color, at, 0).rgb, seen.radiance, visible);
    let depth = select(UNSEEN, select(before, own, volume.writes_depth != 0u), visible);
    switch draw.channel {
        case 0u: { drawn[index] = vec4f(radiance.x, 0.0, 0.0, depth); }
        case 1u: { drawn[index].y = radiance.y; drawn[index].w = max(drawn[index].w, depth); }
        case 2u: { drawn[index].z = radiance.z; drawn[index].w = max(drawn[index].w, depth); }
        default: { drawn[index] = vec4f(radiance, depth); }
    }
}
