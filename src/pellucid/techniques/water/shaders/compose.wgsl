// Second pass: the radiance of what each pixel shows of the water.
//!import optics/fresnel
//!import optics/snell
//!import surroundings/shaders/full_picture
//!import techniques/water/shaders/glitter
//!import techniques/water/shaders/hit
//!import techniques/water/shaders/interface
//!import techniques/water/shaders/seen
//!import techniques/water/shaders/surface
//!import techniques/water/shaders/volume

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let hit = water_hit(textureLoad(water_hits, vec2i(position.xy), 0));
    if hit.kind == WATER_NONE {
        discard;
    }
    let ray = camera_ray(position.xy);
    let drawn = textureLoad(opaque_color, vec2i(position.xy), 0).rgb;
    let within = hit.kind == WATER_BELOW || hit.kind == WATER_FOG;
    var radiance = drawn;
    if hit.kind != WATER_FOG {
        radiance = interface_radiance(hit, ray.origin + hit.t * ray.direction, ray.direction);
    }
    if within {
        let path = water_path(ray.origin, ray.direction, hit.t);
        radiance = path.transmittance * radiance + path.inscatter;
    }
    return vec4f(radiance, 1.0);
}
