"""Which objects become one body: those whose matter reaches into the box of another's.

Of such a group the smaller owns a place, by the size of the box around its matter, and of equal ones the first listed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.composition import can_compose, compose
from pellucid.fields.reaching import Matter, Part, interfere, matter_of
from pellucid.fields.volume import Volume

if TYPE_CHECKING:
    from pellucid.scene import RefractiveVolume

# Placements that differ by less than this, in metres or as sines, count as the same.
SAME_PLACE = 1e-9


@dataclass(frozen=True, eq=False)
class Placed:
    """Objects that are one body.

    objects : the one that says how it is drawn first. parts, matters : in the order of priority.
    frame : (4, 4), to the world, in which the body does not move when its objects move together.
    """

    objects: tuple[RefractiveVolume, ...]
    parts: tuple[Part, ...]
    matters: tuple[Matter, ...]
    frame: np.ndarray
    key: Any

    def volume(self) -> tuple[Volume, np.ndarray]:
        """The volume itself, or all in one; and (4, 4), from it to `frame`."""
        if len(self.parts) == 1:
            return self.parts[0].volume, np.eye(4)
        volume, world = compose(self.parts, self.matters)
        return volume, np.linalg.inv(self.frame) @ world


class Joiner:
    """Groups objects, and remembers where the matter of their volumes is."""

    def __init__(self) -> None:
        self._matters: dict[Any, tuple[Volume, Matter]] = {}

    def groups(self, objects: Sequence[RefractiveVolume]) -> list[list[RefractiveVolume]]:
        """Objects that have to be one body together, in their order; what cannot be composed stays apart."""
        if len(objects) < 2:
            return [[item] for item in objects]
        known = {(id(item.volume), item.boundary): item for item in objects}
        self._matters = {key: self._matters.get(key) or _found(item) for key, item in known.items()}
        group = list(range(len(objects)))
        for i, first in enumerate(objects):
            for j in range(i):
                if group[i] != group[j] and self._interfere(first, objects[j]):
                    group = [group[j] if g == group[i] else g for g in group]
        out = []
        for g in dict.fromkeys(group):
            members = [item for item, own in zip(objects, group, strict=True) if own == g]
            together = len(members) > 1 and can_compose([_part(item) for item in self._by_priority(members)])
            out += [members] if together else [[item] for item in members]
        return out

    def place(self, group: Sequence[RefractiveVolume]) -> Placed:
        """A group as a body."""
        ordered = self._by_priority(group) if len(group) > 1 else list(group)
        parts = tuple(_part(item) for item in ordered)
        if len(parts) == 1:
            return Placed((ordered[0],), parts, (), parts[0].world, _key(ordered[0]))
        objects = sorted(ordered, key=lambda item: not _part(item).has_surface)
        frame = parts[0].world
        placements = [np.round(np.linalg.inv(frame) @ part.world / SAME_PLACE).astype(np.int64) for part in parts]
        key = tuple((*_key(item), at.tobytes()) for item, at in zip(ordered, placements, strict=True))
        matters = tuple(self._matter(item) for item in ordered)
        return Placed(tuple(objects), parts, matters, frame, (parts[0].scale, *key))

    def _matter(self, item: RefractiveVolume) -> Matter:
        return self._matters[id(item.volume), item.boundary][1]

    def _interfere(self, a: RefractiveVolume, b: RefractiveVolume) -> bool:
        return interfere(self._matter(a), a.object_to_world(), self._matter(b), b.object_to_world())

    def _by_priority(self, group: Sequence[RefractiveVolume]) -> list[RefractiveVolume]:
        """Smallest first. Sizes are compared to a millionth, so that rounding does not decide."""

        def size(item: RefractiveVolume) -> float:
            metres3 = self._matter(item).size * item.scale**3
            return round(float(np.log(max(metres3, 1e-300))), 6)

        return sorted(group, key=size)


def _found(item: RefractiveVolume) -> tuple[Volume, Matter]:
    return item.volume, matter_of(item.volume, item.boundary)


def _part(item: RefractiveVolume) -> Part:
    return Part(item.volume, item.boundary, item.object_to_world(), item.dispersion)


def _key(item: RefractiveVolume) -> Any:
    """What decides how a volume is prepared; two objects that agree in it share their textures."""
    how = (item.boundary, item.smoothing_voxels, item.gradient, item.quality.method, item.dispersion, item.spectral)
    return (id(item.volume), *how)
