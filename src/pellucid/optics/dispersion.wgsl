// The refractive index as a function of wavelength (nm; coefficients in micrometres).
// Twin of dispersion.py.

struct CauchyCoefficients {
    a: f32,      // index at infinite wavelength
    b_um2: f32,
}

// Dominant wavelengths of the primaries of sRGB
const RGB_LAMBDA_NM = vec3f(611.4, 549.1, 464.3);
// Helium d, hydrogen F and C lines
const LAMBDA_D_NM = 587.5618;
const LAMBDA_F_NM = 486.1327;
const LAMBDA_C_NM = 656.2725;

// n = a + b / lambda^2 [tevs2007, eq. 3.7; born1999, 2.3.4]
fn cauchy(lambda_nm: f32, a: f32, b_um2: f32) -> f32 {
    let lambda_um = lambda_nm * 1e-3;
    return a + b_um2 / (lambda_um * lambda_um);
}

// n^2 = 1 + sum b_i lambda^2 / (lambda^2 - c_i), three terms [sellmeier1871]
fn sellmeier(lambda_nm: f32, b: vec3f, c_um2: vec3f) -> f32 {
    let lambda_um = lambda_nm * 1e-3;
    let squared = lambda_um * lambda_um;
    return sqrt(1.0 + dot(b, squared / (vec3f(squared) - c_um2)));
}

// V = (n_d - 1)/(n_F - n_C) [born1999, 4.7.1]
fn abbe_number(n_d: f32, n_f: f32, n_c: f32) -> f32 {
    return (n_d - 1.0) / (n_f - n_c);
}

// Cauchy coefficients with a given index and Abbe number [born1999, 2.3.4 and 4.7.1]
fn cauchy_from_abbe(n_d: f32, abbe: f32) -> CauchyCoefficients {
    let d = LAMBDA_D_NM * 1e-3;
    let f = LAMBDA_F_NM * 1e-3;
    let c = LAMBDA_C_NM * 1e-3;
    let b_um2 = (n_d - 1.0) / (abbe * (1.0 / (f * f) - 1.0 / (c * c)));
    return CauchyCoefficients(n_d - b_um2 / (d * d), b_um2);
}
