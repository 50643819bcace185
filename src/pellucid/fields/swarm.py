"""The drops of a moment, and those that are put on a pane by hand."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]


@dataclass
class Swarm:
    """All drops of a moment, arrays of one length.

    Attributes
    ----------
    x, y : place, metres from the upper left corner, y downwards. volume : cubic metres.
    speed : along the way, m/s. way : angle from straight down, radians.
    owed : what it has to leave behind, part of `volume`. next_trail : volume of its next trail droplet.
    shown : radius that is drawn, metres; it follows the true one.
    """

    x: Values
    y: Values
    volume: Values
    speed: Values
    way: Values
    owed: Values
    next_trail: Values
    shown: Values

    @classmethod
    def of(cls, x: npt.ArrayLike, y: npt.ArrayLike, volume: npt.ArrayLike, next_trail: npt.ArrayLike) -> Swarm:
        """Drops at rest that have just arrived."""
        parts = [np.atleast_1d(np.asarray(a, dtype=np.float64)) for a in (x, y, volume, next_trail)]
        zero = np.zeros(len(parts[0]))
        return cls(parts[0], parts[1], parts[2], zero, zero.copy(), zero.copy(), parts[3], zero.copy())

    def __len__(self) -> int:
        return len(self.x)

    def kept(self, which: npt.NDArray[np.bool_]) -> Swarm:
        """Those drops only."""
        return Swarm(*(getattr(self, f.name)[which] for f in fields(self)))

    def with_more(self, more: Swarm) -> Swarm:
        """These and others."""
        return Swarm(*(np.concatenate([getattr(self, f.name), getattr(more, f.name)]) for f in fields(self)))


@dataclass(frozen=True)
class Placed:
    """A drop that was put on the pane; see `Drops.drop`."""

    time_s: float
    x_m: float
    z_m: float
    volume_ul: float
