"""What makes ripples: things that fall in, and things that float along a path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import real_array


@dataclass(frozen=True)
class Disturbance:
    """A place at which the surface is pressed down at a time; see `Ripples.drop`."""

    time_s: float
    x_m: float
    z_m: float
    radius_m: float
    strength_m: float


@dataclass(frozen=True)
class Push:
    """Something that floats, such as a boat or a ball, and its way; see `Ripples.push`.

    times_s : when it is at the places `path_m` (x, z); it goes straight between them, and is eased in and out over
    `ease_s`.
    """

    times_s: tuple[float, ...]
    path_m: tuple[tuple[float, float], ...]
    radius_m: float
    strength_m: float
    ease_s: float

    def at(self, time_s: float) -> tuple[float, float, float]:
        """x, z and the depth of its dent at rest at a time, metres; the depth is 0 before and after."""
        x, z = (float(np.interp(time_s, self.times_s, line)) for line in zip(*self.path_m, strict=True))
        near = min(time_s - self.times_s[0], self.times_s[-1] - time_s) / self.ease_s
        share = min(max(near, 0.0), 1.0)
        return x, z, self.strength_m * share * share * (3.0 - 2.0 * share)


def places_of(path_m: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """(N, 2) places (x, z) of a path, metres.

    Raises
    ------
    SceneError : it is no list of finite pairs.
    """
    path = real_array("path_m", path_m).astype(np.float64)
    if path.ndim != 2 or path.shape[1] != 2 or not len(path) or not np.isfinite(path).all():
        raise SceneError("path_m", f"has shape {path.shape}", "give (N, 2) finite places (x, z)")
    return path
