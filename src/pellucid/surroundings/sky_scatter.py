"""What water scatters of the sky into each direction, once: the sum over Snell's window with the phase function.

For a viewer who looks along v, light from the direction d in the water is scattered by the angle between them. Of all
of it together three things are told for each v: how much a metre of the way gains, the mean cosine of the angle, and
the mean way that the light has come for each metre of depth, both weighted with what is gained.
"""

from __future__ import annotations

import numpy as np

from pellucid.optics import fresnel_dielectric, henyey_greenstein
from pellucid.surroundings.layouts import SCATTER_AROUND, SCATTER_DOWN

DARKEST = 1e-30
WINDOW = (24, 48)  # directions of the window that are summed: from its middle to its rim, and around


def window_light(pixels: np.ndarray, n: float, irradiance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions (K, 3) to the sky in the water, space of the environment, and the light (K, 3) from each.

    Parameters
    ----------
    pixels : (H, W, 3) radiance, row 0 towards +Y. n : index of the water. irradiance : (3,) that all of it gives to a
        level surface.
    """
    rim = np.arcsin(min(1.0 / n, 1.0))
    theta = rim * (np.arange(WINDOW[0]) + 0.5) / WINDOW[0]
    phi = 2.0 * np.pi * (np.arange(WINDOW[1]) + 0.5) / WINDOW[1] - np.pi
    t, p = (part.ravel() for part in np.meshgrid(theta, phi, indexing="ij"))
    ways = np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], axis=1)
    outer = np.arcsin(np.minimum(n * np.sin(t), 1.0))
    rows, columns = pixels.shape[:2]
    row = np.minimum((outer / np.pi * rows).astype(int), rows - 1)
    column = ((0.5 + p / (2.0 * np.pi)) * columns).astype(int) % columns
    share = (1.0 - fresnel_dielectric(np.cos(outer), 1.0, n)) * np.sin(t)
    light = pixels[row, column] * share[:, None]
    level = (light * ways[:, 1:2]).sum(axis=0)
    return ways, light * np.where(level > 0.0, irradiance / np.maximum(level, 1e-30), 0.0)


def scatter_table(ways: np.ndarray, light: np.ndarray, asymmetry: float) -> np.ndarray:
    """(SCATTER_DOWN, SCATTER_AROUND, 4) float32 by direction of view, space of the environment.

    Red, green and blue: binary logarithm of the sum of light times phase function, 1/sr, which is steep past the rim of
    the window and evener so; both means in the bits of two half floats. Rows go
    from looking up to looking down, columns as those of an environment.
    """
    theta = np.pi * np.arange(SCATTER_DOWN) / (SCATTER_DOWN - 1)
    phi = 2.0 * np.pi * (np.arange(SCATTER_AROUND) + 0.5) / SCATTER_AROUND - np.pi
    t, p = (part.ravel() for part in np.meshgrid(theta, phi, indexing="ij"))
    views = np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], axis=1)
    cosine = np.clip(views @ ways.T, -1.0, 1.0)
    gained = henyey_greenstein(cosine, asymmetry)
    table = np.zeros((len(views), 4), np.float32)
    table[:, :3] = np.log2(np.maximum(gained @ light, DARKEST))
    weight = gained * light.mean(axis=1)
    total = np.maximum(weight.sum(axis=1), 1e-30)
    means = np.stack([(weight * cosine).sum(axis=1) / total, (weight / ways[:, 1]).sum(axis=1) / total], axis=1)
    table[:, 3] = np.ascontiguousarray(means.astype(np.float16)).view(np.float32)[:, 0]
    return table.reshape(SCATTER_DOWN, SCATTER_AROUND, 4)
