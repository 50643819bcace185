"""Diffuse light through the translucent layer, as tables for the shaders; see `techniques.diffuse_light`."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from pellucid.techniques.diffuse_light import diffuse_shares
from pellucid.techniques.relief.layouts import DIFFUSE_ENTRIES


@lru_cache(maxsize=16)
def diffuse_tables(n_outside: float, n_layer: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """`diffuse_shares` at `DIFFUSE_ENTRIES` values of exp(-absorption depth) from 0 to 1, by channel.

    Parameters
    ----------
    n_outside, n_layer : indices; that of the layer for red, green, blue.

    Returns
    -------
    down, back : (DIFFUSE_ENTRIES, 4) float32, the last column unused.
    """
    y = np.linspace(0.0, 1.0, DIFFUSE_ENTRIES)
    down, back = np.zeros((DIFFUSE_ENTRIES, 4)), np.zeros((DIFFUSE_ENTRIES, 4))
    for channel, n in enumerate(np.asarray(n_layer, float) / n_outside):
        down[:, channel], back[:, channel] = diffuse_shares(float(n), y)
    return down.astype(np.float32), back.astype(np.float32)
