// Light that refractive matter has thrown on a mesh, and light that it has kept from it, from the maps of caustics.py.
//!import surroundings/shaders/charts

struct ReceivedLight {
    caustic: vec3f,  // irradiance added
    blocked: vec3f,  // irradiance of the lamps that is missing
}

fn received_at(triangle: u32, p_ws: vec3f, view_ws: vec3f) -> ReceivedLight {
    let point = chart_point(chart_of(triangle, view_ws), p_ws);
    // Half a texel from the rim the filter would reach into the neighbouring chart.
    let at = clamp(point.at, point.low + 0.5, point.high - 0.5) / vec2f(textureDimensions(caustic_map));
    let share = select(0.0, 1.0, point.chart != 0u);
    let caustic = textureSampleLevel(caustic_map, caustic_sampler, at, 0.0).rgb;
    let blocked = textureSampleLevel(blocked_map, caustic_sampler, at, 0.0).rgb;
    return ReceivedLight(share * caustic, share * blocked);
}

// Share of the lamps' light that is missing, by channel
fn blocked_share(received: ReceivedLight, direct_irradiance: vec3f) -> vec3f {
    return saturate(received.blocked / max(direct_irradiance, vec3f(1e-30)));
}
