// Where a refracted ray meets a mesh, from the depth that the light's camera sees.
//!import techniques/water/shaders/caustic_cells
//!import techniques/water/shaders/caustic_ray

const CAUSTIC_STEP_TEXELS = 2.0;  // of the map, that a step crosses; rays along the camera take one step
const CAUSTIC_STEPS = 24.0;       // at most
const CAUSTIC_REFINEMENTS = 6;

// Depth of the meeting, metres. Steps find the first place where the mesh is above the ray; between that and the one
// before the depth below the ray is taken as the next guess, or the middle where it leads out of them.
fn caustic_march(ray: CausticRay) -> f32 {
    let texel_m = (water.high.x - water.low.x) / f32(caustic_side());
    let way_m = caustic.reach_m - ray.depth_m;
    let steps = clamp(ceil(length(ray.drift) * way_m / (CAUSTIC_STEP_TEXELS * texel_m)), 1.0, CAUSTIC_STEPS);
    var low = ray.depth_m;
    var high = ray.depth_m;
    for (var k = 1.0; k <= steps; k += 1.0) {
        low = high;
        high = ray.depth_m + way_m * k / steps;
        if caustic_floor(caustic_seen(ray, high)) <= high {
            break;
        }
    }
    var depth = high;
    for (var k = 0; k < CAUSTIC_REFINEMENTS; k++) {
        let below = caustic_floor(caustic_seen(ray, depth));
        if abs(below - depth) < 0.02 * texel_m {
            break;
        }
        low = select(low, depth, below > depth);
        high = select(depth, high, below > depth);
        depth = select(0.5 * (low + high), below, below > low && below < high);
    }
    return depth;
}
