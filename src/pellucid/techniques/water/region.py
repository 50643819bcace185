"""Which part of the picture a body of water may cover: pixels beyond it are not searched."""

from __future__ import annotations

import numpy as np

NEAR = 1e-6  # of w, what counts as in front of the camera
Rectangle = tuple[int, int, int, int]


def covered(
    low: tuple[float, float],
    high: tuple[float, float],
    top_m: float,
    clip: np.ndarray,
    size: tuple[int, int],
    floor_m: float = -np.inf,
) -> Rectangle:
    """Pixels (left, top, width, height) that see a rectangle, or what is right below it; width or height 0 for none.

    Parameters
    ----------
    low, high : corners (x, z) of the rectangle, metres. top_m : its height.
    clip : (4, 4) clip from world. size : of the picture, pixels. floor_m : height that nothing of it is below.
    """
    plan = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    corners = np.array([(x, top_m, z, 1.0) for x, z in plan]) @ clip.T
    down = np.array([0.0, -1.0, 0.0, 0.0]) @ clip.T
    edges = [(a, b - a, 1.0) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    if np.isfinite(floor_m):
        floor = np.array([(x, floor_m, z, 1.0) for x, z in plan]) @ clip.T
        edges += [(a, b - a, 1.0) for a, b in zip(floor, np.roll(floor, -1, axis=0), strict=True)]
        edges += [(a, b - a, 1.0) for a, b in zip(corners, floor, strict=True)]
    else:
        edges += [(corner, down, np.inf) for corner in corners]
    points = np.array([point for edge in edges for point in _seen(*edge)])
    if not len(points):
        return 0, 0, 0, 0
    ndc = np.clip(points[:, :2] / np.maximum(np.abs(points[:, 3:]), NEAR), -2.0, 2.0)
    width, height = size
    left, right = np.clip((ndc[:, 0].min() + 1.0, ndc[:, 0].max() + 1.0), 0.0, 2.0) * 0.5 * width
    top, bottom = np.clip((1.0 - ndc[:, 1].max(), 1.0 - ndc[:, 1].min()), 0.0, 2.0) * 0.5 * height
    first = max(int(left) - 1, 0), max(int(top) - 1, 0)
    last = min(int(np.ceil(right)) + 1, width), min(int(np.ceil(bottom)) + 1, height)
    return (*first, last[0] - first[0], last[1] - first[1])


def _seen(start: np.ndarray, way: np.ndarray, reach: float) -> list[np.ndarray]:
    """Ends of what is in front of the camera of an edge start + s way, 0 <= s <= reach."""
    ends = [start] if start[3] > NEAR else []
    if np.isinf(reach):
        # A point at infinity, which is a direction: parallel rays see it endlessly far off
        ends += [way] if way[3] > NEAR else [start + 1e9 * way] if way[3] == 0.0 and start[3] > NEAR else []
    elif start[3] + way[3] > NEAR:
        ends.append(start + way)
    cut = (NEAR - start[3]) / way[3] if way[3] != 0.0 else -1.0
    return [*ends, start + cut * way] if 0.0 < cut < reach else ends
