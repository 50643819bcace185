"""Base colour maps of all meshes as layers of one texture array."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pellucid.surroundings.resample import area_resample

MAX_SIZE = 2048


def stack_maps(maps: Sequence[np.ndarray | None]) -> tuple[list[np.ndarray], list[int]]:
    """Bring maps to one square power-of-two size and build their blurred levels.

    Parameters
    ----------
    maps : per mesh an (H, W, 3 or 4) linear map, or None. A map that several meshes share is kept once.

    Returns
    -------
    levels : list of (layers, size, size, 4) float16, finest first; one white texel when there is no map.
    layers : layer of each mesh, -1 for none.
    """
    unique: dict[int, np.ndarray] = {id(m): m for m in maps if m is not None}
    if not unique:
        return [np.ones((1, 1, 1, 4), np.float16)], [-1] * len(maps)
    place = {key: k for k, key in enumerate(unique)}
    size = _common_size(list(unique.values()))
    level = np.stack([_fitted(m, size) for m in unique.values()])
    levels = [level.astype(np.float16)]
    while level.shape[1] > 1:
        half = level.shape[1] // 2
        level = np.stack([area_resample(layer, (half, half)) for layer in level])
        levels.append(level.astype(np.float16))
    return levels, [-1 if m is None else place[id(m)] for m in maps]


def _common_size(maps: list[np.ndarray]) -> int:
    largest = max(max(m.shape[:2]) for m in maps)
    return min(MAX_SIZE, 1 << int(np.ceil(np.log2(largest))))


def _fitted(image: np.ndarray, size: int) -> np.ndarray:
    rgb = area_resample(np.ascontiguousarray(image[..., :3], np.float32), (size, size))
    return np.concatenate([rgb, np.ones((size, size, 1), np.float32)], axis=2)
