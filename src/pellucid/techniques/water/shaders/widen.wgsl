// Third pass where pixels share a ray: each takes from the four blocks around it that show water, at their mean depth.
//!import surroundings/shaders/full_picture
//!import techniques/water/shaders/bindings

struct WaterWidened {
    @location(0) radiance: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_main(@builtin(position) position: vec4f) -> WaterWidened {
    let last = vec2i(textureDimensions(water_blocks)) - 1;
    let at = position.xy / vec2f(water.block) - 0.5;
    let low = vec2i(floor(at));
    let share = at - floor(at);
    var sum = vec4f(0.0);
    var weights = 0.0;
    var own = 0.0;  // of the block that the pixel is in
    for (var k = 0; k < 4; k++) {
        let corner = vec2i(k & 1, k >> 1);
        let shown = textureLoad(water_blocks, clamp(low + corner, vec2i(0), last), 0);
        let near = mix(1.0 - share, share, vec2f(corner));
        let weight = select(0.0, near.x * near.y, shown.a > 0.0);
        sum += weight * shown;
        weights += weight;
        own = select(own, shown.a, all(low + corner == vec2i(position.xy) / vec2i(water.block)));
    }
    let mean = sum / max(weights, 1e-6);
    let drawn = textureLoad(opaque_depth, vec2i(position.xy), 0);
    if own <= 0.0 || mean.a < drawn {
        discard;
    }
    return WaterWidened(vec4f(mean.rgb, 1.0), min(mean.a, 1.0));
}
