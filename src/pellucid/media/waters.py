"""Natural waters: absorption and scattering by wavelength, from 400 to 700 nm.

Three descriptions stand beside one another. Water itself absorbs as [pope1997] measured and scatters as [morel1974]
computed. Waters with plankton and dissolved matter are the bio-optical model that [morel1991] and [gordon1983] state
for a concentration of chlorophyll. Jerlov's types are what [solonenko2015] found to have their transparency; the red
they absorb is a few percent less than that of [pope1997].
"""

from __future__ import annotations

from importlib.resources import files
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.media.liquids import MEDIA as _LIQUIDS
from pellucid.media.water_body import PARTICLE_ASYMMETRY, WaterBody, from_tables

Numbers = NDArray[np.float64]

_GRID_NM: Final = np.arange(400.0, 700.1, 5.0)

# Absorption of pure water every 5 nm, 1/m [pope1997, table 3]
_PURE_PER_M: Final = np.array([
    0.00663, 0.00530, 0.00473, 0.00444, 0.00454, 0.00478, 0.00495, 0.00530, 0.00635, 0.00751, 0.00922, 0.00962,
    0.00979, 0.01011, 0.0106, 0.0114, 0.0127, 0.0136, 0.0150, 0.0173, 0.0204, 0.0256, 0.0325, 0.0396, 0.0409, 0.0417,
    0.0434, 0.0452, 0.0474, 0.0511, 0.0565, 0.0596, 0.0619, 0.0642, 0.0695, 0.0772, 0.0896, 0.1100, 0.1351, 0.1672,
    0.2224, 0.2577, 0.2644, 0.2678, 0.2755, 0.2834, 0.2916, 0.3012, 0.3108, 0.325, 0.340, 0.371, 0.410, 0.429, 0.439,
    0.448, 0.465, 0.486, 0.516, 0.559, 0.624,
])  # fmt: skip

# Absorption of phytoplankton every 10 nm, relative to that at 440 nm [prieur1981], as [mobley1994, table 3.7] has it
_CHLOROPHYLL: Final = np.array([
    0.687, 0.828, 0.913, 0.973, 1.000, 0.944, 0.917, 0.870, 0.798, 0.750, 0.668, 0.618, 0.528, 0.474, 0.416, 0.357,
    0.294, 0.276, 0.291, 0.282, 0.236, 0.252, 0.276, 0.317, 0.334, 0.356, 0.441, 0.595, 0.502, 0.329, 0.215,
])  # fmt: skip

# Scattering of water molecules at 500 nm, 1/m [morel1974], as [mobley1994, table 3.8] has it
_FRESH_500_PER_M: Final = 22.2e-4
_SEA_500_PER_M: Final = 28.8e-4

JERLOV_TYPES: Final = ("I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C")


def molecular_scattering(lambda_nm: ArrayLike, salt: bool = False) -> Numbers:
    """Scattering by the molecules of pure water or of sea water, 1/m: lambda^-4.32 [morel1974]."""
    at_500 = _SEA_500_PER_M if salt else _FRESH_500_PER_M
    return np.asarray(at_500 * (np.asarray(lambda_nm, float) / 500.0) ** -4.32)


def dissolved_absorption(lambda_nm: ArrayLike, at_440_per_m: float) -> Numbers:
    """Absorption by dissolved organic matter ("yellow substance"), 1/m [bricaud1981]: a(440) exp(-0.014 (l - 440))."""
    return np.asarray(at_440_per_m * np.exp(-0.014 * (np.asarray(lambda_nm, float) - 440.0)))


def plankton_absorption(lambda_nm: ArrayLike, chlorophyll_mg_per_m3: float) -> Numbers:
    """Absorption by water, phytoplankton and what dissolves of it, 1/m [morel1991].

    a = (a_w + 0.06 A C^0.65) (1 + 0.2 exp(-0.014 (lambda - 440))), A of [prieur1981]; from 400 to 700 nm.
    """
    at = np.asarray(lambda_nm, float)
    pigments = np.interp(at, _GRID_NM[::2], _CHLOROPHYLL)
    living = np.interp(at, _GRID_NM, _PURE_PER_M) + 0.06 * pigments * chlorophyll_mg_per_m3**0.65
    return np.asarray(living * (1.0 + dissolved_absorption(at, 0.2)))


def particle_scattering(lambda_nm: ArrayLike, chlorophyll_mg_per_m3: float) -> Numbers:
    """Scattering by plankton and its remains, 1/m [gordon1983]: 0.30 C^0.62 (550 nm / lambda)."""
    return np.asarray(0.30 * chlorophyll_mg_per_m3**0.62 * 550.0 / np.asarray(lambda_nm, float))


