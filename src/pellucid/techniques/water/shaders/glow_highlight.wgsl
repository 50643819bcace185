// Lamps mirrored in the water, in a picture of few pixels [mihalik2008, 9.3].
//!import surroundings/shaders/camera
//!import surroundings/shaders/full_picture
//!import surroundings/shaders/lights
//!import techniques/water/shaders/hit
//!import techniques/water/shaders/waves

const GLOW_POWER = 200.0;
const GLOW_COLOR = vec3f(1.0, 1.0, 0.8);

// pow(R.E, 200) of every lamp that is far away, R its light mirrored and E the way to the viewer; as bright as a white
// surface that faces the lamp
@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = clamp(position.xy * glow_scale(), vec2f(0.0), frame.size - 1.0);
    let hit = water_hit(textureLoad(water_hits, vec2i(at * vec2f(textureDimensions(water_hits)) / frame.size), 0));
    let ray = camera_ray(floor(at) + 0.5);
    let p_ws = ray.origin + hit.t * ray.direction;
    let n_ws = wave_normal(wave_point(p_ws.xz, glow_scale() * footprint_m(p_ws)).slope);
    var sum = vec3f(0.0);
    for (var light = 0u; light < light_count(); light++) {
        let towards = lights[light].direction;
        let cosine = dot(reflect(-towards, n_ws), -ray.direction);
        let shown = hit.kind == WATER_ABOVE && lights[light].kind == LIGHT_DIRECTIONAL && towards.y > 0.0;
        sum += select(vec3f(0.0), lights[light].power * pow(max(cosine, 0.0), GLOW_POWER) / 3.14159265, shown);
    }
    return vec4f(sum * GLOW_COLOR, 1.0);
}

// Pixels of the picture to one of this, see glow.SCALE
fn glow_scale() -> f32 {
    return 4.0;
}
