// What stands for bodies of water where rays of other things meet them: the level surface, and borders where no mesh
// stands.
//!import surroundings/shaders/submersion

const ACROSS_FAR = 1e30;
const ACROSS_AIR = -1;  // in place of the number of a water

struct WaterEdge {
    t: f32,        // ACROSS_FAR where a ray meets none
    normal: vec3f, // unit, towards where the ray comes from
    behind: i32,   // number of the water behind it, or ACROSS_AIR
    splits: bool,  // by Snell and Fresnel; rays go straight out through cuts, as if the index fell off smoothly there
}

// The water whose level is the lowest above a point, but for one
fn across_water_at(p_ws: vec3f, but: i32) -> i32 {
    var found = ACROSS_AIR;
    var lowest = ACROSS_FAR;
    for (var k = 0u; k < MAX_WATERS; k++) {
        let level = submersion.level[k].x;
        let within = submerged_within(k, p_ws) && p_ws.y < level;
        if within && level < lowest && i32(k) != but {
            found = i32(k);
            lowest = level;
        }
    }
    return found;
}

// The first edge on a ray that begins in a water, or in air. One that begins in air below a level is in the trough of a
// wave, and meets the water that it came from no more while it rises.
fn across_water_edge(origin_ws: vec3f, direction_ws: vec3f, water: i32) -> WaterEdge {
    var edge = WaterEdge(ACROSS_FAR, vec3f(0.0, 1.0, 0.0), water, false);
    let tiny = vec3f(1e-20);
    let d = select(direction_ws, select(-tiny, tiny, direction_ws >= vec3f(0.0)), abs(direction_ws) < tiny);
    for (var k = 0u; k < MAX_WATERS; k++) {
        let bounds = submersion.bounds[k];
        let height = submersion.level[k].x - origin_ws.y;
        let a = (bounds.xy - origin_ws.xz) / d.xz;
        let b = (bounds.zw - origin_ws.xz) / d.xz;
        let low = min(a, b);
        let high = max(a, b);
        var enters = max(low.x, low.y);
        var leaves = min(high.x, high.y);
        var near_n = select(vec3f(0.0, 0.0, -sign(d.z)), vec3f(-sign(d.x), 0.0, 0.0), low.x > low.y);
        var far_n = vec3f(0.0, 1.0, 0.0);
        var own = false;
        if SUBMERGED_OUTLINES {
            own = submersion.shape[k].x > 0.5;
            let way = submerged_outline(k, origin_ws, direction_ws);
            enters = select(enters, way.near, own);
            leaves = select(leaves, way.far, own);
            near_n = select(near_n, way.near_n, own);
            far_n = select(far_n, way.far_n, own);
        }
        let top = height / d.y;
        if i32(k) == water {
            let through = d.y > 0.0 && top <= leaves;
            let t = max(select(leaves, top, through), 0.0);
            if t < edge.t {
                let out = select(far_n, vec3f(0.0, 1.0, 0.0), through);
                edge = WaterEdge(t, -out, ACROSS_AIR, through || own);
            }
        } else if water == ACROSS_AIR && enters < leaves {
            let falls = d.y < 0.0 && height < 0.0 && top >= enters && top <= leaves;
            let aside = !falls && enters > 0.0 && enters * d.y < height;
            let t = select(enters, top, falls);
            if (falls || aside) && t < edge.t {
                edge = WaterEdge(t, select(near_n, vec3f(0.0, 1.0, 0.0), falls), i32(k), true);
            }
        }
    }
    if water != ACROSS_AIR && !edge.splits && edge.t < ACROSS_FAR {
        edge.behind = across_water_at(origin_ws + edge.t * direction_ws + 1e-4 * direction_ws, water);
    }
    return edge;
}
