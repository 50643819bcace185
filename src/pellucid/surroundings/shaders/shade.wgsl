// Radiance that an opaque surface sends to a viewer.
//!import surroundings/shaders/camera
//!import surroundings/shaders/caustics
//!import surroundings/shaders/environment
//!import surroundings/shaders/ggx
//!import surroundings/shaders/lights
//!import surroundings/shaders/submerged_lights
//!import surroundings/shaders/surface

override CAUSTICS: bool = false;  // whether light that has passed refractive matter was collected on the meshes
override SUBMERGED: bool = false;  // whether there is water that surfaces may stand in

const SHADE_MIN_ALPHA = 0.002;  // a lamp is a point: a perfect mirror would show it infinitely bright

// What a surface sends, and what it would send for each unit of the light that a map tells of
struct Shaded {
    radiance: vec3f,
    sun: vec3f,       // times the share of the lamp that comes to the surface
    sun_seen: f32,    // 0 in shadow, 1 in the light
}

fn shade_surface(surface: SurfacePoint, triangle: u32, view_ws: vec3f) -> vec3f {
    return shade_parts(surface, triangle, view_ws).radiance;
}

// Lambert under GGX. What the lobe reflects is taken from the diffuse share, so a white surface in a uniform
// environment returns just that environment, at any roughness.
fn shade_parts(surface: SurfacePoint, triangle: u32, view_ws: vec3f) -> Shaded {
    let p_ws = surface.p_ws;
    let n_ws = surface.n_ws;
    let material = surface.material;
    let n_dot_v = clamp(dot(n_ws, view_ws), 1e-4, 1.0);
    let roughness = materials[material].roughness;
    var f0 = materials[material].specular;
    var water = Submerged(false, 0u, 0.0);
    if SUBMERGED {
        if SUN_APART {
            water = submerged_at_rest(p_ws);
        } else {
            water = submerged_at(p_ws);
        }
        f0 = select(f0, submerged_coat(f0, submersion.index[water.water].g), water.inside && f0 > 0.0);
    }
    let alpha = max(roughness * roughness, SHADE_MIN_ALPHA);
    let specular = ggx_albedo(n_dot_v, roughness, f0);
    let diffuse = (1.0 - specular) * base_color(material, surface.uv, p_ws, n_dot_v) / GGX_PI;
    var from_everywhere = environment_irradiance(n_ws);
    if SUBMERGED {
        if water.inside {
            from_everywhere = submerged_irradiance(p_ws, n_ws, diffuse * GGX_PI, water);
        }
    }
    var radiance = materials[material].emission + diffuse * from_everywhere;
    if specular > 0.0 {
        let mirrored = reflect(-view_ws, n_ws);
        if SUBMERGED {
            // One reading serves both: a software driver would do both.
            let out = select(mirrored, submerged_way_out(mirrored, water), water.inside);
            let sky = environment_glossy(out, alpha);
            radiance += specular * select(sky, submerged_glossy(sky, mirrored, water), water.inside);
        } else {
            radiance += specular * environment_glossy(mirrored, alpha);
        }
    }
    var apart = Shaded(vec3f(0.0), vec3f(0.0), 1.0);
    var direct = DirectLight(vec3f(0.0), vec3f(0.0));
    let n_face = face_normal(triangle, view_ws);
    for (var light = 0u; light < light_count(); light++) {
        var seen = 1.0;
        if SUBMERGED {
            seen = lamp_seen(light, p_ws, n_ws, water);
        }
        let samples = light_sample_count(light);
        for (var k = 0u; k < samples; k++) {
            var sample: LightSample;
            if SUBMERGED {
                sample = sample_light_anywhere(light, k, p_ws, n_ws, water, seen);
            } else {
                sample = sample_light(light, k, p_ws, n_ws);
            }
            let n_dot_l = dot(n_ws, sample.direction);
            if CAUSTICS {
                direct.irradiance += sample.irradiance * max(dot(n_face, sample.direction), 0.0);
            }
            if n_dot_l > 0.0 && any(sample.irradiance > vec3f(0.0)) {
                let brdf = diffuse + specular_lobe(n_ws, view_ws, sample.direction, n_dot_l, n_dot_v, alpha, f0);
                let sent = brdf * sample.irradiance * n_dot_l;
                if SUN_APART {
                    let mapped = water.inside && lights[light].water_layer == 0;
                    apart.sun += select(vec3f(0.0), sent, mapped);
                    apart.sun_seen = select(apart.sun_seen, seen, mapped);
                    radiance += select(sent, vec3f(0.0), mapped);
                } else {
                    radiance += sent;
                }
                if CAUSTICS {
                    direct.radiance += sent;
                }
            }
        }
    }
    if CAUSTICS {
        let received = received_at(triangle, p_ws, view_ws);
        radiance += diffuse * received.caustic - direct.radiance * blocked_share(received, direct.irradiance);
        radiance = max(radiance, vec3f(0.0));
    }
    return Shaded(radiance, apart.sun, apart.sun_seen);
}

// What the lamps give to a point by themselves
struct DirectLight {
    radiance: vec3f,    // that it sends to the viewer
    irradiance: vec3f,  // on the face, whose normal is not the interpolated one
}

// D V F [walter2007, eq. 20], 1/sr
fn specular_lobe(n: vec3f, v: vec3f, l: vec3f, n_dot_l: f32, n_dot_v: f32, alpha: f32, f0: f32) -> f32 {
    if f0 <= 0.0 {
        return 0.0;
    }
    let h = normalize(v + l);
    return ggx_distribution(saturate(dot(n, h)), alpha) * ggx_visibility(n_dot_l, n_dot_v, alpha)
        * lobe_fresnel(dot(v, h), f0);
}

// Base colour, its map read at the level where a texel is as large as the pixel's footprint on the surface
fn base_color(material: u32, uv: vec2f, p_ws: vec3f, n_dot_v: f32) -> vec3f {
    let flat_color = materials[material].base_color;
    let layer = materials[material].base_color_layer;
    if layer < 0 {
        return flat_color;
    }
    let texels = materials[material].texels_per_m * footprint_m(p_ws) * inverseSqrt(n_dot_v);
    let lod = max(log2(max(texels, 1e-6)), 0.0);
    let at = vec2f(uv.x, 1.0 - uv.y);
    return flat_color * textureSampleLevel(base_color_maps, base_color_sampler, at, layer, lod).rgb;
}

// Radiance back along a ray from where it hit
fn shade_hit(hit: SurfaceHit, direction_ws: vec3f) -> vec3f {
    let view_ws = -normalize(direction_ws);
    let surface = surface_at(hit.triangle, hit.barycentric, view_ws);
    return shade_surface(surface, hit.triangle, view_ws);
}
