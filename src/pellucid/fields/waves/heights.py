"""Waves that come as arrays of heights."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import real_array
from pellucid.fields.waves import arguments
from pellucid.fields.waves.source import Singles, WaveSource, WaveSurface, difference_slopes


class Heights(WaveSource):
    """Heights of one's own: at rest, or pictures in time with what is between them linear.

    Parameters
    ----------
    heights : (H, W) or (T, H, W) metres; x along the rows, z down them.
    tile_m : size, one number or (along x, along z), metres.
    times_s : (T,) of the pictures, rising. Before the first and after the last one the water rests.
    periodic : whether tiles repeat.
    loop : the first picture follows the last one, after as long as the last but one did.

    Raises
    ------
    SceneError : arrays of another shape, values that are not finite, times that do not rise.
    """

    kind: ClassVar[str] = "heights"

    def __init__(
        self,
        heights: npt.ArrayLike,
        tile_m: float | tuple[float, float],
        times_s: npt.ArrayLike | None = None,
        periodic: bool = False,
        loop: bool = False,
    ) -> None:
        pictures = _pictures(heights)
        self.shape = arguments.grid(pictures.shape[1:], low=2)
        self._tile = arguments.tile(tile_m)
        self.periodic, self.loop = arguments.flag("periodic", periodic), arguments.flag("loop", loop)
        self.pictures = pictures
        self.times_s = _times(times_s, len(pictures))
        self._limits = float(pictures.min()), float(pictures.max())

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height of all pictures, metres."""
        return self._limits

    def _surface(self, time_s: float) -> WaveSurface:
        first, second, share = self._key(time_s)
        heights = self.pictures[first] + np.float32(share) * (self.pictures[second] - self.pictures[first])
        return WaveSurface(heights, difference_slopes(heights, self.cell, self.periodic))

    def _key(self, time_s: float) -> tuple[int, int, float]:
        """Numbers of two pictures and the share of the second; equal at all times that look alike."""
        return between(self.times_s, time_s, self.loop)


def between(times_s: npt.NDArray[np.float64], time_s: float, loop: bool) -> tuple[int, int, float]:
    """Numbers of two of several rising times around one, and the share of the second."""
    count = len(times_s)
    if count == 1:
        return 0, 0, 0.0
    if loop:
        last = times_s[-1] - times_s[-2]
        turn = times_s[-1] + last - times_s[0]
        time_s = times_s[0] + float(np.remainder(time_s - times_s[0], turn))
        if time_s >= times_s[-1]:
            return count - 1, 0, float((time_s - times_s[-1]) / last)
    place = float(np.interp(time_s, times_s, np.arange(count)))
    first = min(int(place), count - 2)
    return first, first + 1, place - first


def _pictures(heights: Any) -> Singles:
    given = real_array("heights", heights).astype(np.float32)
    if given.ndim not in (2, 3) or not given.size:
        raise SceneError("heights", f"have shape {given.shape}", "give an array (H, W), or (T, H, W) over time")
    if not np.isfinite(given).all():
        raise SceneError("heights", f"hold {np.count_nonzero(~np.isfinite(given))} values that are not finite")
    pictures = np.array(given.reshape(-1, *given.shape[-2:]))
    pictures.setflags(write=False)
    return pictures


def _times(times_s: Any, count: int) -> npt.NDArray[np.float64]:
    if times_s is None:
        if count > 1:
            raise SceneError("times_s", f"are missing for {count} pictures", "say when each of them is")
        return np.zeros(1)
    times = arguments.numbers("times_s", times_s, low=0.0)
    if len(times) != count or not (np.diff(times) > 0.0).all():
        raise SceneError("times_s", f"are {len(times)} for {count} pictures", "give one a picture, rising")
    return times
