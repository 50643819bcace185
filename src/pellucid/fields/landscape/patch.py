"""Triangles that are put somewhere, turned and joined to others of their material."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError


class Patch(NamedTuple):
    """Triangles of one material.

    Attributes
    ----------
    vertices : (V, 3) metres. faces : (F, 3) rows of `vertices`, counter-clockwise from outside.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int32]

    def placed(self, at_m: npt.ArrayLike, turn_rad: float = 0.0, scale: npt.ArrayLike = 1.0) -> Patch:
        """Scaled along its axes, turned about y, then moved to `at_m`."""
        c, s = np.cos(turn_rad), np.sin(turn_rad)
        turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        return Patch(self.vertices * np.asarray(scale, float) @ turn.T + np.asarray(at_m, float), self.faces)


def joined(patches: Iterable[Patch]) -> Patch:
    """All of them as one.

    Raises
    ------
    SceneError : there are none.
    """
    parts = list(patches)
    if not parts:
        raise SceneError("patches", "are none", "give at least one")
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = np.concatenate([part.faces + offset for part, offset in zip(parts, offsets, strict=True)])
    return Patch(np.concatenate([part.vertices for part in parts]), faces.astype(np.int32))
