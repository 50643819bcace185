"""The dispersion formulas in which catalogues and papers state their measurements.

Each is a frozen set of coefficients that, called with wavelengths in micrometres, gives
the index. They hold what :mod:`pellucid.optics.dispersion` does not need for rendering: constants,
any number of resonances, any exponent, and gases, whose n - 1 would drown in the rounding of n.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Fraunhofer lines that indices and dispersions are quoted at, micrometres
LINE_D_UM, LINE_F_UM, LINE_C_UM = 0.5875618, 0.4861327, 0.6562725
LINE_B_UM, LINE_G_UM = 0.6867, 0.4308


class Formula(Protocol):
    """Maps wavelengths in micrometres to indices."""

    def __call__(self, lambda_um: Array) -> Array: ...


@dataclass(frozen=True)
class Constant:
    """An index that does not depend on wavelength."""

    index: float

    def __call__(self, lambda_um: Array) -> Array:
        """n, everywhere."""
        return np.full(lambda_um.shape, self.index)


@dataclass(frozen=True)
class Sellmeier:
    """n^2 = 1 + constant + sum strength lambda^2 / (lambda^2 - resonance^2) [sellmeier1871].

    Parameters
    ----------
    strengths : one per resonance.
    squares_um2 : squared resonance wavelengths, um^2.
    constant : what resonances far in the ultraviolet add.
    """

    strengths: tuple[float, ...]
    squares_um2: tuple[float, ...]
    constant: float = 0.0

    @classmethod
    def of_resonances(cls, strengths: Iterable[float], resonances_um: Iterable[float]) -> Sellmeier:
        """From resonance wavelengths instead of their squares, as Malitson and others print them."""
        return cls(tuple(strengths), tuple(c * c for c in resonances_um))

    def __call__(self, lambda_um: Array) -> Array:
        """Index at wavelengths in micrometres."""
        square = lambda_um**2
        terms = (b * square / (square - c) for b, c in zip(self.strengths, self.squares_um2, strict=True))
        return np.sqrt(1.0 + self.constant + sum(terms, np.zeros_like(square)))


@dataclass(frozen=True)
class PowerSeries:
    """n, or n^2, as a sum of coefficient lambda^exponent: Cauchy's formula and its relatives [born1999, 2.3.4].

    Parameters
    ----------
    terms : pairs of coefficient and exponent, for wavelengths in um.
    of_square : whether the sum is n^2.
    """

    terms: tuple[tuple[float, int], ...]
    of_square: bool = False

    @classmethod
    def through(cls, n_d: float, difference: float, blue_um: float, red_um: float) -> PowerSeries:
        """Cauchy's two terms with a given n_d and a given n(blue) - n(red).

        Glass makers quote F and C, through the Abbe number; gemmologists quote G and B.
        """
        b = difference / (blue_um**-2 - red_um**-2)
        return cls(((n_d - b / LINE_D_UM**2, 0), (b, -2)))

    @classmethod
    def from_abbe(cls, n_d: float, abbe: float) -> PowerSeries:
        """Cauchy's two terms from the Abbe number, n_F - n_C = (n_d - 1)/V [born1999, 4.7.1]."""
        return cls.through(n_d, (n_d - 1.0) / abbe, LINE_F_UM, LINE_C_UM)

    @classmethod
    def from_fire(cls, n_d: float, b_to_g: float) -> PowerSeries:
        """Cauchy's two terms from the dispersion of gemmology, n_G - n_B [read2005]."""
        return cls.through(n_d, b_to_g, LINE_G_UM, LINE_B_UM)

    def __call__(self, lambda_um: Array) -> Array:
        """Index at wavelengths in micrometres."""
        total = sum((c * lambda_um**e for c, e in self.terms), np.zeros_like(lambda_um))
        return np.sqrt(total) if self.of_square else total


@dataclass(frozen=True)
class Gas:
    """n - 1 = sum strength / (square - 1/lambda^2) [ciddor1996, eq. 1].

    Parameters
    ----------
    strengths, squares_per_um2 : one of each per term, um^-2.
    """

    strengths: tuple[float, ...]
    squares_per_um2: tuple[float, ...]

    def __call__(self, lambda_um: Array) -> Array:
        """Index at wavelengths in micrometres."""
        wavenumber_squared = lambda_um**-2.0
        terms = (b / (c - wavenumber_squared) for b, c in zip(self.strengths, self.squares_per_um2, strict=True))
        return 1.0 + sum(terms, np.zeros_like(lambda_um))
