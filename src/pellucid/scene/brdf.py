"""How a boundary spreads the light that it mirrors: a rough GGX surface, or a table of measured values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.placement import Value, store

# A table may send back this much more than arrives before it is refused: what sampling of a lobe costs.
ALBEDO_SLACK = 1.02


@dataclass(frozen=True)
class GGX(Value):
    """A rough boundary of microfacets [walter2007].

    Fresnel says how much is mirrored, the lobe into which directions; nothing of it is lost, at any roughness.

    Parameters
    ----------
    roughness : 0 (a mirror) to 1; the lobe's alpha is its square. Used where the volume has no `reflection`.
    tint : share of the mirrored light that is kept, per channel, 0 to 1. Used where the volume has no `reflection`.

    Raises
    ------
    SceneError : a value out of range.
    """

    roughness: float = 0.3
    tint: checks.Vector = (1.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        store(
            self,
            roughness=checks.number("ggx.roughness", self.roughness, low=0.0, high=1.0),
            tint=checks.color("ggx.tint", self.tint, high=1.0),
        )


@dataclass(frozen=True, eq=False)
class TabulatedBRDF(Value):
    """An isotropic BRDF, given on half and difference angles [rusinkiewicz1998], without its Fresnel factor.

    What a boundary mirrors is Fresnel's share of what arrives [tevs2007, eq. 5.4], and the table says where it goes
    [tevs2007, eq. 5.8]; what the table does not send back is absorbed. Reciprocity follows from the angles.

    Parameters
    ----------
    values : (H, D, 3), H and D at least 2, in 1/sr, >= 0. Row i is the half angle (between the normal and the bisector
        of light and view) pi/2 (i / (H - 1))^2, so that rows lie dense where lobes are sharp; column j the
        difference angle (between light and bisector) pi/2 j / (D - 1). Interpolated linearly.

    Raises
    ------
    SceneError : wrong shape, negative or infinite values, or more light sent back than arrives, seen from some side.
    """

    values: npt.NDArray[np.float32] = field(repr=False)

    def __post_init__(self) -> None:
        values = checks.array("brdf.values", self.values, (None, None, 3))
        if min(values.shape[:2]) < 2:
            raise SceneError("brdf.values", f"has shape {values.shape}", "give at least 2 half and 2 difference angles")
        if float(values.min()) < 0.0:
            raise SceneError("brdf.values", f"has {float(values.min()):g}", "use 0 or more")
        store(self, values=values)
        most = float(self.albedo(np.linspace(0.1, 1.0, 10)).max())
        if most > ALBEDO_SLACK:
            raise SceneError("brdf.values", f"sends back {most:.3g} times what arrives", f"multiply by {1 / most:.3g}")

    @classmethod
    def from_function(
        cls, f: Callable[[np.ndarray, np.ndarray], np.ndarray], shape: tuple[int, int] = (128, 64)
    ) -> Self:
        """A table of `f(half_angle, difference_angle)` in radians, giving (H, D, 3) or (H, D), 1/sr."""
        half, difference = np.meshgrid(
            0.5 * np.pi * np.linspace(0.0, 1.0, shape[0]) ** 2, np.linspace(0.0, 0.5 * np.pi, shape[1]), indexing="ij"
        )
        values = np.asarray(f(half, difference), np.float32)
        return cls(np.repeat(values[..., None], 3, axis=2) if values.ndim == 2 else values)

    def evaluate(self, half_angle: npt.ArrayLike, difference_angle: npt.ArrayLike) -> np.ndarray:
        """Interpolated values, (..., 3) in 1/sr, for angles in radians."""
        rows, columns = self.values.shape[:2]
        y = np.sqrt(np.clip(np.asarray(half_angle) / (0.5 * np.pi), 0.0, 1.0)) * (rows - 1)
        x = np.clip(np.asarray(difference_angle) / (0.5 * np.pi), 0.0, 1.0) * (columns - 1)
        i, j = np.minimum(y.astype(int), rows - 2), np.minimum(x.astype(int), columns - 2)
        a, b = (y - i)[..., None], (x - j)[..., None]
        v = self.values
        upper = v[i, j] * (1 - b) + v[i, j + 1] * b
        lower = v[i + 1, j] * (1 - b) + v[i + 1, j + 1] * b
        return np.asarray(upper * (1 - a) + lower * a)

    def albedo(self, cosines: npt.ArrayLike) -> np.ndarray:
        """Share of light that is sent back, (N, 3), seen at the given cosines of the angle to the normal."""
        return np.stack([self._reflected(float(c), self.values_at) for c in np.atleast_1d(cosines)])

    def values_at(self, half_angle: np.ndarray, difference_angle: np.ndarray) -> np.ndarray:
        """The whole BRDF; see `evaluate`."""
        return self.evaluate(half_angle, difference_angle)

    @staticmethod
    def _reflected(cosine: float, f: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> np.ndarray:
        """Integral of f (n.l) over all l, through their bisectors with v: dl = 4 (v.h) dh."""
        s = (np.arange(160) + 0.5) / 160
        turn = (np.arange(96) + 0.5) / 96 * 2.0 * np.pi
        theta, phi = np.meshgrid(0.5 * np.pi * s**2, turn, indexing="ij")
        solid_angle = np.sin(theta) * np.pi * s[:, None] / 160 * 2.0 * np.pi / 96
        v_dot_h = np.sqrt(1.0 - cosine**2) * np.sin(theta) * np.cos(phi) + cosine * np.cos(theta)
        n_dot_l = 2.0 * v_dot_h * np.cos(theta) - cosine
        weight = np.where((v_dot_h > 0.0) & (n_dot_l > 0.0), n_dot_l * 4.0 * v_dot_h, 0.0) * solid_angle
        values = f(theta, np.arccos(np.clip(v_dot_h, 0.0, 1.0)))
        return np.asarray((values * weight[..., None]).sum(axis=(0, 1)))

    @cached_property
    def floor(self) -> np.ndarray:
        """(3,) the least value, 1/sr: what is left when the lobe is taken away scatters as matt matter does."""
        return np.asarray(self.values.min(axis=(0, 1)), np.float64)
