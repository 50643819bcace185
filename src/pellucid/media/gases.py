"""Gases, and nothing at all."""

from __future__ import annotations

import math
from typing import Final

from pellucid.media.formulas import Constant, Gas
from pellucid.media.medium import Medium

MEDIA: Final[tuple[Medium, ...]] = (
    Medium("vacuum", "gas", "1, by definition", Constant(1.0), (0.0, math.inf)),
    Medium(
        "air",
        "gas",
        "dry, 15 C, 101.325 kPa, 450 ppm of CO2 [ciddor1996, eq. 1]",
        Gas((0.05792105, 0.00167917), (238.0185, 57.362)),
        (230.0, 1690.0),
    ),
)

ALIASES: Final[dict[str, str]] = {"empty": "vacuum", "nothing": "vacuum"}
