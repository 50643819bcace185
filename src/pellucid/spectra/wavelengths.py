"""Colours taken apart into wavelengths and put together again.

A colour (r, g, b) is taken for the spectrum D65 (r B_r + g B_g + b B_b). The three B are smooth, lie between 0 and 1,
add up to 1, and have the colours of the primaries [mallett2019]. At wavelengths lambda_k, each of which stands for its
share of the visible range, the eye sees of this c_k (b_k . (r, g, b)), with c_k the colour of light of wavelength
lambda_k and b_k the three B there. So the weights of one wavelength are the matrix c_k b_k^T.
"""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np

from pellucid.spectra.observer import Numbers, rgb_of_light

SHORTEST_NM: Final = 400.0
LONGEST_NM: Final = 700.0
"""0.3 % of the light of a white thing lies outside, and is counted as if it lay inside."""

# Samples of the primaries' spectra, and how much more their colour counts than their smoothness.
_SAMPLES: Final = 60
_COLOUR_OVER_SMOOTHNESS: Final = 1e3
_GOLDEN: Final = 0.5 * (np.sqrt(5.0) - 1.0)


def stratified(count: int, sample: int = 0) -> Numbers:
    """Wavelengths that divide the visible range evenly.

    Parameters
    ----------
    count : how many.
    sample : 0 for the middles of the intervals; others lie elsewhere in them, all together evenly.

    Returns
    -------
    (count,) rising, nm.
    """
    at = (0.5 + sample * _GOLDEN) % 1.0
    return SHORTEST_NM + (LONGEST_NM - SHORTEST_NM) * (np.arange(count) + at) / count


def weights(lambda_nm: Numbers) -> Numbers:
    """What each wavelength contributes to a colour: colour out = sum over k of weights[k] @ colour in.

    Parameters
    ----------
    lambda_nm : (K,) wavelengths that divide the visible range evenly, four or more.

    Returns
    -------
    (K, 3, 3), each of rank 1: its columns have the colour of light of that wavelength. They sum to the identity.
    A sum over few wavelengths would be a little off that. The spectra of the primaries take up the difference,
    changed as little as possible (least squares); from 8 wavelengths on they stay above -0.03.
    """
    count = len(lambda_nm)
    colours = rgb_of_light(lambda_nm) * ((LONGEST_NM - SHORTEST_NM) / count)
    shares = _primaries(lambda_nm)
    missing = np.eye(3) - colours.T @ shares
    shares = shares + colours @ np.linalg.solve(colours.T @ colours, missing)
    return colours[:, :, None] * shares[:, None, :]


def _primaries(lambda_nm: Numbers) -> Numbers:
    """(K, 3) spectra of red, green and blue, relative to daylight."""
    at = stratified(_SAMPLES)
    return np.stack([np.interp(lambda_nm, at, spectrum) for spectrum in _smoothest_primaries()], axis=-1)


@cache
def _smoothest_primaries() -> Numbers:
    """(3, samples) the smoothest spectra between 0 and 1 that have the colours of the primaries [mallett2019, 3]."""
    from scipy.optimize import lsq_linear

    one, each = np.eye(3), np.eye(_SAMPLES)
    colours = rgb_of_light(stratified(_SAMPLES)).T * ((LONGEST_NM - SHORTEST_NM) / _SAMPLES)
    rows = [
        np.kron(one, np.diff(each, axis=0)),
        _COLOUR_OVER_SMOOTHNESS * np.kron(one, colours),
        _COLOUR_OVER_SMOOTHNESS * np.hstack([each] * 3),
    ]
    wanted = np.concatenate([one.ravel(), np.ones(_SAMPLES)]) * _COLOUR_OVER_SMOOTHNESS
    target = np.concatenate([np.zeros(len(rows[0])), wanted])
    found = lsq_linear(np.vstack(rows), target, bounds=(0.0, 1.0))
    return found.x.reshape(3, _SAMPLES)
