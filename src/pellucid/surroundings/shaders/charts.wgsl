// Where on the atlas of caustics a point of a mesh lies; see charts.py.
//!import surroundings/shaders/bindings

const TABLE_CHARTS = 256u;  // charts.TABLE_CHARTS
const CHART_LEVELS = 4u;    // charts.LEVELS
const TABLE_TEXELS = 6u;    // charts.TABLE_TEXELS
const CHART_RIM = 0.02;     // texels that rounding may put a point outside its chart

struct ChartPoint {
    chart: u32,   // 0 for none
    at: vec2f,    // texels of the atlas
    low: vec2f,   // bounds of the chart, whole texels
    high: vec2f,
}

// Chart of the side of a triangle that a direction points to
fn chart_of(triangle: u32, side_ws: vec3f) -> u32 {
    let corner = bvh_triangles[triangle].corner_0;
    let n = cross(bvh_triangles[triangle].corner_1 - corner, bvh_triangles[triangle].corner_2 - corner);
    let front = triangle_attributes[triangle].chart_front;
    return select(triangle_attributes[triangle].chart_back, front, dot(n, side_ws) >= 0.0);
}

fn chart_row(chart: u32, row: u32) -> vec4f {
    let index = max(chart, 1u) - 1u;
    let texel = vec2u(index % TABLE_CHARTS * TABLE_TEXELS + row, index / TABLE_CHARTS);
    return bitcast<vec4f>(textureLoad(caustic_charts, texel, 0));
}

// Lower and upper corner of the rectangle of a chart at one of its resolutions
fn chart_bounds(chart: u32, level: u32) -> vec4f {
    return chart_row(chart, 2u + level);
}

// The same place at another resolution
fn between_levels(at: vec2f, bounds: vec4f, other: vec4f) -> vec2f {
    return other.xy + (at - bounds.xy) * (other.zw - other.xy) / (bounds.zw - bounds.xy);
}

// The point of a chart, at its finest resolution; of no chart when it is cut off there
fn chart_point(chart: u32, p_ws: vec3f) -> ChartPoint {
    let p = vec4f(p_ws, 1.0);
    let at = vec2f(dot(chart_row(chart, 0u), p), dot(chart_row(chart, 1u), p));
    let bounds = chart_bounds(chart, 0u);
    let inside = chart != 0u && all(at >= bounds.xy - CHART_RIM) && all(at <= bounds.zw + CHART_RIM);
    return ChartPoint(select(0u, chart, inside), clamp(at, bounds.xy, bounds.zw), bounds.xy, bounds.zw);
}
