// First pass where pixels share a ray: what each block of them shows of the water.
//!import surroundings/shaders/full_picture
//!import techniques/water/shaders/first

// The ray through the middle, as far as what is drawn in the whole block; where something of it is nearer than the
// water, the ray of the pixel that shows most: so every point found is seen by some pixel.
@fragment
fn fs_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let drawn = block_depths(vec2i(position.xy));
    var hit = WaterHit(WATER_NONE, 0.0, vec3f(0.0, 1.0, 0.0));
    var pick = 0u;
    for (var attempt = 0u; attempt < 2u; attempt++) {
        pick = select(0u, drawn.last, attempt == 1u);
        let ray = camera_ray(water_pixel(position.xy, pick));
        let depth = select(drawn.nearest, drawn.farthest, attempt == 1u);
        let t_max = view_depth_m(depth) / dot(ray.direction, frame.camera_forward);
        hit = water_first(ray.origin, ray.direction, t_max);
        if hit.kind != WATER_NONE || drawn.nearest == drawn.farthest {
            break;
        }
    }
    if hit.kind == WATER_NONE {
        discard;
    }
    return water_record(hit, pick);
}

// Reversed depths of what is drawn in a block; what lies below all waves counts as nothing, which hides no water
struct BlockDepths {
    nearest: f32,
    farthest: f32,
    last: u32,  // which pixel shows the farthest, from 1
}

fn block_depths(block: vec2i) -> BlockDepths {
    let last = vec2i(textureDimensions(opaque_depth)) - 1;
    var depths = BlockDepths(0.0, 2.0, 0u);
    let lowest = lowest_depth(vec2f(block));
    // Not the uniform alone, see light_count in surroundings/shaders/lights.wgsl
    let count = min(water.block.x * water.block.y, textureDimensions(opaque_depth).x);
    for (var k = 0u; k < count; k++) {
        let at = vec2i(water.block) * block + vec2i(water_block_pixel(k));
        let drawn = textureLoad(opaque_depth, min(at, last), 0);
        let depth = select(0.0, drawn, drawn > lowest);
        depths.last = select(depths.last, k + 1u, depth < depths.farthest);
        depths.farthest = min(depths.farthest, depth);
        depths.nearest = max(depths.nearest, depth);
    }
    return depths;
}

// Reversed depth, the largest in a block, of the plane below all waves: what lies beyond is seen through the water or not
// at all, so it may be drawn there or not. Linear in the picture; blocks have perspective.
fn lowest_depth(block: vec2f) -> f32 {
    let over_m = frame.camera_position.y - (water.level + water.wave_low);
    let step = 2.0 * vec2f(frame.half_extent.x * frame.camera_right.y, -frame.half_extent.y * frame.camera_up.y) / frame.size;
    let from_middle = (block + 0.5) * vec2f(water.block) + frame.jitter - 0.5 * frame.size;
    let aside = 0.5 * dot(abs(step), vec2f(water.block));
    let down = aside - frame.camera_forward.y - dot(step, from_middle);
    return select(0.0, saturate(frame.near_m * max(down, 0.0) / over_m), over_m > 0.0);
}
