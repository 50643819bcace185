"""Liquids, near room temperature."""

from __future__ import annotations

from typing import Final

from pellucid.media.formulas import Formula, PowerSeries, Sellmeier
from pellucid.media.medium import Medium

Triple = tuple[float, float, float]

_WATER: Final = Sellmeier((0.5684028, 0.1726177, 0.0208619, 0.1130749), (0.00510183, 0.01821154, 0.02620722, 10.69793))
# Table 3, linear between the entries at 610 and 620, 540 and 550, 460 and 465 nm
_WATER_ABSORPTION: Final = (0.266, 0.0557, 0.0101)
_WATER_ABSORPTION_SOURCE: Final = "pure water at the three channels [pope1997]"

# n(S, T, lambda) of [quan1995, eq. 3] at S = 35 g/kg, T = 20 C, wavelengths in um
_SEA_WATER: Final = PowerSeries(((1.3189582, 0), (0.01618766, -1), (-0.004382, -2), (0.0011455, -3)))


def _clear(name: str, source: str, formula: Formula, low_nm: float, high_nm: float) -> Medium:
    return Medium(name, "liquid", source, formula, (low_nm, high_nm))


def _representative(name: str, n_d: float, abbe: float, absorption: Triple, note: str) -> Medium:
    source = f"{note}, two-term Cauchy"
    return Medium(
        name, "liquid", source, PowerSeries.from_abbe(n_d, abbe), (400.0, 700.0), absorption, "representative"
    )


MEDIA: Final[tuple[Medium, ...]] = (
    Medium(
        "water",
        "liquid",
        "distilled, 20 C, against vacuum [daimon2007]",
        _WATER,
        (182.0, 1129.0),
        _WATER_ABSORPTION,
        _WATER_ABSORPTION_SOURCE,
    ),
    Medium(
        "sea water",
        "liquid",
        "35 g/kg salt, 20 C [quan1995, eq. 3]",
        _SEA_WATER,
        (400.0, 700.0),
        _WATER_ABSORPTION,
        _WATER_ABSORPTION_SOURCE,
    ),
    _clear("ethanol", "[sani2016]", Sellmeier((0.0165, 0.8268), (9.08, 0.01039)), 185.0, 2800.0),
    _clear("acetone", "22 C [chang2024]", Sellmeier.of_resonances((0.8144,), (0.1080,)), 400.0, 2000.0),
    _clear(
        "glycerol",
        "[gupta2022]",
        PowerSeries(((1.46004, 0), (3.949346e-3, -2), (-1.77343e-5, -4))),
        400.0,
        710.0,
    ),
    _clear(
        "benzene",
        "27 C [moutzouris2013]",
        PowerSeries(
            ((2.170185, 0), (5.9399e-4, 2), (0.02303464, -2), (-4.99485e-4, -4), (1.78796e-4, -6)), of_square=True
        ),
        450.0,
        1551.0,
    ),
    _clear(
        "toluene",
        "27 C [moutzouris2013]",
        PowerSeries(
            ((2.161659, 0), (4.95188e-4, 2), (0.02138179, -2), (5.8838e-5, -4), (8.7632e-5, -6)), of_square=True
        ),
        450.0,
        1551.0,
    ),
    _representative(
        "olive oil",
        1.469,
        55.0,
        (18.0, 15.0, 150.0),
        "index within 1.4677-1.4705 [codex1981], Abbe number representative",
    ),
    _representative(
        "honey", 1.494, 54.0, (25.0, 60.0, 200.0), "index at 17 % water [wedmore1955], Abbe number representative"
    ),
    _representative("red wine", 1.345, 55.0, (160.0, 690.0, 690.0), "representative"),
    _representative("white wine", 1.344, 55.0, (2.0, 4.0, 12.0), "representative"),
    _representative("tea", 1.334, 55.0, (30.0, 70.0, 180.0), "representative"),
    _representative("beer", 1.340, 55.0, (12.0, 25.0, 80.0), "representative"),
    _representative("apple juice", 1.350, 55.0, (5.0, 12.0, 60.0), "representative"),
)

ALIASES: Final = {
    "H2O": "water",
    "seawater": "sea water",
    "alcohol": "ethanol",
    "glycerin": "glycerol",
    "glycerine": "glycerol",
    "oil": "olive oil",
    "wine": "red wine",
}
