// Linear Rec.709 colour. Tone curves take scene-referred linear light, exposure applied, and return
// display-referred linear light in [0, 1]; srgb_encode comes after. Twin of colour.py.

// Linear to sRGB-encoded [iec61966]
fn srgb_encode(linear: vec3f) -> vec3f {
    let curved = 1.055 * pow(max(linear, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return select(curved, 12.92 * linear, linear <= vec3f(0.0031308));
}

// sRGB-encoded to linear [iec61966]
fn srgb_decode(encoded: vec3f) -> vec3f {
    let curved = pow(max(encoded + 0.055, vec3f(0.0)) / 1.055, vec3f(2.4));
    return select(curved, encoded / 12.92, encoded <= vec3f(0.04045));
}

// Relative luminance [itu2015, 3.2]
fn luminance(rgb: vec3f) -> f32 {
    return dot(rgb, vec3f(0.2126, 0.7152, 0.0722));
}

// Mixed with grey as bright, until no component is negative
fn into_gamut(rgb: vec3f) -> vec3f {
    let grey = vec3f(max(luminance(rgb), 0.0));
    let low = min(rgb.x, min(rgb.y, rgb.z));
    let share = grey.x / max(grey.x - low, 1e-30);
    return select(rgb, max(grey + share * (rgb - grey), vec3f(0.0)), low < 0.0);
}

// L/(1 + L) [reinhard2002, eq. 3], on each channel
fn tone_reinhard(rgb: vec3f) -> vec3f {
    let light = max(rgb, vec3f(0.0));
    return light / (1.0 + light);
}

// ACES reference rendering and sRGB output transforms, fitted [hill2017]; matrices by columns
const ACES_INPUT = mat3x3f(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
const ACES_OUTPUT = mat3x3f(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);

fn tone_aces(rgb: vec3f) -> vec3f {
    let v = ACES_INPUT * max(rgb, vec3f(0.0));
    let curve = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return saturate(ACES_OUTPUT * curve);
}

// AgX, default contrast [sobotka2022], the curve as a polynomial [wrensch2023]; matrices by columns
const AGX_INSET = mat3x3f(
    0.842479062253094, 0.0423282422610123, 0.0423756549057051,
    0.0784335999999992, 0.878468636469772, 0.0784336,
    0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const AGX_OUTSET = mat3x3f(
    1.19687900512017, -0.0528968517574562, -0.0529716355144438,
    -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
    -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
const AGX_LOW_STOP = -12.47393;
const AGX_HIGH_STOP = 4.026069;

fn tone_agx(rgb: vec3f) -> vec3f {
    let inset = max(AGX_INSET * max(rgb, vec3f(0.0)), vec3f(1e-10));
    let stops = clamp(log2(inset), vec3f(AGX_LOW_STOP), vec3f(AGX_HIGH_STOP));
    let x = (stops - AGX_LOW_STOP) / (AGX_HIGH_STOP - AGX_LOW_STOP);
    let curve = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    return pow(saturate(AGX_OUTSET * curve), vec3f(2.2));
}

// PBR Neutral: true colours below a knee at 0.8, compressed and desaturated above [khronos2024]
const NEUTRAL_F90 = 0.04;
const NEUTRAL_KNEE = 0.76;
const NEUTRAL_DESATURATION = 0.15;

fn tone_khronos_neutral(rgb: vec3f) -> vec3f {
    let light = max(rgb, vec3f(0.0));
    let low = min(light.r, min(light.g, light.b));
    let shifted = light - select(NEUTRAL_F90, low - low * low / (4.0 * NEUTRAL_F90), low <= 2.0 * NEUTRAL_F90);
    let peak = max(shifted.r, max(shifted.g, shifted.b));
    if peak <= NEUTRAL_KNEE {
        return shifted;
    }
    let new_peak = 1.0 - (1.0 - NEUTRAL_KNEE) * (1.0 - NEUTRAL_KNEE) / (peak + 1.0 - 2.0 * NEUTRAL_KNEE);
    let share = 1.0 / (NEUTRAL_DESATURATION * (peak - new_peak) + 1.0);
    return shifted * (new_peak / peak) * share + new_peak * (1.0 - share);
}
