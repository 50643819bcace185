// Where scattered light goes. Twin of phase.py.

// Henyey-Greenstein per steradian [henyey1941, eq. 2], (1-g^2)/(4 pi (1+g^2-2g cos)^1.5): integral 1,
// mean cosine g, g in (-1, 1). The bracket as (1-|g|)^2 + 2|g|(1 -+ cos) cancels at neither peak.
fn henyey_greenstein(cos_theta: f32, g: f32) -> f32 {
    let width = 1.0 - abs(g);
    let bracket = width * width + 2.0 * abs(g) * (1.0 - sign(g) * cos_theta);
    return (1.0 - g) * (1.0 + g) / (12.566371 * bracket * sqrt(bracket));
}
