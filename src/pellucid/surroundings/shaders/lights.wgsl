// Light from lamps: how much arrives at a point, and from where.
//!import surroundings/shaders/raycast
//!import surroundings/shaders/shadow

// Which lamps there are. A driver that executes every branch spares what no lamp of the scene takes: a ray a sample.
override LAMPS_FAR: bool = true;
override LAMPS_NEAR: bool = true;
override LAMPS: i32 = -1;              // how many of all kinds, -1 for as many as the frame says
override LAMPS_OCCLUDED: bool = true;  // whether a mesh can stand before those nearby

const LIGHT_DIRECTIONAL = 0u;
const LIGHT_POINT = 1u;
const LIGHT_AREA = 2u;
const AREA_STRATA = 2u;  // an area light is sampled at AREA_STRATA^2 points

struct LightSample {
    direction: vec3f,   // unit, towards the light
    irradiance: vec3f,  // on a surface that faces the light; zero in its shadow
}

// Not the uniform alone: the software driver builds a shader anew, at every dispatch, for the values of uniforms that conditions
// depend on and nothing else.
fn light_count() -> u32 {
    return select(min(frame.light_count, arrayLength(&lights)), u32(LAMPS), LAMPS >= 0);
}

fn light_sample_count(light: u32) -> u32 {
    return select(1u, AREA_STRATA * AREA_STRATA, LAMPS_NEAR && lights[light].kind == LIGHT_AREA);
}

fn sample_light(light: u32, index: u32, p_ws: vec3f, n_ws: vec3f) -> LightSample {
    if LAMPS_FAR && (!LAMPS_NEAR || lights[light].kind == LIGHT_DIRECTIONAL) {
        return sample_directional_light(light, p_ws, n_ws);
    }
    if LAMPS_NEAR {
        return sample_near_light(light, index, p_ws, n_ws);
    }
    return LightSample(n_ws, vec3f(0.0));
}

fn sample_directional_light(light: u32, p_ws: vec3f, n_ws: vec3f) -> LightSample {
    let direction = lights[light].direction;
    if dot(direction, n_ws) <= 0.0 {
        return LightSample(direction, vec3f(0.0));
    }
    return LightSample(direction, lights[light].power * shadow_visibility(light, p_ws, n_ws));
}

// A point: irradiance = intensity / distance^2. Or one stratum of a one-sided rectangle: irradiance = radiance
// cos(theta) area / distance^2 / samples. One ray serves both: a software driver would send both.
fn sample_near_light(light: u32, index: u32, p_ws: vec3f, n_ws: vec3f) -> LightSample {
    let is_area = lights[light].kind == LIGHT_AREA;
    let to_light = way_to_near_light(light, index, p_ws);
    let d2 = max(dot(to_light, to_light), 1e-12);
    let direction = to_light * inverseSqrt(d2);
    let cosine = -dot(direction, lights[light].direction);
    let area = length(cross(lights[light].edge_u, lights[light].edge_v)) / f32(AREA_STRATA * AREA_STRATA);
    let strength = select(1.0, cosine * area, is_area) / d2;
    let seen = strength > 0.0 && light_reaches(light, p_ws, n_ws, direction, sqrt(d2));
    return LightSample(direction, lights[light].power * select(0.0, strength, seen));
}

// Metres to a point, or to one of a stratum
fn way_to_near_light(light: u32, index: u32, p_ws: vec3f) -> vec3f {
    let cell = vec2f(f32(index % AREA_STRATA), f32(index / AREA_STRATA));
    let st = (cell + light_jitter(p_ws, index + 31u * light)) / f32(AREA_STRATA) - 0.5;
    let aside = st.x * lights[light].edge_u + st.y * lights[light].edge_v;
    return lights[light].position + select(vec3f(0.0), aside, lights[light].kind == LIGHT_AREA) - p_ws;
}

// Unit direction of what sample_light would give, without a ray to it
fn light_direction(light: u32, index: u32, p_ws: vec3f) -> vec3f {
    let far = LAMPS_FAR && (!LAMPS_NEAR || lights[light].kind == LIGHT_DIRECTIONAL);
    return select(normalize(way_to_near_light(light, index, p_ws)), lights[light].direction, far);
}

fn light_reaches(light: u32, p_ws: vec3f, n_ws: vec3f, direction: vec3f, distance_m: f32) -> bool {
    if dot(n_ws, direction) <= 0.0 {
        return false;
    }
    if !LAMPS_OCCLUDED || lights[light].shadow_layer < 0 {
        return true;
    }
    let start = p_ws + n_ws * frame.ray_epsilon_m;
    return !occluded(start, direction, distance_m - 2.0 * frame.ray_epsilon_m);
}

// Two numbers in 0..1 that differ from point to point and from frame to frame [jarzynski2020, pcg3d]
fn light_jitter(p_ws: vec3f, salt: u32) -> vec2f {
    var v = bitcast<vec3u>(p_ws) + vec3u(frame.sample_index, salt, 0u);
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    return vec2f(v.xy >> vec2u(8u)) / 16777216.0;
}
