// Where a ray meets the picture's plane, in coordinates of the sheet: level y = 0, picture at y = -depth.
// Twin of reference.py.

const SHEET_LEAST_FALL = 1e-4;  // of a direction, so that level and rising rays see the border, far away
const SHEET_GRAZING = 1e-3;     // least cosine between normal and view

struct SheetHit {
    xz: vec2f,  // metres of the sheet's own
    path: f32,  // way there
}

// x = x0 + Rf t, t = p / Rf_y with p = p_i + (y_i - y0) [oliveira2000b, eq. 9-11]. Lengths are signed there: p_i is
// -depth and y_i is 0, so that all rays end at one depth below the level, not below the vertex.
fn sheet_hit(p: vec3f, direction: vec3f, depth: f32) -> SheetHit {
    let t = -(depth + p.y) / min(direction.y, -SHEET_LEAST_FALL);
    return SheetHit(p.xz + t * direction.xz, t);
}

// u = (x - x_i) / length_x, v = (z - z_i) / length_z [oliveira2000b, eq. 12, 13], and the first rule for borders: what
// lies outside is taken to the border. The second is in the limits: they are wider.
fn sheet_uv(xz: vec2f, low: vec2f, size: vec2f) -> vec2f {
    return saturate((xz - low) / size);
}

// A normal that leans away from the viewer is turned until it just faces them: interpolated ones do not know what
// the triangle hides
fn sheet_facing(normal: vec3f, direction: vec3f) -> vec3f {
    let facing = -dot(normal, direction);
    return select(normal, normalize(normal - (SHEET_GRAZING - facing) * direction), facing < SHEET_GRAZING);
}