_FRESH: Final = next(liquid for liquid in _LIQUIDS if liquid.name == "water")
_SEA: Final = next(liquid for liquid in _LIQUIDS if liquid.name == "sea water")


def _body(name: str, salt: bool, absorption: Numbers, particles: Numbers, source: str, scattering: str) -> WaterBody:
    """Molecules scatter as much forwards as backwards; particles nearly all forwards."""
    molecules = molecular_scattering(_GRID_NM, salt)
    cosine = PARTICLE_ASYMMETRY * particles / (molecules + particles)
    base = _SEA if salt else _FRESH
    return from_tables(name, base, _GRID_NM, absorption, molecules + particles, cosine, source, scattering)


def _pure(name: str, salt: bool) -> WaterBody:
    return _body(name, salt, _PURE_PER_M, np.zeros_like(_GRID_NM), "pure water [pope1997]", "molecules [morel1974]")


def _living(name: str, salt: bool, chlorophyll: float, dissolved: float) -> WaterBody:
    """Water with chlorophyll, mg/m3, and more dissolved matter than comes of it, 1/m at 440 nm."""
    absorption = plankton_absorption(_GRID_NM, chlorophyll) + dissolved_absorption(_GRID_NM, dissolved)
    more = f", a_440 = {dissolved:g}/m of dissolved matter [bricaud1981]" if dissolved else ""
    return _body(
        name, salt, absorption, particle_scattering(_GRID_NM, chlorophyll),
        f"representative: {chlorophyll:g} mg/m3 of chlorophyll [morel1991; prieur1981]{more}",
        "molecules [morel1974] and particles [gordon1983]",
    )  # fmt: skip


def _jerlov() -> list[WaterBody]:
    """The ten types of the table, oceanic I to III and coastal 1C to 9C."""
    text = files("pellucid.media").joinpath("jerlov.csv").read_text(encoding="utf-8").splitlines()
    titles = text[2].split(",")
    rows = np.array([[float(cell or "nan") for cell in line.split(",")] for line in text[3:]])
    column = dict(zip(titles, rows.T, strict=True))
    # The gaps lie between the neighbours as the wavelengths before them do: 4 % and 30 % of the way from one to the
    # other (3 to 5 % from 575 to 650 nm, 30 to 32 % from 525 to 575 nm).
    column["a_3C"] = _filled(column["a_3C"], column["a_1C"], column["a_7C"], 0.04)
    column["a_5C"] = _filled(column["a_5C"], column["a_3C"], column["a_7C"], 0.30)
    at = column["lambda_nm"]
    molecules = molecular_scattering(at, salt=True)
    return [
        from_tables(
            f"Jerlov {t}", _SEA, at, column[f"a_{t}"], column[f"b_{t}"],
            PARTICLE_ASYMMETRY * np.maximum(1.0 - molecules / column[f"b_{t}"], 0.0),
            f"Jerlov's type {t}{_GAPS.get(t, '')} [solonenko2015]", "[solonenko2015]",
        )
        for t in JERLOV_TYPES
    ]  # fmt: skip


_GAPS: Final = {"3C": ", beyond 650 nm interpolated", "5C": ", beyond 575 nm interpolated"}


def _filled(values: Numbers, low: Numbers, high: Numbers, share: float) -> Numbers:
    return np.where(np.isnan(values), low + share * (high - low), values)


def _ink() -> WaterBody:
    dye = np.interp(_GRID_NM, (400.0, 450.0, 500.0, 580.0, 620.0, 660.0, 700.0), (160, 60, 260, 900, 1000, 700, 250))
    return from_tables(
        "blue ink", _FRESH, _GRID_NM, dye, 1.0, 0.0, "representative: thinned with water", "representative"
    )


MEDIA: Final[tuple[WaterBody, ...]] = (
    _pure("pure water", salt=False),
    _pure("pure sea water", salt=True),
    _living("clear ocean", True, 0.1, 0.0),
    _living("coastal", True, 2.0, 0.05),
    _living("clear lake", False, 0.5, 0.05),
    _living("lake", False, 3.0, 0.3),
    _living("pond", False, 15.0, 1.2),
    *_jerlov(),
    _ink(),
)

ALIASES: Final = {
    "ocean": "clear ocean",
    "coastal water": "coastal",
    "lake water": "lake",
    "pond water": "pond",
    "pool": "pure water",
    "ink": "blue ink",
} | {f"Jerlov type {t}": f"Jerlov {t}" for t in JERLOV_TYPES}
