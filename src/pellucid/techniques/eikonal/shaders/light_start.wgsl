// The front where it enters the box: one invocation a patch, on the faces that the lamp shines on [tevs2007, 4.2.2].

//!import techniques/eikonal/shaders/light_enter
//!import techniques/eikonal/shaders/light_others
//!import surroundings/shaders/raycast

override HAS_MESHES: bool = true;

const PARALLEL = 0u;
const FROM_POINT = 1u;
const BOX_FACES = 6u;
const OPEN_SAMPLES = 8u;      // along each edge of a patch

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= light.batch_count) { return; }
    let tile = light.batch_first + id.x;
    var face = 0u;
    for (var k = 1u; k < BOX_FACES; k++) { face = select(face, k, k < light.face_count && tile >= light.faces[k].w); }
    let shape = light.faces[face];
    let local = tile - shape.w;
    let corner = vec2f(f32(local % shape.y), f32(local / shape.y));
    let tiles = vec2f(f32(shape.y), f32(shape.z));
    for (var k = 0u; k < 4u; k++) {
        begin_corner(k, shape.x, (corner + vec2f(f32(k & 1u), f32(k >> 1u))) / tiles);
    }
    let flux = light.power * (share_of_light() * lit_share() * open_share());
    var begun = LightPatch();
    begun.begun = largest_of(abs(weighed(flux)));
    begun.touched = select(UNTOUCHED, TOUCHED, light.inside != 0u);
    enter(flux, begun);
}

// A corner on a face of the box; face = 2 axis + side. Around a lamp inside the box all rays begin at it.
fn begin_corner(k: u32, face: u32, at: vec2f) {
    let axis = face >> 1u;
    let half = light.box_half;
    let along = select(-1.0, 1.0, (face & 1u) != 0u);
    // Not on the very edges: a ray along one must stay inside.
    let across = 0.99999 * (2.0 * at - 1.0);
    let unit = untwisted(vec3f(across, along), axis);
    let inside = light.inside != 0u;
    let x = light.box_center + unit * half;
    corner_x[k] = select(x, light.position, inside);
    corner_p[k] = select(select(x - light.position, light.direction, light.kind == PARALLEL), unit, inside);
}

// From (across, across, along) back to the axes of the object.
fn untwisted(v: vec3f, axis: u32) -> vec3f {
    return select(select(v.xyz, v.yzx, axis == 1u), v.zxy, axis == 0u);
}

// Projected area in world metres squared, or solid angle, of the patch; for a lamp with a face, times the cosine there.
fn share_of_light() -> f32 {
    let section = cross_section(corner_x, light.direction) * volume.scale * volume.scale;
    let a = normalize(corner_p[0]);
    let b = normalize(corner_p[1]);
    let c = normalize(corner_p[2]);
    let e = normalize(corner_p[3]);
    let way = normalize(a + b + c + e);
    let facing = select(max(dot(way, light.direction), 0.0), 1.0, light.kind == FROM_POINT);
    let angle = (solid_angle(a, b, c) + solid_angle(b, e, c)) * facing;
    return select(angle, section, light.kind == PARALLEL);
}

// Of a triangle of unit vectors [vanoosterom1983, eq. 8].
fn solid_angle(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    return 2.0 * atan2(abs(dot(a, cross(b - a, c - a))), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
}

// How much of the patch the meshes leave in the light.
fn lit_share() -> f32 {
    if (!HAS_MESHES || light.casts == 0u || light.inside != 0u) { return 1.0; }
    var lit = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let x = mix(corner_x[k], middle(corner_x), 0.5);
        let to_lamp = select(light.position - x, -light.direction, light.kind == PARALLEL);
        let reach = select(length(to_lamp) * volume.scale, 1e30, light.kind == PARALLEL);
        lit += 0.25 * f32(!occluded(point_to_world(x), way_to_world(to_lamp), reach));
    }
    return lit;
}

// How much of the patch comes straight from the lamp. The rest comes through other bodies, and from them (light_arrive.wgsl).
fn open_share() -> f32 {
    if (!HANDS_ON || light.inside != 0u) { return 1.0; }
    var open = 0.0;
    for (var k = 0u; k < OPEN_SAMPLES * OPEN_SAMPLES; k++) {
        let at = (vec2f(f32(k % OPEN_SAMPLES), f32(k / OPEN_SAMPLES)) + 0.5) / f32(OPEN_SAMPLES);
        let x = between_corners(corner_x, at);
        let to_lamp = select(light.position - x, -light.direction, light.kind == PARALLEL);
        let reach = select(length(to_lamp) * volume.scale, 1e30, light.kind == PARALLEL);
        open += f32(body_ahead(point_to_world(x), way_to_world(to_lamp), reach).body == NOBODY);
    }
    return open / f32(OPEN_SAMPLES * OPEN_SAMPLES);
}
