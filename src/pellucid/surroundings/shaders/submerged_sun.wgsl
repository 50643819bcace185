// Directional light in water: refracted at a level surface, focused by its waves as its map says, weakened on its way.
//!import optics/fresnel
//!import surroundings/shaders/lights
//!import surroundings/shaders/shadow
//!import surroundings/shaders/submersion

override SUN_APART: bool = false;  // leave out what the first map of a water tells, see sunlit.wgsl

// Unit direction towards a light, in the water; `index` is that of the water over that above
fn submerged_direction(to_light: vec3f, index: f32) -> vec3f {
    let aside = to_light.xz / index;
    return vec3f(aside.x, sqrt(max(1.0 - dot(aside, aside), 0.0)), aside.y);
}

// Irradiance across the refracted beam: that above, l.y of which falls on a square metre of the surface, over the
// share of the refracted beam that leaves it, times what the surface lets through and does to its density
fn sample_submerged_sun(light: u32, p_ws: vec3f, n_ws: vec3f, at: Submerged) -> LightSample {
    let towards = lights[light].direction;
    let index = submersion.index[at.water].rgb;
    let direction = submerged_direction(towards, index.g);
    if towards.y <= 0.0 || dot(direction, n_ws) <= 0.0 {
        return LightSample(direction, vec3f(0.0));
    }
    let irradiance = lights[light].power * (towards.y / direction.y);
    return LightSample(direction, irradiance * submerged_beam(light, p_ws, n_ws, direction, at));
}

// What is left of the flux that falls on the surface above a point. In pictures that keep the sun apart (sunlit.wgsl) it
// is all for the first map.
fn submerged_beam(light: u32, p_ws: vec3f, n_ws: vec3f, direction: vec3f, at: Submerged) -> vec3f {
    let layer = lights[light].water_layer;
    if SUN_APART && layer == 0 {
        return vec3f(1.0);
    }
    var seen = 1.0;
    if layer >= 0 {
        seen = submerged_map_visibility(light, p_ws, n_ws, at.water);
    }
    return submerged_share(light, p_ws, direction, at.water, seen);
}

// Shadow of meshes in the map of a light; past walls, if there are any, in light that has not come in through the surface
fn submerged_map_visibility(light: u32, p_ws: vec3f, n_ws: vec3f, water: u32) -> f32 {
    let layer = u32(max(lights[light].water_layer, 0));
    let camera = submersion.slope[water * MAX_WATER_LIGHTS + layer];
    if submerged_mapped(submerged_uv(water, submerged_entry(p_ws, submersion.level[water].x, camera.xy))) {
        let map = u32(submersion.level[water].z) + layer;
        return mix(1.0, submerged_visibility(water, map, p_ws, n_ws, camera.xy), camera.z);
    }
    return shadow_visibility(light, p_ws, n_ws);
}

// The lamp of the first map of each water; the first lamp where there is none
fn submerged_sun() -> u32 {
    var found = 0u;
    for (var light = 0u; light < light_count(); light++) {
        found = select(found, light, lights[light].water_layer == 0);
    }
    return found;
}

fn submerged_mapped(uv: vec2f) -> bool {
    return all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0));
}

// Its share that comes through, and loss. The beam loses all that is absorbed or scattered. What is scattered by less than
// a right angle comes too [gordon1973], from a place as wide as it goes astray: the mean of the map there, of four points.
fn submerged_share(light: u32, p_ws: vec3f, direction: vec3f, water: u32, seen: f32) -> vec3f {
    let level_m = submersion.level[water].x;
    let index = submersion.index[water].rgb;
    let towards = lights[light].direction;
    let scattering = submersion.scattering[water];
    let extinction = submersion.absorption[water].rgb + scattering.rgb;
    let attenuation = submersion.absorption[water].rgb + 0.5 * (1.0 - scattering.a) * scattering.rgb;
    var share = 1.0 - vec3f(
        fresnel_dielectric(towards.y, 1.0, index.r),
        fresnel_dielectric(towards.y, 1.0, index.g),
        fresnel_dielectric(towards.y, 1.0, index.b),
    );
    let entry = submerged_entry(p_ws, level_m, direction.xz / direction.y);
    let path_m = max(level_m + submerged_wave(water, entry) - p_ws.y, 0.0) / direction.y;
    let astray_m = SUBMERGED_ASTRAY * path_m * sqrt(max(1.0 - scattering.a, 0.0));
    var soft = share;
    let layer = lights[light].water_layer;
    if layer >= 0 {
        let slope = submersion.slope[water * MAX_WATER_LIGHTS + u32(layer)].xy;
        let uv = submerged_uv(water, submerged_entry(p_ws, level_m, slope));
        if submerged_mapped(uv) {
            let map = u32(submersion.level[water].z) + u32(layer);
            share = textureSampleLevel(submerged_light, caustic_sampler, uv, map, 0.0).rgb;
            soft = submerged_mean(uv, map, astray_m / (submersion.bounds[water].zw - submersion.bounds[water].xy));
        }
        share *= seen;
    }
    let direct = exp(-extinction * path_m);
    return share * direct + soft * (exp(-attenuation * path_m) - direct);
}

const SUBMERGED_ASTRAY = 0.7;  // of the way, times the root of 1 - g: angles are about the root of 2 (1 - g), over the way

fn submerged_mean(uv: vec2f, map: u32, reach: vec2f) -> vec3f {
    var sum = vec3f(0.0);
    for (var k = 0; k < 4; k++) {
        let corner = vec2f(f32(k & 1), f32(k >> 1)) - 0.5;
        sum += textureSampleLevel(submerged_light, caustic_sampler, uv + corner * reach, map, 0.0).rgb;
    }
    return 0.25 * sum;
}

// Whether the first mesh below the surface, along the light, is the point's own; filtered and kept off the surface as
// in shadow.wgsl
fn submerged_visibility(water: u32, map: u32, p_ws: vec3f, n_ws: vec3f, slope: vec2f) -> f32 {
    let bounds = submersion.bounds[water];
    let size = vec2f(textureDimensions(submerged_depth));
    let texel_m = max((bounds.z - bounds.x) / size.x, (bounds.w - bounds.y) / size.y);
    let to_camera = normalize(vec3f(slope.x, 1.0, slope.y));
    let cosine = dot(n_ws, to_camera);
    let p = p_ws + n_ws * texel_m * (0.05 + SHADOW_REACH_TEXELS * sqrt(saturate(1.0 - cosine * cosine)));
    let level = submersion.level[water];
    let depth = (level.x + level.y - p.y) / level.w;
    let uv = submerged_uv(water, submerged_entry(p, level.x, slope));
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let corner = vec2f(f32(k & 1), f32(k >> 1)) * 2.0 - 1.0;
        sum += textureSampleCompareLevel(submerged_depth, shadow_sampler, uv + 0.5 * corner / size, map, depth);
    }
    return 0.25 * sum;
}
