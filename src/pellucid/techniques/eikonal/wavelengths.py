"""What wavelengths a volume is drawn at, and which share of each colour a draw is worth.

A draw follows rays with the index of one wavelength and carries red, green and blue along them. Its weights, a 3x3
matrix that the colour it has found is multiplied with, say what of that colour is light of this wavelength. The
weights of all draws sum to the identity: matter without dispersion looks the same however many there are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pellucid.techniques.eikonal.prepare import Prepared

EVERY_COLOUR = np.eye(3)
CHANNELS = tuple(np.diag(row) for row in np.eye(3))
"""Three wavelengths: each keeps its own colour and nothing else."""

Draw = tuple[int, np.ndarray]


def draws_of(prepared: Prepared) -> list[Draw]:
    """The draws of one volume: the number of the channel in `prepared.channels`, and the weights (3, 3).

    One without dispersion, three for red, green and blue; colour out = weights @ colour found.
    """
    count = len(prepared.channels)
    return [(0, EVERY_COLOUR)] if count == 1 else list(enumerate(CHANNELS))
