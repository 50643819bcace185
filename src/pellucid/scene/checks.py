"""Values a user may give, checked once and the same way everywhere; each check returns what is stored."""

from __future__ import annotations

import numbers
from collections.abc import Iterable
from typing import Any, cast

import numpy as np

from pellucid.errors import SceneError

Vector = tuple[float, float, float]


def number(
    field: str,
    value: Any,
    *,
    low: float = -np.inf,
    high: float = np.inf,
    exclusive: bool = False,
    unit: str = "",
    remedy: str = "",
) -> float:
    """A finite float from `low` to `high`, or strictly between them when `exclusive`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        raise SceneError(field, f"must be a number, got {_shown(value)}", remedy)
    result = float(value)
    inside = low < result < high if exclusive else low <= result <= high
    if not np.isfinite(result) or not inside:
        raise SceneError(field, f"must be {_range(low, high, exclusive, unit)}, got {result:g}", remedy)
    return result


def integer(field: str, value: Any, *, low: int, high: int) -> int:
    """A whole number from `low` to `high`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Integral):
        raise SceneError(field, f"must be a whole number, got {_shown(value)}")
    if not low <= int(value) <= high:
        raise SceneError(field, f"must be between {low} and {high}, got {value}")
    return int(value)


def flag(field: str, value: Any) -> bool:
    """True or False, nothing that merely counts as one."""
    if not isinstance(value, bool | np.bool_):
        raise SceneError(field, f"must be true or false, got {_shown(value)}")
    return bool(value)


def choice(field: str, value: Any, options: Iterable[str]) -> str:
    """One of the named options."""
    known = tuple(options)
    if value not in known or not isinstance(value, str):
        raise SceneError(field, f"must be one of {', '.join(map(repr, known))}, got {_shown(value)}")
    return value


def vector(field: str, value: Any, remedy: str = "") -> Vector:
    """Three finite floats."""
    try:
        if isinstance(value, str):
            raise TypeError
        parts = [part for part in value]
    except TypeError:
        raise SceneError(field, f"must be three numbers, got {_shown(value)}", remedy) from None
    if len(parts) != 3:
        raise SceneError(field, f"must be three numbers, got {len(parts)}", remedy)
    return cast(Vector, tuple(number(f"{field}[{i}]", part) for i, part in enumerate(parts)))


def direction(field: str, value: Any) -> Vector:
    """Three finite floats, not all zero; kept as given, not normalised."""
    result = vector(field, value)
    if np.linalg.norm(result) < 1e-12:
        raise SceneError(field, "must not be the zero vector, it has no direction")
    return result


def color(field: str, value: Any, *, high: float = np.inf) -> Vector:
    """Three finite floats from 0 to `high`, linear Rec.709."""
    result = vector(field, value, remedy="a colour is linear (red, green, blue)")
    for i, channel in enumerate(result):
        number(f"{field}[{i}]", channel, low=0.0, high=high)
    return result


def array(
    field: str, value: Any, shape: tuple[int | None, ...], dtype: Any = np.float32, *, finite: bool = True
) -> np.ndarray:
    """A read-only, C-contiguous array of `shape` (None matches any positive length).

    An array that is already so is returned itself, so that identity tells whether data have changed.
    """
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "fiub" or (np.dtype(dtype).kind == "i" and given.dtype.kind == "f"):
            raise TypeError
    except (TypeError, ValueError):
        raise SceneError(field, f"must be an array of {np.dtype(dtype).name}, got {_shown(value)}") from None
    fits = given.ndim == len(shape) and all(n and w in (None, n) for n, w in zip(given.shape, shape, strict=True))
    if not fits:
        wanted = ", ".join("any" if n is None else str(n) for n in shape)
        raise SceneError(field, f"must have the shape ({wanted}), got {given.shape}")
    if finite and given.dtype.kind == "f" and not np.isfinite(given).all():
        raise SceneError(field, f"holds {np.count_nonzero(~np.isfinite(given))} values that are not finite")
    if not given.flags.writeable and given.flags.c_contiguous and given.dtype == dtype:
        return given
    return frozen(np.array(given, dtype, order="C"))


def picture(field: str, value: Any, shape: tuple[int | None, ...], *, linear: bool = False) -> np.ndarray:
    """As `array`; uint8 and uint16 are a picture file's: scaled to 0..1, linearised from sRGB unless `linear`."""
    from pellucid.io.images import decoded

    result, given = array(field, value, shape), np.asarray(value)
    return frozen(decoded(given, linear=linear)) if is_stored(given) else result


def is_stored(value: Any) -> bool:
    """Whether an array holds the bytes of a picture, and not numbers: uint8 and uint16."""
    return np.asarray(value).dtype in (np.uint8, np.uint16)


def frozen(result: np.ndarray) -> np.ndarray:
    """The same array, closed for writing: scene objects are values."""
    result.setflags(write=False)
    return result


def _range(low: float, high: float, exclusive: bool, unit: str) -> str:
    unit = f" {unit}" if unit else ""
    if np.isfinite(low) and np.isfinite(high):
        return f"{'strictly ' if exclusive else ''}between {low:g} and {high:g}{unit}"
    if np.isfinite(low):
        return f"{'greater than' if exclusive else 'at least'} {low:g}{unit}"
    return "a finite number"


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{type(value).__name__} {text[:50]}..."
