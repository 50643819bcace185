"""Matter and bodies of the photon tracer: shapes whose surfaces are met by formula, in float64."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pellucid.optics.eikonal import Field

Array = NDArray[np.float64]
Triple = tuple[float, float, float]
BLACK: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Matter:
    """What fills a body.

    n : index, or a field: positions (P, 3) to index (P,) and its gradient (P, 3), 1/m.
    absorption, scattering : (3,) coefficients, 1/m; or, with a field, positions (P, 3) to (P, 3).
    anisotropy : mean cosine of scattering.
    opaque : light that arrives is absorbed.
    """

    n: float | Field = 1.0
    absorption: Triple | Callable[[Array], Array] = BLACK
    scattering: Triple = BLACK
    anisotropy: float = 0.0
    opaque: bool = False

    @property
    def graded(self) -> bool:
        """Whether rays have to be followed step by step."""
        return callable(self.n) or callable(self.absorption)

    def index(self, x: Array) -> Array:
        """Index at (P, 3)."""
        return self.n(x)[0] if callable(self.n) else np.full(len(x), float(self.n))

    def slope(self, x: Array) -> tuple[Array, Array]:
        """Index (P,) and its gradient (P, 3) at (P, 3)."""
        return self.n(x) if callable(self.n) else (self.index(x), np.zeros_like(x))

    def extinction(self, x: Array) -> Array:
        """Absorption and scattering at (P, 3): (P, 3), 1/m."""
        absorbed = self.absorption(x) if callable(self.absorption) else np.broadcast_to(self.absorption, x.shape)
        return np.asarray(absorbed, np.float64) + np.asarray(self.scattering)


class Body(Protocol):
    """A convex shape of one matter."""

    matter: Matter

    def interval(self, x: Array, d: Array) -> tuple[Array, Array]:
        """Where lines x + t d, (P, 3) each, enter and leave, (P,) each; enter > leave where they miss."""
        ...

    def normal(self, x: Array) -> Array:
        """Outward unit normals at points on the surface, (P, 3)."""
        ...


def _quadratic(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    """Roots of a t^2 + 2 b t + c, the smaller first; (inf, -inf) where there are none."""
    square = b * b - a * c
    root = np.sqrt(np.maximum(square, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.where(b > 0.0, c / (-b - root), (root - b) / a)
        near = np.where(b > 0.0, (-b - root) / a, c / (root - b))
    miss = (square <= 0.0) | (a <= 0.0)
    return np.where(miss, np.inf, near), np.where(miss, -np.inf, far)


@dataclass(frozen=True)
class Sphere:
    """A ball of `radius` metres about `centre`."""

    radius: float
    matter: Matter
    centre: Triple = (0.0, 0.0, 0.0)

    def interval(self, x: Array, d: Array) -> tuple[Array, Array]:
        """See `Body`."""
        o = x - np.asarray(self.centre)
        return _quadratic((d * d).sum(1), (o * d).sum(1), (o * o).sum(1) - self.radius**2)

    def normal(self, x: Array) -> Array:
        """See `Body`."""
        return (x - np.asarray(self.centre)) / self.radius


@dataclass(frozen=True)
class Cylinder:
    """An endless cylinder of `radius` metres through `centre` along one axis (0 x, 1 y, 2 z)."""

    radius: float
    matter: Matter
    axis: int = 1
    centre: Triple = (0.0, 0.0, 0.0)

    def _across(self, v: Array) -> Array:
        return v * (np.arange(3) != self.axis)

    def interval(self, x: Array, d: Array) -> tuple[Array, Array]:
        """See `Body`."""
        o, d = self._across(x - np.asarray(self.centre)), self._across(d)
        return _quadratic((d * d).sum(1), (o * d).sum(1), (o * o).sum(1) - self.radius**2)

    def normal(self, x: Array) -> Array:
        """See `Body`."""
        return self._across(x - np.asarray(self.centre)) / self.radius


@dataclass(frozen=True)
class Convex:
    """The points with normals . x <= offsets: `normals` (K, 3) unit, `offsets` (K,) metres."""

    normals: Array
    offsets: Array
    matter: Matter

    @classmethod
    def box(cls, size: Triple, matter: Matter, centre: Triple = BLACK) -> Convex:
        """A box with edges `size`, metres, about `centre`."""
        normals = np.concatenate([np.eye(3), -np.eye(3)])
        return cls(normals, normals @ np.asarray(centre) + np.tile(0.5 * np.asarray(size), 2), matter)

    def interval(self, x: Array, d: Array) -> tuple[Array, Array]:
        """Slabs [kay1986]; see `Body`."""
        rate, room = d @ self.normals.T, self.offsets - x @ self.normals.T
        with np.errstate(divide="ignore", invalid="ignore"):
            t = room / rate
        near = np.where(rate < 0.0, t, -np.inf).max(1)
        far = np.where(rate > 0.0, t, np.inf).min(1)
        outside = ((rate == 0.0) & (room < 0.0)).any(1) | (near >= far)
        return np.where(outside, np.inf, near), np.where(outside, -np.inf, far)

    def normal(self, x: Array) -> Array:
        """See `Body`."""
        return self.normals[np.argmax(x @ self.normals.T - self.offsets, axis=1)]
