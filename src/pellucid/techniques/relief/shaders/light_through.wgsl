// What the translucent layer leaves of the light of a lamp on its way to a point under it.
//!import optics/attenuation
//!import optics/fresnel
//!import optics/snell
//!import techniques/relief/shaders/light_stepped
//!import techniques/relief/shaders/light_walk

const THROUGH_CROSSINGS = 8u;
const THROUGH_BINARY_STEPS = 5u;

// The way towards the lamp within a level layer, so that the point of its surface that sees the lamp is met
fn relief_bent(n_ws: vec3f, to_lamp_ws: vec3f) -> vec3f {
    if dot(n_ws, to_lamp_ws) <= 0.0 || RELIEF_LIGHT_STEPPED {
        return to_lamp_ws;
    }
    return -refract(-to_lamp_ws, n_ws, relief.n_outside, relief.n_layer.g).direction;
}

// Share of light that an interface lets through where the way to the lamp leaves matter, or goes into it. Rays bend at
// both, so that the angle outside tells both; the straight one of [timonen2006] is reflected totally where it is flat.
fn relief_interface(frame_at: ReliefFrame, uv: vec2f, to_lamp_ws: vec3f, leaves: bool) -> f32 {
    let n_ws = relief_normal(frame_at, uv, relief_translucent_slopes(uv, 0.0));
    let cosine = abs(dot(n_ws, to_lamp_ws));
    let straight_out = RELIEF_LIGHT_STEPPED && !leaves;
    let n_from = select(relief.n_outside, relief.n_layer.g, straight_out);
    let n_to = select(relief.n_layer.g, relief.n_outside, straight_out);
    return 1.0 - fresnel_dielectric(cosine, n_from, n_to);
}

// [timonen2006, 4.2.2] from crossing to crossing; the solid layer counts in light_shadow.wgsl. Begins at
// (uv, h), within matter or over it. In matter around the point light runs along `way_ws`, elsewhere straight.
fn relief_through(
    frame_at: ReliefFrame, uv: vec2f, h: f32, within: bool, way_ws: vec3f, to_lamp_ws: vec3f
) -> vec3f {
    var ray = relief_ray(frame_at, uv, h, way_ws);
    var inside = within;
    var begin = 0.0;
    var entered = 0.0;
    var light = vec3f(1.0);
    for (var k = 0u; k < THROUGH_CROSSINGS; k++) {
        let reach = relief_reach(ray);
        let t = light_crossing(ray, begin, reach, RELIEF_TRANSLUCENT, inside);
        if inside {
            light *= transmittance(relief.absorption, min(t, reach) - entered);
        }
        if t >= reach || dot(light, light) == 0.0 {
            break;
        }
        let at = ray.uv + t * ray.duv;
        light *= relief_interface(frame_at, at, to_lamp_ws, inside);
        if inside {
            ray = relief_ray(frame_at, at, relief_height_along(ray, t), to_lamp_ws);
            begin = relief_walk(ray).past;
        } else {
            begin = t + relief_walk(ray).past;
            entered = t;
        }
        inside = !inside;
    }
    return light;
}

// The same in equal steps up to the top of both layers, each crossing halved [timonen2006, 4.2.2]
fn relief_stepped_through(frame_at: ReliefFrame, uv: vec2f, h: f32, within: bool, to_lamp_ws: vec3f) -> vec3f {
    let ray = relief_ray(frame_at, uv, h, to_lamp_ws);
    let steps = RELIEF_SHADOW_STEPS;
    let step = relief_reach(ray) / f32(steps);
    var inside = within;
    var entered = 0.0;
    var light = vec3f(1.0);
    for (var k = 1u; k <= steps + 1u; k++) {
        let end = f32(k) * step;
        if (relief_height_along(ray, end) < relief_heights(ray.uv + end * ray.duv).y) == inside {
            continue;
        }
        var t = end - 0.5 * step;
        var width = 0.25 * step;
        for (var j = 0u; j < THROUGH_BINARY_STEPS; j++) {
            let before = (relief_height_along(ray, t) < relief_heights(ray.uv + t * ray.duv).y) == inside;
            t += select(-width, width, before);
            width *= 0.5;
        }
        light *= relief_interface(frame_at, ray.uv + t * ray.duv, to_lamp_ws, inside);
        if inside {
            light *= transmittance(relief.absorption, t - entered);
        }
        entered = t;
        inside = !inside;
    }
    if inside {
        light *= transmittance(relief.absorption, f32(steps) * step - entered);
    }
    return light;
}
