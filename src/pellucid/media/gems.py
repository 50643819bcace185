"""Gemstones: index and fire from gemmology, colours representative of good stones.

A stone varies more than any table. Of the birefringent ones in this table only tourmaline states both rays.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from pellucid.media.crystals import MEDIA as _CRYSTALS
from pellucid.media.formulas import Formula, PowerSeries
from pellucid.media.medium import Medium, extraordinary_name

Triple = tuple[float, float, float]

_BY_NAME: Final = {crystal.name: crystal for crystal in _CRYSTALS}

# name, n_d, dispersion from B to G, absorption (1/m)
_GEMS: Final[tuple[tuple[str, float, float, Triple], ...]] = (
    ("emerald", 1.577, 0.014, (350.0, 50.0, 250.0)),
    ("aquamarine", 1.577, 0.014, (40.0, 8.0, 4.0)),
    ("topaz", 1.619, 0.014, (0.0, 0.0, 0.0)),
    ("blue topaz", 1.619, 0.014, (50.0, 12.0, 5.0)),
    ("peridot", 1.654, 0.020, (60.0, 20.0, 150.0)),
    ("garnet", 1.790, 0.024, (60.0, 700.0, 600.0)),
    ("zircon", 1.925, 0.039, (0.0, 0.0, 0.0)),
)

# name, the crystal it is, absorption (1/m)
_COLOURED_CRYSTALS: Final[tuple[tuple[str, str, Triple], ...]] = (
    ("ruby", "sapphire", (30.0, 600.0, 350.0)),
    ("blue sapphire", "sapphire", (500.0, 300.0, 30.0)),
    ("amethyst", "quartz", (100.0, 300.0, 80.0)),
    ("citrine", "quartz", (5.0, 20.0, 120.0)),
    ("smoky quartz", "quartz", (60.0, 90.0, 140.0)),
    ("red spinel", "spinel", (30.0, 500.0, 400.0)),
)


def _gem(name: str, source: str, formula: Formula, valid_nm: tuple[float, float], absorption: Triple) -> Medium:
    note = "representative" if any(absorption) else "treated as clear"
    return Medium(name, "gem", source, formula, valid_nm, absorption, note)


def _tabled(name: str, n_d: float, fire: float, absorption: Triple) -> Medium:
    source = "representative values of gemmology [read2005], two-term Cauchy"
    return _gem(name, source, PowerSeries.from_fire(n_d, fire), (400.0, 700.0), absorption)


def _coloured(name: str, crystal: str, absorption: Triple) -> Medium:
    base = _BY_NAME[crystal]
    gem = _gem(name, f"index of {crystal}: {base.source}", base.formula, base.valid_nm, absorption)
    if base.extraordinary is None:
        return gem
    other = base.extraordinary
    ray = _gem(extraordinary_name(name), gem.source, other.formula, other.valid_nm, absorption)
    return replace(gem, extraordinary=ray)


def _pleochroic(name: str, n_o: float, n_e: float, fire: float, of_o: Triple, of_e: Triple) -> Medium:
    """A stone whose colour depends on the polarisation."""
    return replace(_tabled(name, n_o, fire, of_o), extraordinary=_tabled(extraordinary_name(name), n_e, fire, of_e))


MEDIA: Final[tuple[Medium, ...]] = (
    *(_tabled(*row) for row in _GEMS),
    *(_coloured(*row) for row in _COLOURED_CRYSTALS),
    # Strongly coloured tourmaline nearly quenches the ordinary ray: plates of it were the first polarisers.
    _pleochroic("tourmaline", 1.644, 1.624, 0.017, (900.0, 480.0, 780.0), (250.0, 40.0, 200.0)),
    _gem(
        "amber",
        "representative index [read2005] and Abbe number (ours, of a resin), two-term Cauchy",
        PowerSeries.from_abbe(1.540, 40.0),
        (400.0, 700.0),
        (15.0, 60.0, 300.0),
    ),
)

ALIASES: Final = {"beryl": "emerald", "almandine": "garnet", "olivine": "peridot"}
