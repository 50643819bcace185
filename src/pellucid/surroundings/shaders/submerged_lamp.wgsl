// Lamps near by over level water: the way of least time from lamp to point, and how the surface spreads its light.

const LEAST_TIME_STEPS = 6;

// Way from a point in the water to a lamp above it
struct WetWay {
    crossing: vec3f,  // of the surface
    above: vec3f,     // unit, from there to the lamp
    below: vec3f,     // unit, from the point to the crossing
    above_m: f32,     // lengths of the two parts
    below_m: f32,
    spread_m2: f32,   // area of a steradian of the lamp's light, across the ray at the point
}

// Snell's law sin a = n sin b at a surface `height_m` under the lamp and `depth_m` over the point [born1999, 1.5.1],
// by Newton's method on the horizontal way u above the surface, kept between its bounds. A cone of sin a da dphi
// lands on x dx dphi, and dx/da = height/cos^2 a + depth/cos^2 b cos a/(n cos b).
fn submerged_way(p_ws: vec3f, lamp_ws: vec3f, level_m: f32, index: f32) -> WetWay {
    let height_m = max(lamp_ws.y - level_m, 1e-6);
    let depth_m = max(level_m - p_ws.y, 1e-6);
    let aside = lamp_ws.xz - p_ws.xz;
    let x = max(length(aside), 1e-6 * (height_m + depth_m));
    var low = 0.0;
    var high = x;
    // No ray is steeper below than the critical angle, and none bends less than close to the vertical.
    let steepest = depth_m * inverseSqrt(max(index * index - 1.0, 1e-6));
    var u = max(x * height_m * index / (height_m * index + depth_m), x - steepest);
    for (var k = 0; k < LEAST_TIME_STEPS; k++) {
        let a = sqrt(u * u + height_m * height_m);
        let b = sqrt((x - u) * (x - u) + depth_m * depth_m);
        let error = u / a - index * (x - u) / b;
        low = select(low, u, error < 0.0);
        high = select(u, high, error < 0.0);
        let rise = height_m * height_m / (a * a * a) + index * depth_m * depth_m / (b * b * b);
        let next = u - error / rise;
        u = select(0.5 * (low + high), next, next >= low && next <= high);
    }
    let towards = aside / x;
    let crossing = vec3f(lamp_ws.x - u * towards.x, level_m, lamp_ws.z - u * towards.y);
    let to_lamp = vec3f(u * towards.x, height_m, u * towards.y);
    let to_crossing = vec3f((x - u) * towards.x, depth_m, (x - u) * towards.y);
    let above_m = length(to_lamp);
    let below_m = length(to_crossing);
    let above = to_lamp / above_m;
    let below = to_crossing / below_m;
    let sine = max(u / above_m, 1e-12);
    let stretch = height_m / (above.y * above.y) + depth_m * above.y / (below.y * below.y * index * below.y);
    return WetWay(crossing, above, below, above_m, below_m, x / sine * stretch * below.y);
}
