"""What a relief asks of heights that change with time."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt


@runtime_checkable
class DynamicHeights(Protocol):
    """A height field in motion, such as `fields.waves.Ripples` or `fields.drops.Drops`.

    The heights at a time do not depend on the times that were asked for before: a film may be drawn at any rate, and
    a picture of it again.

    Attributes
    ----------
    shape : (H, W) texels; row 0 is the top, v = 1 - (j + 0.5) / H.
    tile_m : size along u and v, metres.
    limits_m : (lowest, highest) height that `advance` ever gives, metres.
    """

    @property
    def shape(self) -> tuple[int, int]: ...

    @property
    def tile_m(self) -> tuple[float, float]: ...

    @property
    def limits_m(self) -> tuple[float, float]: ...

    def advance(self, time_s: float) -> npt.NDArray[np.float32]:
        """(H, W) float32 heights in metres at a time, seconds from the start; it may be earlier than the last."""
        ...
