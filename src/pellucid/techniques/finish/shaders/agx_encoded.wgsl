// AgX and the sRGB curve in one: srgb_encode(tone_agx(rgb)) to 1e-4, by polynomials in place of logarithm and powers.
// Their numbers are those of tools/agx_polynomials.py.
//!import optics/colour

// Stops over those of the curve, 0 to 1
fn agx_stops(rgb: vec3f) -> vec3f {
    let inset = clamp(AGX_INSET * max(rgb, vec3f(0.0)), vec3f(exp2(AGX_LOW_STOP)), vec3f(exp2(AGX_HIGH_STOP)));
    let bits = bitcast<vec3u>(inset);
    let m = bitcast<vec3f>((bits & vec3u(0x7fffffu)) | vec3u(0x3f800000u));  // in [1, 2)
    let log2_m = (((-0.081615773 * m + 0.64514215) * m - 2.1206747) * m + 4.0700903) * m - 2.5128545;
    let stops = vec3f(bits >> vec3u(23u)) - 127.0 + log2_m;
    return (stops - AGX_LOW_STOP) * (1.0 / (AGX_HIGH_STOP - AGX_LOW_STOP));
}

fn agx_encoded(rgb: vec3f) -> vec3f {
    let x = agx_stops(rgb);
    let curve = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    return gamma_to_srgb(saturate(AGX_OUTSET * curve));
}

// srgb_encode(x^2.2) for x in [0, 1]
const AGX_KNEE = 0.072721279;  // where the straight part of sRGB ends

fn gamma_to_srgb(x: vec3f) -> vec3f {
    let low = ((18.957747 * x + 6.5736305) * x - 0.022066224) * x + 3.0472132e-05;
    let high = ((((((0.55624235 * x - 2.3396029) * x + 4.1107785) * x - 3.9526699) * x + 2.3261607) * x
        - 0.95808807) * x + 1.3075407) * x - 0.050343981;
    return select(high, low, x < vec3f(AGX_KNEE));
}
