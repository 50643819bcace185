// The four corners of a patch of a wavefront, and what lies between them: how wide it is, and whether it stays alike.

//!import techniques/eikonal/shaders/light_travel
//!import techniques/eikonal/shaders/interfaces

const ALIKE = 1e-3;             // radians

// The patch that this invocation follows: where its corners began, where they are, and what met them there.
var<private> corner_x: array<vec3f, 4>;
var<private> corner_p: array<vec3f, 4>;
var<private> end_x: array<vec3f, 4>;
var<private> end_p: array<vec3f, 4>;
var<private> end_event: array<u32, 4>;
var<private> end_crossing: array<Crossing, 4>;

fn unpack(patch_in: LightPatch) {
    corner_x = array<vec3f, 4>(patch_in.x_0, patch_in.x_1, patch_in.x_2, patch_in.x_3);
    corner_p = array<vec3f, 4>(patch_in.p_0, patch_in.p_1, patch_in.p_2, patch_in.p_3);
}

fn middle(v: array<vec3f, 4>) -> vec3f {
    return 0.25 * (v[0] + v[1] + v[2] + v[3]);
}

// Edges of the cut of a tube through a layer of voxels, the longer of each opposite two, object metres. Corners that are ahead of
// others along the direction of travel are not apart; where the way is oblique to the layer the cut is wider than the tube.
fn cut_edges(x: array<vec3f, 4>, d: vec3f) -> vec2f {
    let steep = abs(d);
    let x_main = steep.x >= max(steep.y, steep.z);
    let along = select(select(vec3f(0.0, 0.0, 1.0), vec3f(0.0, 1.0, 0.0), steep.y >= steep.z), vec3f(1.0, 0.0, 0.0), x_main);
    let slope = d / dot(d, along);
    let a = x[1] - x[0];
    let b = x[3] - x[2];
    let c = x[2] - x[0];
    let e = x[3] - x[1];
    return vec2f(
        max(length(a - dot(a, along) * slope), length(b - dot(b, along) * slope)),
        max(length(c - dot(c, along) * slope), length(e - dot(e, along) * slope)));
}

// Edges of the cross-section: mean of the two opposite ones.
fn edges_of(x: array<vec3f, 4>) -> mat2x3f {
    return mat2x3f(0.5 * (x[1] - x[0] + x[3] - x[2]), 0.5 * (x[2] - x[0] + x[3] - x[1]));
}

// The tube of a patch between these corners and those. A ray stands for the breadth of what it came from.
fn tube_between(x: array<vec3f, 4>, y: array<vec3f, 4>, of_patch: LightPatch) -> Tube {
    if (of_patch.is_ray == 0u) { return Tube(middle(x), middle(y), edges_of(x), edges_of(y)); }
    let way = y[0] - x[0];
    let aside = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(way.x) > max(abs(way.y), abs(way.z)));
    let first = cross(way, aside) / max(length(cross(way, aside)), 1e-20);
    let second = cross(way / max(length(way), 1e-20), first);
    let broad = mat2x3f(of_patch.breadth * first, of_patch.breadth * second);
    return Tube(x[0], y[0], broad, broad);
}

// Area of the tube's cross-section, object metres squared.
fn cross_section(x: array<vec3f, 4>, d: vec3f) -> f32 {
    return 0.5 * abs(dot(cross(x[3] - x[0], x[2] - x[1]), d));
}

fn between_corners(v: array<vec3f, 4>, at: vec2f) -> vec3f {
    return mix(mix(v[0], v[1], at.x), mix(v[2], v[3], at.x), at.y);
}

// Which way round the corners stand, seen along the light; it changes at a caustic.
fn orientation(x: array<vec3f, 4>, d: vec3f) -> f32 {
    return sign(dot(cross(x[3] - x[0], x[2] - x[1]), d));
}

// Whether the width of a patch matters. A tube of parallel rays is the same however wide; only the fluence of voxels asks for more.
fn too_wide(width: f32, fans_out: bool) -> bool {
    return width > light.split_width && (DEPOSITS || fans_out);
}

fn differ(ways: array<vec3f, 4>) -> bool {
    return length(ways[3] - ways[0]) > ALIKE || length(ways[2] - ways[1]) > ALIKE;
}

fn ways_differ(p: array<vec3f, 4>) -> bool {
    return differ(array<vec3f, 4>(normalize(p[0]), normalize(p[1]), normalize(p[2]), normalize(p[3])));
}

fn normals_differ() -> bool {
    return differ(array<vec3f, 4>(end_crossing[0].normal, end_crossing[1].normal, end_crossing[2].normal, end_crossing[3].normal));
}
