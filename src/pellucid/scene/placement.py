"""Where an object stands: position, rotation and uniform scale, and the matrices they make."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pellucid import media
from pellucid.scene import checks

if TYPE_CHECKING:
    from pellucid.media import Medium


@dataclass(frozen=True, eq=False)
class Origin:
    """How an object was made, so that a scene file can say it instead of listing numbers.

    Attributes
    ----------
    recipe : what a scene file says, such as ``{"kind": "plane", "size_m": 2.0}``; files as absolute paths.
    base_color_map : the map the recipe itself brings along, to tell it from one given by hand.
    """

    recipe: Mapping[str, Any]
    base_color_map: np.ndarray | None = None


class Value:
    """A frozen dataclass that can be copied with changes."""

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed, validated anew; arrays that stay are shared, not copied.

        Raises
        ------
        SceneError : a new value is out of range, or there is no such field.
        """
        known = {f.name for f in dataclasses.fields(self)}  # type: ignore[arg-type]
        for name in changes:
            if name not in known:
                kind = type(self).__name__
                raise checks.SceneError(name, f"{kind} has no such field", f"it has {', '.join(sorted(known))}")
        return dataclasses.replace(self, **changes)  # type: ignore[type-var]


class Light(Value):
    """Base of everything that may stand in ``Scene.lights``."""


class SceneObject(Value):
    """Base of everything that may stand in ``Scene.objects``: has position, rotation and scale."""

    position: checks.Vector
    rotation: checks.Vector
    scale: float

    def object_to_world(self) -> np.ndarray:
        """(4, 4) float64: maps the object's own coordinates, as columns, to the world in metres."""
        return placement_matrix(self.position, self.rotation, self.scale)


class Filled(SceneObject):
    """Base of objects with a layer of some medium, whose absorption may be given apart from it."""

    medium: str | Medium | float
    absorption: checks.Vector | None

    @property
    def matter(self) -> Medium:
        """The medium of the layer."""
        return media.resolve(self.medium)

    @property
    def absorption_per_m(self) -> checks.Vector:
        """Absorption that counts: the one given, else that of the medium."""
        return self.matter.absorption_per_m if self.absorption is None else self.absorption


def rotation_matrix(rotation_deg: checks.Vector) -> np.ndarray:
    """(3, 3) float64 turning about the fixed world axes, first x, then y, then z (right-handed, degrees)."""
    result = np.eye(3)
    for axis, angle in enumerate(np.radians(rotation_deg)):
        c, s = np.cos(angle), np.sin(angle)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
        result = turn @ result
    return result


def translation_matrix(offset: checks.Vector) -> np.ndarray:
    """(4, 4) float64 moving points by `offset` metres."""
    result = np.eye(4)
    result[:3, 3] = offset
    return result


def placement_matrix(position: checks.Vector, rotation_deg: checks.Vector, scale: float) -> np.ndarray:
    """(4, 4) float64: scale, then rotate, then move."""
    result = translation_matrix(position)
    result[:3, :3] = scale * rotation_matrix(rotation_deg)
    return result


def check_placement(prefix: str, position: Any, rotation: Any, scale: Any) -> dict[str, Any]:
    """The three fields as they are stored; raises SceneError under ``prefix.position`` and so on."""
    return {
        "position": checks.vector(f"{prefix}.position", position),
        "rotation": checks.vector(f"{prefix}.rotation", rotation, remedy="angles about x, y, z in degrees"),
        "scale": checks.number(f"{prefix}.scale", scale, low=0.0, exclusive=True, remedy="one factor for all axes"),
    }


def store(target: Any, /, **values: Any) -> None:
    """Sets fields of a frozen dataclass from its ``__post_init__``."""
    for name, value in values.items():
        object.__setattr__(target, name, value)
