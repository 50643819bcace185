"""Crystals. The birefringent ones are stated by their ordinary ray, and hold the extraordinary one."""

from __future__ import annotations

from typing import Final

from pellucid.media.formulas import Formula, PowerSeries, Sellmeier
from pellucid.media.medium import Medium, extraordinary_name

_resonances = Sellmeier.of_resonances
# A table of polycrystalline ice is taken for the mean over directions, (2 n_o + n_e)/3.
_ICE_MEAN: Final = 1.299861
_ICE_BIREFRINGENCE: Final = 0.0014


def _crystal(
    name: str, source: str, formula: Formula, low_nm: float, high_nm: float, extraordinary: Formula | None = None
) -> Medium:
    """`source` is that of both rays."""
    ray = None
    if extraordinary is not None:
        ray = Medium(extraordinary_name(name), "crystal", source, extraordinary, (low_nm, high_nm))
    return Medium(name, "crystal", source, formula, (low_nm, high_nm), extraordinary=ray)


MEDIA: Final[tuple[Medium, ...]] = (
    _crystal("diamond", "[peter1923]", _resonances((0.3306, 4.3356), (0.175, 0.106)), 226.0, 760.0),
    _crystal(
        "sapphire",
        "[malitson1972]",
        _resonances((1.431349, 0.6505471, 5.341402), (0.0726631, 0.1193242, 18.02825)),
        200.0,
        5000.0,
        _resonances((1.503976, 0.5506914, 6.592738), (0.0740288, 0.1216529, 20.07225)),
    ),
    _crystal(
        "quartz",
        "[ghosh1999]",
        Sellmeier((1.070441, 1.102022), (0.01005860, 100.0), 0.2860414),
        198.0,
        2053.0,
        Sellmeier((1.095099, 1.156625), (0.01021019, 100.0), 0.2885180),
    ),
    _crystal(
        "calcite",
        "[ghosh1999]",
        Sellmeier((0.9646435, 1.828315), (0.01943252, 120.0), 0.7335875),
        204.0,
        2172.0,
        Sellmeier((0.8242783, 0.1442913), (0.01066895, 120.0), 0.3585970),
    ),
    # n_o^2 = 5.913 + 0.2441/(lambda^2 - 0.0803), rewritten: B = 0.2441/0.0803, constant = 4.913 - B; n_e^2 likewise
    _crystal(
        "rutile",
        "[devore1951]",
        Sellmeier((0.2441 / 0.0803,), (0.0803,), 4.913 - 0.2441 / 0.0803),
        430.0,
        1530.0,
        Sellmeier((0.3322 / 0.0843,), (0.0843,), 6.197 - 0.3322 / 0.0843),
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
        "[dodge1984]",
        _resonances((0.4875511, 0.3987503, 2.312035), (0.04338408, 0.09461442, 23.7936)),
        200.0,
        7000.0,
        _resonances((0.41344023, 0.50497499, 2.4904862), (0.03684262, 0.09076162, 23.771995)),
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
        "[zelmon1997]",
        Sellmeier((2.6734, 1.2290, 12.614), (0.01764, 0.05914, 474.6)),
        400.0,
        5000.0,
        Sellmeier((2.9804, 0.5981, 8.9543), (0.02047, 0.0666, 416.08)),
    ),
    # Three Cauchy terms fitted to the tabulated real part, 390-740 nm: within 2.1e-4 everywhere
    Medium(
        "ice",
        "crystal",
        "266 K, our fit to the table [warren2008], which is taken for the mean; n_e - n_o = 0.0014 [hobbs1974]",
        PowerSeries(((_ICE_MEAN - _ICE_BIREFRINGENCE / 3.0, 0), (3.62385e-3, -2), (-8.18308e-5, -4))),
        (390.0, 740.0),
        (0.146, 0.0513, 0.00424),
        "imaginary part of the index [warren2008]",
        Medium(
            extraordinary_name("ice"),
            "crystal",
            "as the ordinary ray [warren2008; hobbs1974]",
            PowerSeries(((_ICE_MEAN + _ICE_BIREFRINGENCE / 1.5, 0), (3.62385e-3, -2), (-8.18308e-5, -4))),
            (390.0, 740.0),
            (0.146, 0.0513, 0.00424),
            "imaginary part of the index [warren2008]",
        ),
    ),
)

ALIASES: Final = {
    "corundum": "sapphire",
    "Al2O3": "sapphire",
    "sapphire-o": "sapphire",
    "rock crystal": "quartz",
    "crystal quartz": "quartz",
    "quartz-o": "quartz",
    "Iceland spar": "calcite",
    "calcite-o": "calcite",
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
