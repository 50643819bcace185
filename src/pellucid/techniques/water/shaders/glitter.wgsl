// Lamps that are far away, mirrored in the waves or refracted by them: glints, blurred by what a pixel hides of slopes.
//!import optics/fresnel
//!import optics/rough_water
//!import surroundings/shaders/lights
//!import techniques/water/shaders/waves

const GLITTER_WIDEST = 0.02;  // tangent of half the angle that a point is taken to have, at most

// Radiance towards the viewer: E F p(slope) over what is seen [ross2005; bruneton2010, sec. 5]; from within the water
// (1 - F) of the light that comes through.
fn water_glitter(p_ws: vec3f, at: WavePoint, view_ws: vec3f, from_within: bool) -> vec3f {
    let n_view = select(water.n_outside, water.n_water.g, from_within);
    // A point would be seen by no pixel.
    let least = clamp(frame.pixel_footprint, 5e-4, GLITTER_WIDEST);
    var radiance = vec3f(0.0);
    for (var light = 0u; light < light_count(); light++) {
        let towards = lights[light].direction;
        if lights[light].kind != LIGHT_DIRECTIONAL || towards.y <= 0.0 {
            continue;
        }
        let facet = facet_normal(view_ws, towards, n_view, water.n_outside);
        let moved = select(1.0, water.n_outside, from_within);
        let disc = disc_variance(towards, facet, max(lights[light].radius, least), moved);
        let sent = glint(view_ws, towards, at.slope, at.variance + disc, n_view, water.n_outside);
        let cosine = abs(dot(towards, facet)) / max(length(facet), 1e-12);
        let mirrored = fresnel_dielectric(cosine, water.n_outside, water.n_water.g);
        // Of facets that face the lamp some lie behind others [smith1967].
        let ahead = max(towards.y - dot(at.slope, towards.xz), 0.0) / max(visible_area(towards, at.slope, at.variance), 1e-6);
        let lit = saturate(ahead) * shadow_visibility(light, p_ws, wave_normal(at.slope));
        radiance += lights[light].power * sent * lit * select(mirrored, 1.0 - mirrored, from_within);
    }
    return radiance;
}
