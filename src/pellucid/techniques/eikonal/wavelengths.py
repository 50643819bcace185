"""What wavelengths volumes are drawn at, and which share of each colour a draw is worth.

A draw follows rays with the index of one wavelength and carries red, green and blue along them. Its weights, a 3x3
matrix that the colour it has found is multiplied with, say what of that colour is light of this wavelength. The
weights of all draws sum to the identity: matter without dispersion looks the same however many there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pellucid.spectra import stratified, weights
from pellucid.techniques.eikonal.prepare import Prepared, indices_at

EVERY_COLOUR = np.eye(3)
CHANNELS = tuple(np.diag(row) for row in np.eye(3))
"""Three wavelengths: each keeps its own colour and nothing else."""

Draw = tuple[int, np.ndarray]


def draws_of(prepared: Prepared) -> list[Draw]:
    """The draws of one volume: the number of the channel in `prepared.channels`, and the weights (3, 3).

    One without dispersion, three for red, green and blue, or as many as the volume has wavelengths;
    colour out = weights @ colour found.
    """
    if is_spectral(prepared):
        return list(enumerate(weights(np.array([channel.lambda_nm for channel in prepared.channels]))))
    return list(enumerate(CHANNELS)) if prepared.dispersive else [(0, EVERY_COLOUR)]


def is_spectral(prepared: Prepared) -> bool:
    """Whether it has wavelengths of its own instead of red, green and blue."""
    return len(prepared.channels) > len(CHANNELS)


def at_sample(prepared: Prepared, sample: int) -> Prepared:
    """A spectral volume with the wavelengths of another of the pictures that are averaged.

    So few wavelengths become many, and bands of colour a spectrum. Where each wavelength has an index field of its own
    they stay what they are.
    """
    if not is_spectral(prepared) or not prepared.shares_fields:
        return prepared
    crystals = prepared.crystals
    if crystals is not None and crystals.fields is not None:
        return prepared
    lambdas_nm = stratified(len(prepared.channels), sample)
    moved = (
        replace(channel, region_n=indices_at(prepared.regions, float(lambda_nm)), lambda_nm=float(lambda_nm))
        for channel, lambda_nm in zip(prepared.channels, lambdas_nm, strict=True)
    )
    if crystals is not None:
        crystals = crystals.at(prepared.regions, lambdas_nm)
    return replace(prepared, channels=tuple(moved), crystals=crystals)


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
