// Second pass: the radiance of what each pixel sees of the relief.
//!import surroundings/shaders/full_picture
//!import techniques/relief/shaders/enter
//!import techniques/relief/shaders/outside
//!import techniques/relief/shaders/show

@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let record = textureLoad(relief_hits, vec2i(position.xy), 0);
    var radiance = vec3f(0.0);
    // Not by an early discard: a software driver would go on with the pixels that it takes out.
    if (record.w & 3u) != RELIEF_NONE {
        radiance = seen_radiance(position.xy, record);
    } else {
        discard;
    }
    return vec4f(radiance, 1.0);
}

fn seen_radiance(pixel: vec2f, record: vec4u) -> vec3f {
    let layer = record.w & 3u;
    let bits = bitcast<vec3f>(record.xyz);
    let frame_at = relief_frame(record.w >> 2u, bits.yz);
    let direction_ws = camera_ray(pixel).direction;
    let ray = relief_ray(frame_at, frame_at.uv, frame_at.h, direction_ws);
    let p_ws = frame_at.p_ws + bits.x * direction_ws;
    var uv = ray.uv + bits.x * ray.duv;
    if RELIEF_DEPTH == 1u {
        uv = relief_offset(frame_at, direction_ws);
    }
    let h = relief_height_along(ray, bits.x);
    let on_wall = bits.x == 0.0 && any(frame_at.wall_ws != vec3f(0.0));
    var footprint = relief_footprint(frame_at, p_ws, direction_ws);
    if on_wall {
        footprint = cut_footprint(frame_at, uv, h, p_ws);
    }
    relief_pixel_tiles = footprint;
    if !TWO_LAYERS {
        return solid_alone(frame_at, uv, h, p_ws, direction_ws, footprint, on_wall);
    }
    let slopes = relief_translucent_slopes(uv, relief_surface_level(footprint));
    let n_layer = select(relief_normal(frame_at, uv, slopes), frame_at.wall_ws, on_wall);
    let n_ws = relief_towards(n_layer, direction_ws);
    let reflected = relief_shown_reflectance(relief_layer_reflectance(-dot(n_ws, direction_ws)));
    let at = LayerPoint(uv, h, p_ws, n_ws, direction_ws, footprint, reflected);
    return both_layers(frame_at, at, layer == RELIEF_SOLID, on_wall);
}

// Refracted looks, one or three, then the mirrored one; or the solid layer itself. All are shaded in one place, since
// every place that shades would be executed by all pixels.
fn both_layers(frame_at: ReliefFrame, at: LayerPoint, is_solid: bool, on_wall: bool) -> vec3f {
    if relief_shows_at_once() && !is_solid {
        return relief_shown_at_once(frame_at, at);
    }
    var outside: OutsideLooks;
    var radiance = vec3f(0.0);
    let rays = select(1u, 3u, RELIEF_DISPERSION);
    let mirrors = select(0u, 1u, RELIEF_REFLECTION != 0u);
    if RELIEF_REFLECTION == 0u {
        let alpha = relief.translucent_roughness * relief.translucent_roughness;
        outside.mirrored = OutsideLook(at.p_ws, reflect(at.direction_ws, at.n_ws), alpha, at.reflected);
    }
    for (var k = 0u; k < select(rays + mirrors, 1u, is_solid); k++) {
        var look = SolidLook(at.uv, at.footprint, false, at.p_ws, -at.direction_ws, vec3f(1.0));
        if !is_solid {
            if RELIEF_REFLECTION != 0u && k == rays {
                look = relief_reflect(frame_at, at, &outside);
            } else {
                look = relief_refract(frame_at, at, k, &outside);
            }
        }
        if any(look.weight > vec3f(0.0)) {
            let point = seen_point(frame_at, look.uv, at.h, look.p_ws, look.footprint, on_wall && is_solid);
            radiance += look.weight * relief_solid_radiance(point, look.view_ws, look.footprint, look.wet);
        }
    }
    if is_solid {
        return relief_shown_solid(radiance);
    }
    if RELIEF_SHOWS == RELIEF_SHOWS_RADIANCE {
        radiance += relief_glints(at.p_ws, at.n_ws, -at.direction_ws);
    }
    radiance += outside.mirrored.weight * outside_radiance(outside.mirrored);
    if any(outside.passed.weight > vec3f(0.0)) {
        radiance += outside.passed.weight * outside_radiance(outside.passed);
    }
    return radiance;
}

fn outside_radiance(look: OutsideLook) -> vec3f {
    return relief_outside(look.origin_ws, look.direction_ws, look.alpha);
}

fn solid_alone(
    frame_at: ReliefFrame, uv: vec2f, h: f32, p_ws: vec3f, direction_ws: vec3f, footprint: f32, cut: bool
) -> vec3f {
    let point = seen_point(frame_at, uv, h, p_ws, footprint, cut);
    return relief_solid_radiance(point, -direction_ws, footprint, false);
}

// The cut at an open border has the colours of the layer over it: the deeper, the wider around. Those right above alone
// would be drawn out into streaks.
fn cut_footprint(frame_at: ReliefFrame, uv: vec2f, h: f32, p_ws: vec3f) -> f32 {
    let depth_m = max(relief_heights(uv).x - h, 0.0);
    return max(footprint_m(p_ws), depth_m) / relief_side_m(frame_at);
}

// At an open border the surface is the cut
fn seen_point(frame_at: ReliefFrame, uv: vec2f, h: f32, p_ws: vec3f, footprint: f32, cut: bool) -> ReliefPoint {
    var point = relief_solid_point(frame_at, uv, p_ws, footprint);
    point.n_ws = select(point.n_ws, frame_at.wall_ws, cut);
    point.h = select(point.h, h, cut);
    point.is_cut = cut;
    return point;
}
