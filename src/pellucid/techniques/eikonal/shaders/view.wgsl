// From a pixel to the volume and back: what both view shaders share.

//!import surroundings/shaders/camera
//!import surroundings/shaders/environment
//!import surroundings/shaders/raycast
//!import techniques/eikonal/shaders/looks
//!import techniques/eikonal/shaders/pixels
//!import techniques/eikonal/shaders/hull
//!import techniques/eikonal/shaders/splitting
//!import techniques/eikonal/shaders/bindings
//!import techniques/eikonal/shaders/fields
//!import techniques/eikonal/shaders/scatter

struct Seen {
    radiance: vec3f,
    distance: f32,      // along the viewing ray to the first surface, world metres; negative: none, as in smoke
    touched: bool,      // false: the ray passed as if the volume were not there
}

struct ViewRay {
    x: vec3f,           // where it enters the proxy, object space
    d: vec3f,           // unit, object space
    distance: f32,      // to there, world metres
    meets: bool,
    hidden: bool,       // something nearer is drawn there already
    exists: bool,
    weight: vec3f,
    kind: u32,          // RAY_ bits
    others: u32,        // planes that other rays of the pixel have
    origin_ws: vec3f,
    direction_ws: vec3f,
}

override GLINTS: bool = false;     // lamps glint in smooth boundaries
override ROUGH: u32 = 0u;          // boundaries are rough: BY_GGX, BY_TABLE, or 0 for mirrors

const BY_GGX = 1u;
const BY_TABLE = 2u;

// rgb: radiance; w: value for the depth buffer, or UNSEEN where the picture stays as it is
@group(0) @binding(9) var<storage, read_write> drawn: array<vec4f>;
@group(0) @binding(13) var screen_depth: texture_depth_2d;
// Pixels whose rays enter each body (meeting.wgsl)
@group(0) @binding(19) var<storage, read> body_lists: array<u32>;

var<private> rays_left: u32;       // bits of the planes that may hold rays which have still to be followed

fn to_world(x: vec3f) -> vec3f {
    return (volume.world_from_object * vec4f(x, 1.0)).xyz;
}

fn direction_to_world(d: vec3f) -> vec3f {
    return normalize((volume.world_from_object * vec4f(d, 0.0)).xyz);
}

// A ray that ends: outside, where it will be looked along, or on an opaque voxel, whose light will be looked up.
struct Ending {
    kind: u32,          // LOOK_ALONG or LOOK_IRRADIANCE
    x: vec3f,
    d: vec3f,           // direction, or normal of the voxel
    weight: vec3f,      // 0: none
}

// What it sees, now or later; if there is no room for later, as if nothing but the environment were there.
fn end_ray(ending: Ending) -> vec3f {
    let d = direction_to_world(ending.d);
    if (all(ending.weight <= vec3f(0.0)) || look_later(ending.kind, to_world(ending.x), d, ending.weight)) { return vec3f(0.0); }
    if (ending.kind == LOOK_IRRADIANCE) { return ending.weight * environment_irradiance(d); }
    return ending.weight * environment_radiance(d);
}

// A boundary that light met from outside, where it mirrors more than a single ray: a rough one, or lamps in a smooth one.
fn is_rough(coat: vec4f) -> bool {
    return ROUGH == BY_TABLE || (ROUGH == BY_GGX && coat.a > volume.gloss);
}

// What the lobe about a mirrored ray sees, later. If there is no room for later, lamps are left out.
fn end_lobe(x: vec3f, normal: vec3f, mirrored: vec3f, coat: vec4f, weight: vec3f) -> vec3f {
    let rough = is_rough(coat);
    if ((!GLINTS && !rough) || all(weight <= vec3f(0.0))) { return vec3f(0.0); }
    var kind = LOOK_GLINT;
    var roughness = volume.gloss;
    if (rough) {
        kind = select(LOOK_GLOSS, LOOK_TABLE, ROUGH == BY_TABLE);
        roughness = select(coat.a, f32(volume.brdf_layer), ROUGH == BY_TABLE);
    }
    let d = direction_to_world(mirrored);
    let waits = look_into_lobe_later(kind, to_world(x), d, direction_to_world(normal), roughness, weight);
    if (waits || !rough) { return vec3f(0.0); }
    return weight * environment_glossy(d, coat.a * coat.a);
}

// Where the budget ends: the environment, so that no energy is lost from a uniform one.
fn far_radiance(d: vec3f) -> vec3f {
    return environment_radiance(direction_to_world(d));
}

// Glass and mesh that touch are taken to have this much air between them, voxels: a piece inside the glass ends before the mesh,
// and a ray that leaves the glass begins before it, whatever rounding says of the two.
const CONTACT = 0.05;

fn contact() -> f32 {
    return CONTACT * volume.voxel;
}

// The nearest opaque mesh on the piece from `a` to `b`, but for its very ends, where meshes reach into the box.
fn mesh_between(a: vec3f, b: vec3f) -> SurfaceHit {
    let reach = distance(a, b) - 2.0 * contact();
    if (!MEETS_MESHES || reach <= 0.0) { return SurfaceHit(); }
    let d = normalize(b - a);
    return trace_opaque(to_world(a + contact() * d), direction_to_world(d), reach * volume.scale);
}

