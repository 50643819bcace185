// The light of a lamp enters matter at each texel of the translucent layer and is followed to the solid one.
//!import techniques/relief/shaders/caustic_bindings
//!import techniques/relief/shaders/light_plane
//!import techniques/relief/shaders/light_rays

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < relief.texels) {
        caustic_beams[caustic_index(id.xy)] = beam_of(id.xy);
    }
}

// What a level surface receives counts as 1: (l.n) / (n.N) of light on a slope, over the l.N there.
fn beam_of(texel: vec2u) -> ReliefBeam {
    var beam = ReliefBeam(vec3f(0.0), BEAM_DARK, vec2f(texel));
    let uv = plane_uv(vec2f(texel));
    let both = relief_heights(uv);
    if both.y <= both.x {
        beam.kind = BEAM_DRY;
        return beam;
    }
    let frame_at = plane_frame(uv, both.y);
    let lamp = relief_lamp(plane.light, frame_at.p_ws);
    let n_ws = relief_normal(frame_at, uv, relief_translucent_slopes(uv, 0.0));
    let facing = dot(n_ws, lamp.to_ws);
    let rise = dot(plane.normal, lamp.to_ws);
    if facing <= 0.0 || rise <= 0.0 {
        return beam;
    }
    let inside = refract(-lamp.to_ws, n_ws, relief.n_outside, plane.n_layer).direction;
    let ray = relief_ray(frame_at, uv, both.y, inside);
    let reach = relief_reach(ray);
    let t = light_crossing(ray, 0.0, reach, RELIEF_SOLID, false);
    if t > reach {
        return beam;
    }
    let seen = relief_shadow(relief_ray(frame_at, uv, both.y, lamp.to_ws), lamp.tan_radius, lamp.distance_m);
    let flux = seen * facing / (dot(n_ws, plane.normal) * rise);
    let lost = fresnel_dielectric(facing, relief.n_outside, plane.n_layer);
    beam.flux = plane.channels * flux * (1.0 - lost) * transmittance(relief.absorption, t);
    beam.kind = BEAM_LIT;
    beam.landed = vec2f(texel) + t * relief_walk(ray).step;
    return beam;
}
