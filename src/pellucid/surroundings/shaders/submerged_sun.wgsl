// Directional light in water: refracted at a level surface, focused by its waves as its map says, weakened on its way.
//!import optics/fresnel
//!import surroundings/shaders/lights
//!import surroundings/shaders/shadow
//!import surroundings/shaders/submerged_sky
//!import surroundings/shaders/submersion

override SUN_APART: bool = false;  // leave out what the first map of a water tells, see sunlit.wgsl
override MAPS_ALONG: bool = false; // whether a point is seen on all maps of its water where its light has come in
override ASTRAY: bool = true;      // whether any water scatters light

// Unit direction towards a light, in the water; `index` is that of the water over that above
fn submerged_direction(to_light: vec3f, index: f32) -> vec3f {
    let aside = to_light.xz / index;
    return vec3f(aside.x, sqrt(max(1.0 - dot(aside, aside), 0.0)), aside.y);
}

// Irradiance across the refracted beam: that above, l.y of which falls on a square metre of the surface, over the
// share of the refracted beam that leaves it, times what the surface lets through and does to its density
fn sample_submerged_sun(light: u32, p_ws: vec3f, n_ws: vec3f, at: Submerged, seen: f32) -> LightSample {
    let towards = lights[light].direction;
    let direction = submerged_direction(towards, submersion.index[at.water].g);
    if towards.y <= 0.0 || dot(direction, n_ws) <= 0.0 {
        return LightSample(direction, vec3f(0.0));
    }
    let irradiance = lights[light].power * (towards.y / direction.y);
    if SUN_APART {
        return LightSample(direction, irradiance);  // there is one map, and all its light is added later
    }
    let beam = submerged_beam(towards, direction, at.water);
    return LightSample(direction, irradiance * submerged_share(beam, lights[light].water_layer, p_ws, at.water, seen));
}

// The lamp of the first map of each water; the first lamp where there is none
fn submerged_sun() -> u32 {
    var found = 0u;
    for (var light = 0u; light < light_count(); light++) {
        found = select(found, light, lights[light].water_layer == 0);
    }
    return found;
}

// Whether light has come in through the surface at a place of the level; through a border it has not
fn submerged_mapped(water: u32, entry: vec2f) -> bool {
    let uv = submerged_uv(water, entry);
    var mapped = all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0));
    if SUBMERGED_OUTLINES {
        mapped = mapped && submerged_within(water, vec3f(entry.x, submersion.level[water].x, entry.y));
    }
    return mapped;
}

// What light of a lamp far away is in one water, wherever it goes
struct SubmergedBeam {
    passed: vec3f,  // share that the level surface lets through
    aside: vec2f,   // horizontal way over depth, towards the lamp
    longer: f32,    // way over depth
    astray: vec2f,  // how wide it goes astray, over its way, in sizes of the maps
}

fn submerged_beam(to_light: vec3f, direction: vec3f, water: u32) -> SubmergedBeam {
    let index = submersion.index[water].rgb;
    let passed = 1.0 - vec3f(
        fresnel_dielectric(to_light.y, 1.0, index.r),
        fresnel_dielectric(to_light.y, 1.0, index.g),
        fresnel_dielectric(to_light.y, 1.0, index.b),
    );
    let size_m = submersion.bounds[water].zw - submersion.bounds[water].xy;
    let astray = SUBMERGED_ASTRAY * sqrt(max(1.0 - submersion.scattering[water].a, 0.0));
    return SubmergedBeam(passed, direction.xz / direction.y, 1.0 / direction.y, astray / size_m);
}

// Its share that comes through, and loss; `layer` is that of its map among the maps of the water, -1 for none. The beam
// loses all that is absorbed or scattered. What is scattered by less than a right angle comes too [gordon1973], from a
// place as wide as it goes astray: the mean of the map there, of four points.
fn submerged_share(beam: SubmergedBeam, layer: i32, p_ws: vec3f, water: u32, seen: f32) -> vec3f {
    let level = submersion.level[water];
    let map = u32(level.z) + u32(max(layer, 0));
    let slope = submersion.slope[water * MAX_WATER_LIGHTS + u32(max(layer, 0))].xy;
    let entry = submerged_entry(p_ws, level.x, select(slope, beam.aside, layer < 0));
    let uv = submerged_uv(water, entry);
    let found = textureSampleLevel(submerged_light, caustic_sampler, uv, map, 0.0);
    var wave_m = found.a;
    if !MAPS_ALONG {
        wave_m = submerged_wave(water, submerged_entry(p_ws, level.x, beam.aside));
    }
    let path_m = max(level.x + wave_m - p_ws.y, 0.0) * beam.longer;
    let mapped = layer >= 0 && submerged_mapped(water, entry);
    let share = select(beam.passed, found.rgb, mapped) * select(seen, 1.0, layer < 0);
    let direct = exp(-(submersion.absorption[water].rgb + submersion.scattering[water].rgb) * path_m);
    if !ASTRAY {
        return share * direct;
    }
    let soft = select(beam.passed, submerged_mean(uv, map, beam.astray * path_m), mapped);
    return share * direct + soft * (exp(-submerged_attenuation(water) * path_m) - direct);
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