// An opaque voxel is matt; its normal is where its coverage falls.
fn opaque_ending(x: vec3f, d: vec3f, weight: vec3f) -> Ending {
    if (!BLOCKS) { return Ending(); }
    let h = volume.voxel;
    let slope = vec3f(
        opaque_at(x + vec3f(h, 0.0, 0.0)).a - opaque_at(x - vec3f(h, 0.0, 0.0)).a,
        opaque_at(x + vec3f(0.0, h, 0.0)).a - opaque_at(x - vec3f(0.0, h, 0.0)).a,
        opaque_at(x + vec3f(0.0, 0.0, h)).a - opaque_at(x - vec3f(0.0, 0.0, h)).a);
    let normal = normalize(select(-slope, -d, dot(slope, slope) < 1e-6));
    return Ending(LOOK_IRRADIANCE, x, normal, weight * opaque_at(x).rgb / 3.14159265);
}

// The ray of an invocation's pixel, or the first of those that enter this body there.
fn first_ray(group: vec2u, lane: u32) -> ViewRay {
    if (RELAYED) {
        let index = group.x * 64u + lane;
        if (index >= body_lists[4u * volume.body + 3u]) { return ViewRay(); }
        look_pixel = body_lists[list_start(volume.body, volume.body_count, draw.size.x * draw.size.y) + index];
        look_used = u32(look_values[look_pixel].w);
        rays_left = look_used;
        return next_ray();
    }
    let pixel = pixel_of(group, lane);
    if (any(pixel >= draw.size)) { return ViewRay(); }
    look_pixel = pixel.y * draw.size.x + pixel.x;
    let ray = camera_ray(vec2f(draw.corner + pixel) + 0.5);
    return enter(ray.origin, ray.direction, vec3f(1.0), RAY_UNTOUCHED);
}

// Where rays are relayed: the next of the pixel's rays that enter this body.
fn next_ray() -> ViewRay {
    while (rays_left != 0u) {
        let plane = countTrailingZeros(rays_left);
        rays_left &= rays_left - 1u;
        let slot = slot_of(plane);
        let ray = look_rays[slot];
        if ((ray.kind & RAY_ENTERS) != 0u && ray.body == volume.body) {
            look_used &= ~(1u << plane);
            return enter(ray.origin, ray.direction, look_values[slot].rgb, ray.kind & (RAY_UNTOUCHED | RAY_SURFACELESS));
        }
    }
    return ViewRay();
}

// Where a ray enters, unless something nearer is drawn there already.
fn enter(origin: vec3f, direction: vec3f, weight: vec3f, kind: u32) -> ViewRay {
    let x = (volume.object_from_world * vec4f(origin, 1.0)).xyz;
    let d = normalize((volume.object_from_world * vec4f(direction, 0.0)).xyz);
    let span = hull_span(x, d);
    let near = max(span.x, 0.0);
    let meets = span.x < span.y && span.y > 0.0;
    var entry = ViewRay(x + near * d, d, near * volume.scale, meets, false, true, weight, kind, look_used, origin, direction);
    entry.hidden = depth_of(origin + (entry.distance + volume.scale * volume.voxel) * direction) < depth_before();
    entry.hidden = entry.hidden && (kind & RAY_UNTOUCHED) != 0u;
    entry.meets = entry.meets && !entry.hidden;
    look_body = volume.body;
    ambient_radiance = environment_mean_radiance();
    return entry;
}

fn depth_before() -> f32 {
    let pixel = vec2u(look_pixel % draw.size.x, look_pixel / draw.size.x);
    return textureLoad(screen_depth, draw.corner + pixel, 0);
}

// Keep what is known of a pixel so far; the rays that it waits for are added by `sum`.
fn keep(entry: ViewRay, seen: Seen) {
    let before = depth_before();
    let own = depth_of(entry.origin_ws + seen.distance * entry.direction_ws);
    let has_surface = seen.distance >= 0.0;
    let visible = seen.touched && (own >= before || !has_surface);
    let depth = select(UNSEEN, select(before, own, has_surface), visible);
    if (!RELAYED) {
        drawn[look_pixel] = vec4f(seen.radiance, depth);
    } else if (seen.touched) {
        let known = drawn[look_pixel];
        let first = (entry.kind & RAY_UNTOUCHED) != 0u;
        let deepens = (entry.kind & RAY_SURFACELESS) != 0u && known.w >= 0.0 && visible;
        drawn[look_pixel] = vec4f(known.rgb + seen.radiance, select(known.w, depth, first || deepens));
        if (entry.kind != 0u && !has_surface) { mark_surfaceless(look_used & ~entry.others); }
    } else if (!entry.hidden) {
        // On to the next body, from where it entered this one: meshes in here have still to be looked for.
        if (look_later(LOOK_ALONG, to_world(entry.x), entry.direction_ws, entry.weight)) {
            look_rays[slot_of(countTrailingZeros(look_used & ~entry.others))].kind |= entry.kind;
        }
    }
}

// The rays that come from one that met no surface, by their planes.
fn mark_surfaceless(planes: u32) {
    for (var left = planes; left != 0u; left &= left - 1u) { look_rays[slot_of(countTrailingZeros(left))].kind |= RAY_SURFACELESS; }
}

fn finish_pixel() {
    if (look_used == 0u) { look_values[look_pixel] = vec4f(0.0); }
    look_values[look_pixel].w = f32(look_used);
}

fn largest(v: vec3f) -> f32 {
    return max(v.x, max(v.y, v.z));
}
