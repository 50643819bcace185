// The GGX microfacet lobe. alpha = roughness^2; all cosines are positive.

const GGX_PI = 3.14159265358979;

// Normal distribution [walter2007, eq. 33], 1/sr
fn ggx_distribution(n_dot_h: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
    return a2 / (GGX_PI * d * d);
}

// Height-correlated Smith shadowing over 4 (n.l)(n.v) [heitz2014, eq. 99]
fn ggx_visibility(n_dot_l: f32, n_dot_v: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2);
    let l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2);
    return 0.5 / (v + l);
}

// Reflectance at grazing incidence: full for every real dielectric, gone as f0 goes to 0 [lagarde2014, sec. 3.1]
fn grazing_reflectance(f0: f32) -> f32 {
    return saturate(50.0 * f0);
}

// Fresnel term [schlick1994, eq. 15]
fn lobe_fresnel(cosine: f32, f0: f32) -> f32 {
    let x = 1.0 - saturate(cosine);
    return f0 + (grazing_reflectance(f0) - f0) * x * x * x * x * x;
}

// Share of light from everywhere that the lobe sends to the viewer, fitted [karis2014]
fn ggx_albedo(n_dot_v: f32, roughness: f32, f0: f32) -> f32 {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    let fit = vec2f(-1.04, 1.04) * a + r.zw;
    return saturate(f0 * fit.x + grazing_reflectance(f0) * fit.y);
}
