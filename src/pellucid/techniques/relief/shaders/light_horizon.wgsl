// Shadow of the solid layer from a map of its horizon, found beforehand.
//!import techniques/relief/shaders/frame

// Elevation of the lamp over the horizon that was found beforehand [max1988; timonen2006, 2.4.2]
fn relief_horizon_shadow(ray: ReliefRay, radius: f32) -> f32 {
    let way = ray.duv * relief.tile_m;
    let rise = ray.dh / max(length(way), 1e-9);
    let turn = atan2(way.y, way.x) / 6.28318531;
    let count = i32(textureNumLayers(horizon_map));
    let at = (turn - floor(turn)) * f32(count);
    let low = i32(floor(at));
    let uv = vec2f(ray.uv.x, 1.0 - ray.uv.y);  // row 0 of a map is its top
    let first = textureSampleLevel(horizon_map, height_sampler, uv, low % count, 0.0).r;
    let second = textureSampleLevel(horizon_map, height_sampler, uv, (low + 1) % count, 0.0).r;
    let over = atan(rise) - atan(mix(first, second, at - f32(low)));
    return disc_share(over / max(atan(radius), 1e-3));
}

// Share of a disc over a straight edge at x radii below its middle
fn disc_share(x: f32) -> f32 {
    let at = clamp(x, -1.0, 1.0);
    return saturate(0.5 + (at * sqrt(1.0 - at * at) + asin(at)) / 3.14159265);
}
