// Light from infinitely far away: an equirectangular map, row 0 towards +Y, centre column towards -Z.
//!import surroundings/shaders/bindings

const ENVIRONMENT_PI = 3.14159265358979;
const ENVIRONMENT_GLOSSY_ALPHA = 0.04;  // environment.GLOSSY_ALPHA

// World to map: the map is turned about +Y by the scene's rotation
fn environment_space(direction_ws: vec3f) -> vec3f {
    let c = frame.environment_rotation.x;
    let s = frame.environment_rotation.y;
    return vec3f(c * direction_ws.x - s * direction_ws.z, direction_ws.y, s * direction_ws.x + c * direction_ws.z);
}

fn environment_uv(direction: vec3f) -> vec2f {
    let pole = direction.x == 0.0 && direction.z == 0.0;
    let azimuth = atan2(direction.x, select(-direction.z, 1.0, pole));
    let polar = atan2(length(direction.xz), direction.y);  // acos would lose half its digits near the poles
    return vec2f(0.5 + azimuth / (2.0 * ENVIRONMENT_PI), polar / ENVIRONMENT_PI);
}

// Radiance from a unit direction, averaged over texels that double in size with each level
fn environment_radiance_blurred(direction_ws: vec3f, lod: f32) -> vec3f {
    let uv = environment_uv(environment_space(direction_ws));
    return frame.environment_intensity * textureSampleLevel(env_map, env_sampler, uv, lod).rgb;
}

// Radiance from a unit direction, at the sharpness of the picture
fn environment_radiance(direction_ws: vec3f) -> vec3f {
    return environment_radiance_blurred(direction_ws, frame.environment_pixel_lod);
}

// Irradiance on a surface, radiance times sr [ramamoorthi2001, eqs. 5, 7, 8]; see environment.irradiance_sh
fn environment_irradiance(normal_ws: vec3f) -> vec3f {
    let n = environment_space(normal_ws);
    var e = frame.environment_sh[0].rgb;
    e += frame.environment_sh[1].rgb * n.x + frame.environment_sh[2].rgb * n.y + frame.environment_sh[3].rgb * n.z;
    e += frame.environment_sh[4].rgb * (n.x * n.y) + frame.environment_sh[5].rgb * (n.y * n.z);
    e += frame.environment_sh[6].rgb * (n.x * n.z) + frame.environment_sh[7].rgb * (3.0 * n.y * n.y - 1.0);
    e += frame.environment_sh[8].rgb * (n.x * n.x - n.z * n.z);
    return frame.environment_intensity * max(e, vec3f(0.0));
}

// Radiance averaged over all directions: the irradiance averaged over all normals is pi times it
fn environment_mean_radiance() -> vec3f {
    return frame.environment_intensity * max(frame.environment_sh[0].rgb, vec3f(0.0)) / ENVIRONMENT_PI;
}

// Mean radiance that a mirror of GGX roughness alpha shows in a direction, see environment.glossy_levels
fn environment_glossy(direction_ws: vec3f, alpha: f32) -> vec3f {
    if alpha < ENVIRONMENT_GLOSSY_ALPHA {
        return environment_radiance_blurred(direction_ws, environment_lod(alpha));
    }
    let uv = environment_uv(environment_space(direction_ws));
    let lod = log2(alpha / ENVIRONMENT_GLOSSY_ALPHA);
    return frame.environment_intensity * textureSampleLevel(env_glossy, env_sampler, uv, lod).rgb;
}

// Level whose texel is as large as the peak of a GGX lobe, one sample of solid angle 1 / pdf
// [krivanek2008, eqs. 11, 12], with pdf = D / 4 = 1 / (4 pi alpha^2) at the mirror direction
fn environment_lod(alpha: f32) -> f32 {
    let texels = 2.0 * frame.environment_height * frame.environment_height;
    let lod = 0.5 * log2(max(2.0 * alpha * alpha * texels / ENVIRONMENT_PI, 1.0));
    return clamp(lod, frame.environment_pixel_lod, frame.environment_max_lod);
}
