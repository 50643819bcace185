"""The CIE 1931 standard observer, and the daylight that white stands for."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers = NDArray[np.float64]

_PRIMARIES_XY: Final = np.array([[0.640, 0.330], [0.300, 0.600], [0.150, 0.060]])
"""Chromaticities of red, green and blue [itu2015, 1.3]."""


@cache
def _table() -> Numbers:
    """(81, 5): wavelength, x-bar, y-bar, z-bar, D65; every 5 nm."""
    text = files("pellucid.spectra").joinpath("cie.csv").read_text(encoding="utf-8")
    return np.array([[float(v) for v in line.split(",")] for line in text.splitlines()[2:]])


@cache
def _curves() -> Any:
    from scipy.interpolate import PchipInterpolator

    table = _table()
    return PchipInterpolator(table[:, 0], table[:, 1:], extrapolate=False)


def _at(lambda_nm: ArrayLike) -> Numbers:
    """(..., 4) x-bar, y-bar, z-bar, D65."""
    return np.nan_to_num(_curves()(np.asarray(lambda_nm, float)))


def colour_matching(lambda_nm: ArrayLike) -> Numbers:
    """Colour matching functions of the 2 degree observer [cie2019a].

    Parameters
    ----------
    lambda_nm : (...), wavelength, nm; 0 outside of 380 to 780.

    Returns
    -------
    (..., 3), x-bar, y-bar and z-bar; the table of every 5 nm, interpolated by monotone cubics.
    """
    return _at(lambda_nm)[..., :3]


def daylight(lambda_nm: ArrayLike) -> Numbers:
    """Relative spectral power of illuminant D65 [cie2019b].

    Parameters
    ----------
    lambda_nm : (...), wavelength, nm; 0 outside of 380 to 780.

    Returns
    -------
    (...), 100 at 560 nm.
    """
    return _at(lambda_nm)[..., 3]


def rgb_of_light(lambda_nm: ArrayLike) -> Numbers:
    """Linear Rec.709 of light of one wavelength, of the power that daylight has there, per nm.

    Parameters
    ----------
    lambda_nm : (...), wavelength, nm.

    Returns
    -------
    (..., 3); integrated from 380 to 780 nm it gives (1, 1, 1). One component at least is negative nearly everywhere:
    screens cannot show pure light.
    """
    return daylight(lambda_nm)[..., None] * colour_matching(lambda_nm) @ _rgb_from_xyz().T


@cache
def _rgb_from_xyz() -> Numbers:
    """(3, 3): columns of its inverse are the primaries, as bright as together they give the daylight of the table."""
    table = _table()
    white = np.trapezoid(table[:, 1:4] * table[:, 4:], table[:, 0], axis=0)
    xyz = np.concatenate([_PRIMARIES_XY, 1.0 - _PRIMARIES_XY.sum(axis=1, keepdims=True)], axis=1).T
    return np.linalg.inv(xyz * np.linalg.solve(xyz, white))
