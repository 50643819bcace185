"""What waves are asked to be, checked once and the same way for all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import number

#: Most cells along a side.
LARGEST = 4096


def numbers(name: str, value: Any, low: float = -np.inf, high: float = np.inf) -> npt.NDArray[np.float64]:
    """(N,) finite numbers from `low` to `high`, of one number or several."""
    try:
        given = np.atleast_1d(np.asarray(value))
    except ValueError:
        given = np.zeros((0, 0))
    if given.ndim != 1 or not given.size or given.dtype.kind not in "fiu":
        raise SceneError(name, f"is {value!r}", "give a number, or several in a row")
    return np.array([number(name, x, low, high) for x in given.tolist()])


def depth(name: str, value: Any) -> float:
    """A depth in metres, > 0; infinite for deep water."""
    if isinstance(value, float) and value == np.inf:
        return value
    return number(name, value, low=1e-6)


def grid(shape: Any, low: int = 5, high: int = LARGEST) -> tuple[int, int]:
    """(rows, columns), whole numbers."""
    try:
        rows, columns = shape
        whole = all(isinstance(n, int | np.integer) and not isinstance(n, bool) for n in (rows, columns))
    except (TypeError, ValueError):
        whole, rows, columns = False, 0, 0
    if not whole or not (low <= rows <= high and low <= columns <= high):
        raise SceneError("shape", f"is {shape!r}", f"give (rows, columns), whole numbers from {low} to {high}")
    return int(rows), int(columns)


def tile(value: Any, name: str = "tile_m") -> tuple[float, float]:
    """(along x, along z) metres, > 0, of one number or two."""
    parts = numbers(name, value, low=1e-6, high=1e6)
    if parts.size > 2:
        raise SceneError(name, f"are {parts.size} numbers", "give one, or (along x, along z)")
    return float(parts[0]), float(parts[-1])


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, bool | np.bool_):
        raise SceneError(name, f"is {value!r}", "use true or false")
    return bool(value)


def choice(name: str, value: Any, known: tuple[str, ...]) -> str:
    """One of several words."""
    if not isinstance(value, str) or value not in known:
        raise SceneError(name, f"is {value!r}", f"use one of {', '.join(known)}")
    return value


def moment(time_s: Any) -> float:
    """A time since the start, seconds."""
    return number("time_s", time_s, low=0.0, high=1e9)
