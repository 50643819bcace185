"""Which pixels a relief can be seen in: others need not be asked."""

from __future__ import annotations

from itertools import product

import numpy as np

from pellucid.techniques.relief.frames import Hull

RIM = 2  # pixels, for jitter and rounding


def rectangle(
    hull: Hull, heights: tuple[float, float], clip_from_object: np.ndarray, size: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """Pixels (x, y, width, height) that hold the hull between two heights; None where there are none.

    Parameters
    ----------
    heights : of the hull, lowest and highest, metres. clip_from_object : (4, 4), without the scale, which the hull has.
    """
    low, high = hull.box
    reach = max(abs(heights[0]), abs(heights[1]))
    corners = np.array([*product(*zip(low - reach, high + reach, strict=True))])
    clip = np.concatenate([corners, np.ones((8, 1))], axis=1) @ clip_from_object.T
    if (clip[:, 3] <= 1e-6 * np.abs(clip).max()).any():
        return (0, 0, *size)  # the camera is beside it, or in it
    at = clip[:, :2] / clip[:, 3:]
    pixels = np.array(size) * (0.5 + 0.5 * at * (1.0, -1.0))
    first = np.clip(np.floor(pixels.min(axis=0)) - RIM, 0, size).astype(int)
    last = np.clip(np.ceil(pixels.max(axis=0)) + RIM, 0, size).astype(int)
    if (last <= first).any():
        return None
    return int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1])
