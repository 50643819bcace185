"""Linear Rec.709 colour: sRGB encoding, luminance and tone curves. Twin of ``colour.wgsl``.

Every tone curve takes scene-referred linear Rec.709, exposure applied, and returns
display-referred linear Rec.709 in [0, 1]; :func:`srgb_encode` comes after. Negative input is
treated as 0 by the tone curves.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Colour = NDArray[np.float64]

_LUMINANCE: Final = np.array([0.2126, 0.7152, 0.0722])
_ACES_INPUT: Final = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
_ACES_OUTPUT: Final = np.array(
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]]
)
_AGX_INSET: Final = np.array(
    [
        [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
        [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
        [0.0423756549057051, 0.0784336, 0.879142973793104],
    ]
)
_AGX_OUTSET: Final = np.array(
    [
        [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
        [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
        [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
    ]
)
_AGX_STOPS: Final = (-12.47393, 4.026069)
_AGX_CURVE: Final = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)
_AGX_DISPLAY_GAMMA: Final = 2.2


def srgb_encode(linear: ArrayLike) -> Colour:
    """Linear to sRGB-encoded values, the inverse of :func:`srgb_decode` [iec61966].

    Parameters
    ----------
    linear : (...), linear values, 1 is display white; the straight part continues below 0, the power above 1.

    Returns
    -------
    (...), encoded values.
    """
    linear = np.asarray(linear, float)
    curved = 1.055 * np.maximum(linear, 0.0) ** (1.0 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curved)


def srgb_decode(encoded: ArrayLike) -> Colour:
    """sRGB-encoded to linear values [iec61966].

    Parameters
    ----------
    encoded : (...), encoded values, 1 is display white.

    Returns
    -------
    (...), linear values.
    """
    encoded = np.asarray(encoded, float)
    curved = (np.maximum(encoded + 0.055, 0.0) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, encoded / 12.92, curved)


def luminance(rgb: ArrayLike) -> Colour:
    """Relative luminance of linear Rec.709, 0.2126 R + 0.7152 G + 0.0722 B [itu2015, 3.2].

    Parameters
    ----------
    rgb : (..., 3), linear.

    Returns
    -------
    (...), 1 for (1, 1, 1).
    """
    return np.asarray(rgb, float) @ _LUMINANCE


def into_gamut(rgb: ArrayLike) -> Colour:
    """Colours that a screen can show in place of those it cannot: mixed with grey as bright, until nothing is negative.

    Luminance is kept, and so is the hue, as far as straight lines to white in a chromaticity diagram keep it.

    Parameters
    ----------
    rgb : (..., 3), linear; what has no luminance becomes black.

    Returns
    -------
    (..., 3), >= 0; colours within the gamut unchanged.
    """
    rgb = np.asarray(rgb, float)
    grey = np.maximum(luminance(rgb), 0.0)[..., None]
    low = rgb.min(axis=-1, keepdims=True)
    share = np.where(low < 0.0, grey / np.where(low < 0.0, grey - low, 1.0), 1.0)
    return np.where(low < 0.0, np.maximum(grey + share * (rgb - grey), 0.0), rgb)


def tone_reinhard(rgb: ArrayLike) -> Colour:
    """L/(1 + L) [reinhard2002, eq. 3], on each channel, so that saturated light stays in the gamut.

    Parameters
    ----------
    rgb : (..., 3), linear, scene-referred.

    Returns
    -------
    (..., 3), linear, in [0, 1).
    """
    light = np.maximum(np.asarray(rgb, float), 0.0)
    return light / (1.0 + light)


def tone_aces(rgb: ArrayLike) -> Colour:
    """ACES reference rendering and sRGB output transforms, fitted [hill2017].

    A rational curve between two matrices; about 0.1 of scene grey 0.18 comes out, as in the original.

    Parameters
    ----------
    rgb : (..., 3), linear, scene-referred.

    Returns
    -------
    (..., 3), linear, in [0, 1].
    """
    v = np.maximum(np.asarray(rgb, float), 0.0) @ _ACES_INPUT.T
    curve = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return np.clip(curve @ _ACES_OUTPUT.T, 0.0, 1.0)


def tone_agx(rgb: ArrayLike) -> Colour:
    """AgX with its default contrast [sobotka2022], the curve as a polynomial [wrensch2023].

    Inset matrix, logarithm over 16.5 stops, curve, outset matrix, display gamma 2.2 undone.

    Parameters
    ----------
    rgb : (..., 3), linear, scene-referred.

    Returns
    -------
    (..., 3), linear, in [0, 1].
    """
    inset = np.maximum(np.asarray(rgb, float), 0.0) @ _AGX_INSET.T
    low, high = _AGX_STOPS
    stops = np.clip(np.log2(np.maximum(inset, 1e-10)), low, high)
    curve = np.polyval(_AGX_CURVE, (stops - low) / (high - low))
    return np.clip(curve @ _AGX_OUTSET.T, 0.0, 1.0) ** _AGX_DISPLAY_GAMMA


def tone_khronos_neutral(rgb: ArrayLike) -> Colour:
    """PBR Neutral: true colours below a knee at 0.8, compressed and desaturated above [khronos2024].

    Parameters
    ----------
    rgb : (..., 3), linear, scene-referred.

    Returns
    -------
    (..., 3), linear, in [0, 1].
    """
    f90, knee, desaturation = 0.04, 0.8 - 0.04, 0.15
    light = np.maximum(np.asarray(rgb, float), 0.0)
    low = light.min(axis=-1, keepdims=True)
    shifted = light - np.where(low <= 2.0 * f90, low - low**2 / (4.0 * f90), f90)
    peak = np.maximum(shifted.max(axis=-1, keepdims=True), knee)
    new_peak = 1.0 - (1.0 - knee) ** 2 / (peak + 1.0 - 2.0 * knee)
    share = 1.0 / (desaturation * (peak - new_peak) + 1.0)
    compressed = shifted * (new_peak / peak) * share + new_peak * (1.0 - share)
    return np.where(peak > knee, compressed, shifted)
