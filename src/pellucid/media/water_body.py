"""Matter that absorbs and scatters by wavelength, as natural waters do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.errors import SceneError
from pellucid.media.medium import CLEAR, RGB_LAMBDA_NM, Medium, checked_absorption

PARTICLE_ASYMMETRY: Final = 0.924
"""Mean cosine of the average phase function that [petzold1972] measured on particles [mobley1994, 3.8].

A Henyey-Greenstein function with this mean cosine scatters 1.7 % of the light backwards, Petzold's 1.8 %.
"""


@dataclass(frozen=True)
class WaterBody(Medium):
    """A medium whose absorption, scattering and phase function are known by wavelength.

    Parameters
    ----------
    lambda_nm : where the tables have their entries, nm, rising; linear between them.
    absorption_table_per_m, scattering_table_per_m : extinctions at these wavelengths, 1/m.
    asymmetry_table : mean cosine of the phase function at these wavelengths.
    scattering_source : where the scattering comes from.

    The other parameters are those of :class:`Medium`. Made by :func:`from_tables` and :func:`water_body`.
    """

    lambda_nm: tuple[float, ...] = ()
    absorption_table_per_m: tuple[float, ...] = ()
    scattering_table_per_m: tuple[float, ...] = ()
    asymmetry_table: tuple[float, ...] = ()
    scattering_source: str = "treated as clear"

    def absorption(self, lambda_nm: ArrayLike) -> NDArray[np.float64]:
        """Extinction by absorption at wavelengths in nm, 1/m; same shape.

        Raises
        ------
        SceneError : for a wavelength outside of the table.
        """
        return self._table(lambda_nm, self.absorption_table_per_m)

    def scattering(self, lambda_nm: ArrayLike) -> NDArray[np.float64]:
        """Extinction by scattering at wavelengths in nm, 1/m; same shape. Raises as :meth:`absorption`."""
        return self._table(lambda_nm, self.scattering_table_per_m)

    def mean_cosine(self, lambda_nm: ArrayLike) -> NDArray[np.float64]:
        """Mean cosine of the phase function at wavelengths in nm; same shape. Raises as :meth:`absorption`."""
        return self._table(lambda_nm, self.asymmetry_table)

    @property
    def scattering_rgb_per_m(self) -> NDArray[np.float64]:
        """Extinction by scattering at the three channels, 1/m, (3,)."""
        return self.scattering(RGB_LAMBDA_NM)

    @property
    def asymmetry(self) -> float:
        """Mean cosine of all the light that the three channels scatter."""
        strength = self.scattering_rgb_per_m
        total = float(strength.sum())
        return float(strength @ self.mean_cosine(RGB_LAMBDA_NM)) / total if total > 0.0 else 0.0

    def with_absorption(
        self,
        rgb_per_m: Sequence[float],
        name: str | None = None,
        extraordinary_rgb_per_m: Sequence[float] | None = None,
    ) -> WaterBody:
        """The same index and scattering with another colour, known at the three channels only."""
        coloured = super().with_absorption(rgb_per_m, name, extraordinary_rgb_per_m)
        g = self.mean_cosine(RGB_LAMBDA_NM)
        return _of_channels(coloured, self.scattering_rgb_per_m, g, self.scattering_source)

    def _table(self, lambda_nm: ArrayLike, values: Sequence[float]) -> NDArray[np.float64]:
        at = np.asarray(lambda_nm, float)
        low, high = self.lambda_nm[0], self.lambda_nm[-1]
        inside = (at >= low) & (at <= high)
        if not np.all(inside):
            worst = at[~inside].flat[0]
            known = f"it is known from {low:g} to {high:g} nm"
            raise SceneError("lambda_nm", f"{worst:g} nm is outside of the table of {self.name}", known)
        return np.asarray(np.interp(at, self.lambda_nm, values))


def from_tables(
    name: str,
    base: Medium,
    lambda_nm: ArrayLike,
    absorption_per_m: ArrayLike,
    scattering_per_m: ArrayLike,
    mean_cosine: ArrayLike,
    source: str,
    scattering_source: str,
) -> WaterBody:
    """A body of water with the index of `base`; tables (K,) over rising wavelengths in nm."""
    at = np.asarray(lambda_nm, float)
    tables = [
        np.broadcast_to(np.asarray(t, float), at.shape) for t in (absorption_per_m, scattering_per_m, mean_cosine)
    ]
    red, green, blue = np.interp(RGB_LAMBDA_NM, at, tables[0]).tolist()
    a, b, g = (tuple(table.tolist()) for table in tables)
    low, high = base.valid_nm
    return WaterBody(
        name, "water", base.source, base.formula, (max(low, float(at[0])), min(high, float(at[-1]))),
        (red, green, blue), source, None, tuple(at.tolist()), a, b, g, scattering_source,
    )  # fmt: skip


def water_body(
    absorption_rgb_per_m: Sequence[float] = CLEAR,
    scattering_rgb_per_m: Sequence[float] = CLEAR,
    asymmetry: float = PARTICLE_ASYMMETRY,
    base: str | Medium | float = "water",
    name: str | None = None,
) -> WaterBody:
    """A liquid of your own that absorbs and scatters.

    Parameters
    ----------
    absorption_rgb_per_m, scattering_rgb_per_m : extinctions at the three channels, 1/m.
    asymmetry : mean cosine of the phase function, -1 < g < 1; 0 scatters evenly, 0.924 as particles in the sea do.
    base : what has the index: a name, a Medium or a number.
    name : how it is called in messages.

    Raises
    ------
    SceneError : for anything but three finite values >= 0, an asymmetry out of range, an unknown base.
    """
    from pellucid.media.catalogue import resolve

    clear = resolve(base, "base")
    coloured = clear.with_absorption(absorption_rgb_per_m, name or f"{clear.name}, of your own")
    if not -1.0 < asymmetry < 1.0:
        raise SceneError("asymmetry", f"{asymmetry!r} is no mean cosine", "give a number between -1 and 1")
    try:
        scattering = np.array(checked_absorption(scattering_rgb_per_m))
    except SceneError as error:
        raise SceneError("scattering_rgb_per_m", error.reason, error.remedy) from None
    return _of_channels(coloured, scattering, np.full(3, float(asymmetry)), "given by the user")


def _of_channels(
    coloured: Medium, scattering: NDArray[np.float64], mean_cosine: NDArray[np.float64], source: str
) -> WaterBody:
    """Tables of three entries: blue, green and red."""
    entries = (np.array(RGB_LAMBDA_NM), coloured.absorption_rgb_per_m, scattering, mean_cosine)
    at, a, b, g = (tuple(values[::-1].tolist()) for values in entries)
    return WaterBody(
        coloured.name, "water", coloured.source, coloured.formula, coloured.valid_nm, coloured.absorption_per_m,
        coloured.absorption_source, None, at, a, b, g, source,
    )  # fmt: skip
