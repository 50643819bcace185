"""What wavelengths volumes are drawn at, and which share of each colour a draw is worth.

A draw follows rays with the index of one wavelength and carries red, green and blue along them. Its weights, a 3x3
matrix that the colour it has found is multiplied with, say what of that colour is light of this wavelength. The
weights of all draws sum to the identity: matter without dispersion looks the same however many there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pellucid.spectra import weights

if TYPE_CHECKING:
    from pellucid.techniques.eikonal.prepare import Prepared

EVERY_COLOUR = np.eye(3)
CHANNELS = tuple(np.diag(row) for row in np.eye(3))
"""Three wavelengths: each keeps its own colour and nothing else."""

Draw = tuple[int, np.ndarray]


def draws_of(prepared: Prepared) -> list[Draw]:
    """The draws of one volume: the number of the channel in `prepared.channels`, and the weights (3, 3).

    One without dispersion, three for red, green and blue, or as many as the volume has wavelengths;
    colour out = weights @ colour found.
    """
    lambdas_nm = [channel.lambda_nm for channel in prepared.channels]
    if len(lambdas_nm) == 1:
        return [(0, EVERY_COLOUR)]
    if len(lambdas_nm) == len(CHANNELS):
        return list(enumerate(CHANNELS))
    return list(enumerate(weights(np.array(lambdas_nm))))


def common_draws(volumes: Sequence[Prepared]) -> list[tuple[tuple[int, ...], np.ndarray]]:
    """The draws of volumes that are looked through together: for each volume its channel, and the weights.

    The volume with the most wavelengths decides; the others take their nearest.
    """
    most = max(volumes, key=lambda volume: len(volume.channels))
    rows = []
    for number, matrix in draws_of(most):
        at = most.channels[number].lambda_nm
        nearest = (min(range(len(v.channels)), key=lambda k: abs(v.channels[k].lambda_nm - at)) for v in volumes)
        rows.append((tuple(nearest), matrix))
    return rows
