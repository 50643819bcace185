// BRDFs given as tables, one a layer, and the share of light that each sends back; written by brdf_tables.py.

// Rows 0 to BRDF_ROWS - 1: half angle pi/2 (row / last)^2; columns: difference angle pi/2 column / last. Below them a row of what
// the lobe sends back, by cosine of view (rgb; a: its GGX alpha), and one of what scatters as matt matter does (rgb).
// Layer 0 is not a table but what a GGX lobe sends back: rows by roughness, columns by cosine of view.
@group(0) @binding(5) var brdf_tables: texture_2d_array<f32>;
@group(0) @binding(6) var brdf_sampler: sampler;

const BRDF_ROWS = 128.0;     // brdf_tables.ROWS
const BRDF_COLUMNS = 64.0;   // brdf_tables.COLUMNS

// x, y in 0..1 between the first and the last node of the table
fn brdf_texel(layer: u32, x: f32, y: f32) -> vec4f {
    let at = vec2f(saturate(x) * (BRDF_COLUMNS - 1.0) + 0.5, saturate(y) * (BRDF_ROWS - 1.0) + 0.5);
    return textureSampleLevel(brdf_tables, brdf_sampler, at / vec2f(BRDF_COLUMNS, BRDF_ROWS + 2.0), layer, 0.0);
}

fn brdf_row(layer: u32, row: f32, x: f32) -> vec4f {
    let at = vec2f(saturate(x) * (BRDF_COLUMNS - 1.0) + 0.5, row + 0.5);
    return textureSampleLevel(brdf_tables, brdf_sampler, at / vec2f(BRDF_COLUMNS, BRDF_ROWS + 2.0), layer, 0.0);
}

// f_r, 1/sr, by half and difference angle [rusinkiewicz1998]; all vectors unit, away from the surface
fn tabulated_brdf(layer: u32, n: vec3f, v: vec3f, l: vec3f) -> vec3f {
    let h = normalize(v + l);
    let half_angle = atan2(length(cross(n, h)), dot(n, h));
    let difference_angle = atan2(length(cross(v, h)), dot(v, h));
    return brdf_texel(layer, difference_angle / 1.57079633, sqrt(half_angle / 1.57079633)).rgb;
}

// Share of the light from everywhere that the table's lobe sends to the viewer; a: GGX alpha of a lobe as wide
fn table_lobe_albedo(layer: u32, n_dot_v: f32) -> vec4f {
    return brdf_row(layer, BRDF_ROWS, n_dot_v);
}

fn table_matt_albedo(layer: u32) -> vec3f {
    return brdf_row(layer, BRDF_ROWS + 1.0, 0.0).rgb;
}

// Share of light that GGX facets send back after one reflection; what a second one would, is added in proportion [kulla2017]
fn ggx_directional_albedo(n_dot_v: f32, roughness: f32) -> f32 {
    return brdf_texel(0u, n_dot_v, roughness).x;
}
