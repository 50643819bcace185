"""Media by name."""

from __future__ import annotations

import difflib
from functools import cache
from numbers import Real

from pellucid.errors import SceneError
from pellucid.media import crystals, gases, gems, glasses, liquids, plastics, waters
from pellucid.media.medium import Medium, constant

_SHELVES = (glasses, crystals, gems, liquids, waters, plastics, gases)


def names() -> tuple[str, ...]:
    """Canonical names of all media, in alphabetical order without regard to case."""
    return tuple(sorted((medium.name for shelf in _SHELVES for medium in shelf.MEDIA), key=str.casefold))


def get(name: str) -> Medium:
    """The medium of a name or an alias; case, spaces, hyphens and underscores do not matter.

    Raises
    ------
    SceneError : for an unknown name, suggesting the nearest known ones.
    """
    medium = _index().get(_folded(name))
    if medium is None:
        raise SceneError("medium", f"no medium is called {name!r}", _suggestion(name))
    return medium


def resolve(medium: str | Medium | float, field: str = "medium") -> Medium:
    """What a ``medium`` argument means: a name, a Medium, or a number (a constant index).

    Parameters
    ----------
    medium : name, Medium or index.
    field : path of the argument, for the message.

    Raises
    ------
    SceneError : for an unknown name, an impossible index, or anything else.
    """
    if isinstance(medium, Medium):
        return medium
    try:
        if isinstance(medium, str):
            return get(medium)
        if isinstance(medium, Real) and not isinstance(medium, bool):
            return constant(float(medium))
    except SceneError as error:
        raise SceneError(field, error.reason, error.remedy) from None
    raise SceneError(field, f"{medium!r} is not a medium", "give a name, a Medium, or a refractive index")


def _folded(name: str) -> str:
    return "".join(c for c in name.casefold() if c not in " -_")


@cache
def _index() -> dict[str, Medium]:
    by_name = {_folded(medium.name): medium for shelf in _SHELVES for medium in shelf.MEDIA}
    aliases = {_folded(alias): by_name[_folded(name)] for shelf in _SHELVES for alias, name in shelf.ALIASES.items()}
    return {**aliases, **by_name}


def _suggestion(name: str) -> str:
    near = difflib.get_close_matches(_folded(name), _index(), n=3, cutoff=0.5)
    found = list(dict.fromkeys(_index()[key].name for key in near))
    nearest = f"did you mean {' or '.join(found)}? " if found else ""
    return f"{nearest}media.names() lists them all"
