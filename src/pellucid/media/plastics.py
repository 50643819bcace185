"""Transparent plastics."""

from __future__ import annotations

from typing import Final

from pellucid.media.formulas import Sellmeier
from pellucid.media.medium import Medium


def _plastic(name: str, source: str, strength: float, square_um2: float, low_nm: float, high_nm: float) -> Medium:
    return Medium(name, "plastic", source, Sellmeier((strength,), (square_um2,)), (low_nm, high_nm))


MEDIA: Final[tuple[Medium, ...]] = (
    _plastic("acrylic", "PMMA, 20 C [sultanova2009]", 1.1819, 0.011313, 436.8, 1052.0),
    _plastic("polycarbonate", "20 C [sultanova2009]", 1.4182, 0.021304, 436.8, 1052.0),
    _plastic("polystyrene", "20 C [sultanova2009]", 1.4435, 0.020216, 436.8, 1052.0),
    _plastic("silicone", "PDMS, Sylgard 184 [schneider2009]", 1.0093, 0.013185, 350.0, 700.0),
)

ALIASES: Final = {
    "PMMA": "acrylic",
    "plexiglass": "acrylic",
    "perspex": "acrylic",
    "PC": "polycarbonate",
    "PS": "polystyrene",
    "PDMS": "silicone",
}
