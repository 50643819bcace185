"""Crystals. Of the birefringent ones each ray is a medium of its own."""

from __future__ import annotations

from typing import Final

from pellucid.media.formulas import Formula, PowerSeries, Sellmeier
from pellucid.media.medium import Medium

_resonances = Sellmeier.of_resonances


def _crystal(name: str, source: str, formula: Formula, low_nm: float, high_nm: float) -> Medium:
    return Medium(name, "crystal", source, formula, (low_nm, high_nm))


MEDIA: Final[tuple[Medium, ...]] = (
    _crystal("diamond", "[peter1923]", _resonances((0.3306, 4.3356), (0.175, 0.106)), 226.0, 760.0),
    _crystal(
        "sapphire",
        "ordinary ray [malitson1972]",
        _resonances((1.431349, 0.6505471, 5.341402), (0.0726631, 0.1193242, 18.02825)),
        200.0,
        5000.0,
    ),
    _crystal(
        "sapphire (extraordinary)",
        "extraordinary ray [malitson1972]",
        _resonances((1.503976, 0.5506914, 6.592738), (0.0740288, 0.1216529, 20.07225)),
        200.0,
        5000.0,
    ),
    _crystal(
        "quartz",
        "ordinary ray [ghosh1999]",
        Sellmeier((1.070441, 1.102022), (0.01005860, 100.0), 0.2860414),
        198.0,
        2053.0,
    ),
    _crystal(
        "quartz (extraordinary)",
        "extraordinary ray [ghosh1999]",
        Sellmeier((1.095099, 1.156625), (0.01021019, 100.0), 0.2885180),
        198.0,
        2053.0,
    ),
    _crystal(
        "calcite",
        "ordinary ray [ghosh1999]",
        Sellmeier((0.9646435, 1.828315), (0.01943252, 120.0), 0.7335875),
        204.0,
        2172.0,
    ),
    _crystal(
        "calcite (extraordinary)",
        "extraordinary ray [ghosh1999]",
        Sellmeier((0.8242783, 0.1442913), (0.01066895, 120.0), 0.3585970),
        204.0,
        2172.0,
    ),
    # n^2 = 5.913 + 0.2441/(lambda^2 - 0.0803), rewritten: B = 0.2441/0.0803, constant = 4.913 - B
    _crystal(
        "rutile",
        "ordinary ray [devore1951]",
        Sellmeier((0.2441 / 0.0803,), (0.0803,), 4.913 - 0.2441 / 0.0803),
        430.0,
        1530.0,
    ),
    _crystal(
        "cubic zirconia",
        "12 mol % yttria [wood1982]",
        _resonances((1.347091, 2.117788, 9.452943), (0.062543, 0.166739, 24.32057)),
        361.0,
        5135.0,
    ),
    _crystal(
        "fluorite",
        "24 C [malitson1963]",
        _resonances((0.5675888, 0.4710914, 3.848472), (0.05026361, 0.1003909, 34.64904)),
        230.0,
        9700.0,
    ),
    _crystal(
        "magnesium fluoride",
        "ordinary ray [dodge1984]",
        _resonances((0.4875511, 0.3987503, 2.312035), (0.04338408, 0.09461442, 23.7936)),
        200.0,
        7000.0,
    ),
    _crystal(
        "rock salt",
        "24 C [li1976]",
        Sellmeier(
            (0.19800, 0.48398, 0.38696, 0.25998, 0.08796, 3.17064, 0.30038),
            (0.050**2, 0.100**2, 0.128**2, 0.158**2, 40.50**2, 60.98**2, 120.34**2),
            0.00055,
        ),
        200.0,
        30000.0,
    ),
    _crystal("spinel", "[tropf1991]", _resonances((1.8938, 3.0755), (0.09942, 15.826)), 350.0, 5500.0),
    _crystal("YAG", "[zelmon1998]", Sellmeier((2.28200, 3.27644), (0.01185, 282.734)), 400.0, 5000.0),
    _crystal(
        "strontium titanate",
        "[bond1965]",
        _resonances((3.042143, 1.170065, 30.83326), (0.1475902, 0.2953086, 33.18606)),
        430.0,
        3800.0,
    ),
    _crystal(
        "lithium niobate",
        "ordinary ray [zelmon1997]",
        Sellmeier((2.6734, 1.2290, 12.614), (0.01764, 0.05914, 474.6)),
        400.0,
        5000.0,
    ),
    # Three Cauchy terms fitted to the tabulated real part, 390-740 nm: within 2.1e-4 everywhere
    Medium(
        "ice",
        "crystal",
        "266 K, our fit to the table [warren2008]",
        PowerSeries(((1.299861, 0), (3.62385e-3, -2), (-8.18308e-5, -4))),
        (390.0, 740.0),
        (0.146, 0.0513, 0.00424),
        "imaginary part of the index [warren2008]",
    ),
)

ALIASES: Final = {
    "corundum": "sapphire",
    "Al2O3": "sapphire",
    "sapphire-o": "sapphire",
    "sapphire-e": "sapphire (extraordinary)",
    "rock crystal": "quartz",
    "crystal quartz": "quartz",
    "quartz-o": "quartz",
    "quartz-e": "quartz (extraordinary)",
    "Iceland spar": "calcite",
    "calcite-o": "calcite",
    "calcite-e": "calcite (extraordinary)",
    "TiO2": "rutile",
    "rutile-o": "rutile",
    "zirconia": "cubic zirconia",
    "CZ": "cubic zirconia",
    "CaF2": "fluorite",
    "calcium fluoride": "fluorite",
    "MgF2": "magnesium fluoride",
    "NaCl": "rock salt",
    "halite": "rock salt",
    "SrTiO3": "strontium titanate",
    "LiNbO3": "lithium niobate",
}
