// What is seen of the picture and of the surroundings by way of a point of the sheet.
//!import optics/fresnel
//!import optics/refraction_factor
//!import surroundings/shaders/bindings
//!import techniques/sheet/shaders/bindings
//!import techniques/sheet/shaders/hit

override SHEET_EXACT: bool = true;  // Snell's law, or a factor

struct SheetLook {
    hit: SheetHit,     // on the picture
    inward: vec3f,     // unit direction of the sheet's own, towards the picture
    outward: vec3f,    // and towards the surroundings
    share: f32,        // of the picture in what is seen, the rest is of the surroundings
    way: f32,          // through matter
}

// Direction of the ray of the camera through a point
fn sheet_view(p_os: vec3f) -> vec3f {
    let parallel = (frame.flags & 1u) != 0u;
    let eye = sheet.object_from_world * vec4f(frame.camera_position, 1.0);
    let forward = sheet.object_from_world * vec4f(frame.camera_forward, 0.0);
    return normalize(select(p_os - eye.xyz, forward.xyz, parallel));
}

// From above, the refracted ray goes to the picture and the mirrored one to the surroundings; from below the mirrored
// one goes to the picture. One that rises, at a steep wave, never comes there: then the surroundings are seen alone
fn sheet_look(p: vec3f, normal: vec3f, direction: vec3f, below: bool, exact: bool) -> SheetLook {
    let n = sheet_facing(select(normal, -normal, below), direction);
    let n_i = select(sheet.n_outside, sheet.n_inside, below);
    let n_t = select(sheet.n_inside, sheet.n_outside, below);
    var bent = refract(direction, n, n_i, n_t);
    if !exact {
        bent = refract_by_factor(direction, n, select(sheet.factor, sheet.factor_below, below));
    }
    let mirrored = reflect(direction, n);
    let fresnel = fresnel_dielectric(-dot(direction, n), n_i, n_t);
    let mirror = select(1.0, mix(sheet.blend, fresnel, sheet.fresnel), bent.valid);
    let inward = select(bent.direction, mirrored, below);
    let outward = select(mirrored, bent.direction, below);
    let share = select(0.0, select(1.0 - mirror, mirror, below), inward.y < -SHEET_LEAST_FALL);
    let hit = sheet_hit(p, inward, sheet.depth);
    return SheetLook(hit, inward, outward, share, min(hit.path, sheet_side(p.xz, inward.xz)));
}

// Way to where a ray leaves the matter sideways: the border that it then sees is that of a basin
fn sheet_side(from_xz: vec2f, direction_xz: vec2f) -> f32 {
    let high = sheet.extents_low + sheet.extents_size;
    let to_side = select(sheet.extents_low, high, direction_xz > vec2f(0.0)) - from_xz;
    let t = abs(to_side) / max(abs(direction_xz), vec2f(1e-9));
    return min(t.x, t.y);
}
