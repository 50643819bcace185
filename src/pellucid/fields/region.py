"""A body with a sharp surface, one of those that a volume may hold."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pellucid import media
from pellucid.errors import SceneError
from pellucid.fields.voxels import Voxels, mean_cosine, not_negative, voxels
from pellucid.media import Medium


@dataclass(frozen=True, eq=False)
class Region:
    """A body of one medium with a sharp surface.

    Parameters
    ----------
    sdf : (Z, Y, X) signed distance to the surface in metres, negative inside.
    medium : what fills it; a name, a `Medium` or a constant index.
    name : for messages.
    emission : radiance gained per metre, linear RGB, >= 0.
    scattering : scattering coefficient, linear RGB, 1/m, >= 0.
    anisotropy : mean cosine of scattering, in (-1, 1).
    optic_axis : of a uniaxial crystal (such as calcite), its axis in object space; any length, kept as a unit vector.
        With it light splits into two rays; without, the crystal is drawn as if it had its ordinary index only.
    """

    sdf: Voxels = field(repr=False)
    medium: Medium
    name: str = ""
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    scattering: tuple[float, float, float] = (0.0, 0.0, 0.0)
    anisotropy: float = 0.0
    optic_axis: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "sdf", voxels("sdf", self.sdf, channels=None))
        object.__setattr__(self, "medium", media.resolve(self.medium))
        object.__setattr__(self, "emission", not_negative("emission", self.emission))
        object.__setattr__(self, "scattering", not_negative("scattering", self.scattering))
        object.__setattr__(self, "anisotropy", mean_cosine("anisotropy", self.anisotropy))
        object.__setattr__(self, "optic_axis", _axis(self.optic_axis, self.medium))


def _axis(values: Any, medium: Medium) -> tuple[float, float, float] | None:
    """A unit vector, of a medium that has an axis."""
    if values is None:
        return None
    try:
        axis = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        axis = np.zeros(0)
    length = float(np.linalg.norm(axis)) if axis.shape == (3,) and np.isfinite(axis).all() else 0.0
    if not length > 0.0:
        raise SceneError("optic_axis", f"is {values!r}", "give three numbers that are not all 0")
    if not medium.is_uniaxial:
        raise SceneError(
            "optic_axis",
            f"is given, but {medium.name} has one index",
            "use a crystal such as calcite or media.uniaxial",
        )
    x, y, z = axis if abs(length - 1.0) < 1e-12 else axis / length  # what is a unit vector stays what it is
    return float(x), float(y), float(z)
