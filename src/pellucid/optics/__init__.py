"""The laws of light, as vectorised float64 functions; each file has a WGSL twin of the same stem."""

from pellucid.optics import attenuation, colour, dispersion, eikonal, fresnel, phase, snell
from pellucid.optics.attenuation import extinction_from_half_distance, transmittance, water_colour
from pellucid.optics.colour import (
    into_gamut,
    luminance,
    srgb_decode,
    srgb_encode,
    tone_aces,
    tone_agx,
    tone_khronos_neutral,
    tone_reinhard,
)
from pellucid.optics.dispersion import (
    RGB_LAMBDA_NM,
    CauchyCoefficients,
    abbe_number,
    cauchy,
    cauchy_from_abbe,
    sellmeier,
)
from pellucid.optics.eikonal import drift, euler_momentum, euler_position, euler_step, kick, leapfrog_step
from pellucid.optics.fresnel import (
    PolarisedReflectance,
    brewster_angle,
    fresnel_dielectric,
    fresnel_polarised,
    fresnel_schlick,
    normal_reflectance,
    schlick,
)
from pellucid.optics.phase import henyey_greenstein
from pellucid.optics.snell import RefractResult, critical_angle, reflect, refract

__all__ = [
    "RGB_LAMBDA_NM",
    "CauchyCoefficients",
    "PolarisedReflectance",
    "RefractResult",
    "abbe_number",
    "attenuation",
    "brewster_angle",
    "cauchy",
    "cauchy_from_abbe",
    "colour",
    "critical_angle",
    "dispersion",
    "drift",
    "eikonal",
    "euler_momentum",
    "euler_position",
    "euler_step",
    "extinction_from_half_distance",
    "fresnel",
    "fresnel_dielectric",
    "fresnel_polarised",
    "fresnel_schlick",
    "henyey_greenstein",
    "into_gamut",
    "kick",
    "leapfrog_step",
    "luminance",
    "normal_reflectance",
    "phase",
    "reflect",
    "refract",
    "schlick",
    "sellmeier",
    "snell",
    "srgb_decode",
    "srgb_encode",
    "tone_aces",
    "tone_agx",
    "tone_khronos_neutral",
    "tone_reinhard",
    "transmittance",
    "water_colour",
]
