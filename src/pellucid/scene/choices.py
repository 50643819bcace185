"""Values that know which of their fields were given, so that named sets of choices fill in the rest alone."""

from __future__ import annotations

import dataclasses
from typing import Any, Self

from pellucid.scene.placement import Value


class Choices(Value):
    """Base of frozen dataclasses, of ``eq=False, repr=False``, some of whose fields others choose if the user does not.

    A field that was given counts as given even where it says what it would be anyway; two values are equal if the same
    fields were given and all say the same.

    Attributes
    ----------
    given : names of the fields that were given, to the class or to `replace`; ``dataclasses.replace`` gives all.
    """

    given: frozenset[str]

    def __new__(cls, *args: Any, **fields: Any) -> Self:
        made = super().__new__(cls)
        # Not a field: those are what a user may give. Copies and pickles bring it back with the fields' values.
        object.__setattr__(made, "given", frozenset(_names(cls)[: len(args)]) | frozenset(fields))
        return made

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed, validated anew; those count as given, of the others those that did.

        Raises
        ------
        SceneError : a new value is out of range, or there is no such field.
        """
        made = super().replace(**changes)
        object.__setattr__(made, "given", self.given | frozenset(changes))
        return made

    def fill_in(self, **choices: Any) -> Self:
        """A copy with those of `choices` whose fields were not given."""
        return self.replace(**{name: value for name, value in choices.items() if name not in self.given})

    def _content(self) -> tuple[Any, ...]:
        return self.given, *(getattr(self, name) for name in _names(type(self)))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._content() == other._content()  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash(self._content())

    def __repr__(self) -> str:
        said = (f"{name}={getattr(self, name)!r}" for name in _names(type(self)) if name in self.given)
        return f"{type(self).__name__}({', '.join(said)})"


def _names(kind: type) -> list[str]:
    return [f.name for f in dataclasses.fields(kind)]
