"""The refractive index as a function of wavelength. Twin of ``dispersion.wgsl``.

Wavelengths are in nm; coefficients are in the micrometres of the literature.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

RGB_LAMBDA_NM: Final = (611.4, 549.1, 464.3)
"""Dominant wavelengths of the primaries of sRGB: the three wavelengths that pictures are rendered at."""

LAMBDA_D_NM: Final = 587.5618
"""Helium d line: the index of a glass, unless said otherwise."""

LAMBDA_F_NM: Final = 486.1327
"""Hydrogen F line."""

LAMBDA_C_NM: Final = 656.2725
"""Hydrogen C line."""


class CauchyCoefficients(NamedTuple):
    """Coefficients of n = a + b / lambda^2.

    Attributes
    ----------
    a : (...), index at infinite wavelength.
    b_um2 : (...), um^2.
    """

    a: NDArray[np.float64]
    b_um2: NDArray[np.float64]


def cauchy(lambda_nm: ArrayLike, a: ArrayLike, b_um2: ArrayLike) -> NDArray[np.float64]:
    """Cauchy's formula, n = a + b / lambda^2 [tevs2007, eq. 3.7; born1999, 2.3.4].

    Parameters
    ----------
    lambda_nm : (...), wavelength, nm, > 0.
    a, b_um2 : (...), coefficients; b in um^2.

    Returns
    -------
    (...), index.
    """
    lambda_um = np.asarray(lambda_nm, float) * 1e-3
    return np.asarray(a, float) + np.asarray(b_um2, float) / lambda_um**2


def sellmeier(lambda_nm: ArrayLike, b: ArrayLike, c_um2: ArrayLike) -> NDArray[np.float64]:
    """Sellmeier's formula, n^2 = 1 + sum b_i lambda^2 / (lambda^2 - c_i) [sellmeier1871].

    Parameters
    ----------
    lambda_nm : (...), wavelength, nm, away from the resonances sqrt(c).
    b : (..., K), strengths.
    c_um2 : (..., K), squares of the resonance wavelengths, um^2.

    Returns
    -------
    (...), index.
    """
    squared = (np.asarray(lambda_nm, float)[..., None] * 1e-3) ** 2
    terms = np.asarray(b, float) * squared / (squared - np.asarray(c_um2, float))
    return np.sqrt(1.0 + np.sum(terms, axis=-1))


def abbe_number(n_d: ArrayLike, n_f: ArrayLike, n_c: ArrayLike) -> NDArray[np.float64]:
    """Abbe number, V = (n_d - 1)/(n_F - n_C) [born1999, 4.7.1].

    Parameters
    ----------
    n_d, n_f, n_c : (...), indices at the d, F and C lines, n_f > n_c.

    Returns
    -------
    (...), large where dispersion is weak.
    """
    n_d, n_f, n_c = (np.asarray(n, float) for n in (n_d, n_f, n_c))
    return (n_d - 1.0) / (n_f - n_c)


def cauchy_from_abbe(n_d: ArrayLike, abbe: ArrayLike) -> CauchyCoefficients:
    """Cauchy coefficients that have a given index and Abbe number [born1999, 2.3.4 and 4.7.1].

    Two equations, a + b/lambda_d^2 = n_d and b (1/lambda_F^2 - 1/lambda_C^2) = (n_d - 1)/V.

    Parameters
    ----------
    n_d : (...), index at the d line, > 1.
    abbe : (...), Abbe number, > 0.

    Returns
    -------
    CauchyCoefficients for :func:`cauchy`.
    """
    d, f, c = LAMBDA_D_NM * 1e-3, LAMBDA_F_NM * 1e-3, LAMBDA_C_NM * 1e-3
    n_d = np.asarray(n_d, float)
    b_um2 = (n_d - 1.0) / (np.asarray(abbe, float) * (f**-2 - c**-2))
    return CauchyCoefficients(n_d - b_um2 / d**2, b_um2)
