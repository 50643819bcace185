"""Numbers that a field is described with, checked once and the same way for all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError


def number(name: str, value: Any, low: float = -np.inf, high: float = np.inf, unit: str = "") -> float:
    """A finite float from `low` to `high`.

    Raises
    ------
    SceneError : it is no number, or out of range; the message says what to use.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        raise SceneError(name, f"is {value!r}", f"give a number, {_range(low, high, unit)}")
    if not (np.isfinite(value) and low <= value <= high):
        raise SceneError(name, f"is {float(value):g}", f"use {_range(low, high, unit)}")
    return float(value)


def real_array(name: str, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """An array of real numbers of any shape; complex ones would lose their imaginary part without a word.

    Raises
    ------
    SceneError : it is none.
    """
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different lengths
        raise SceneError(name, "is no array: its rows differ in length", "give an array of numbers") from None
    if array.dtype.kind not in "fiub":
        raise SceneError(name, f"is of type {array.dtype}", "give an array of real numbers")
    return array


def _range(low: float, high: float, unit: str) -> str:
    if np.isfinite(low) and np.isfinite(high):
        text = f"{low:g} to {high:g}"
    elif np.isfinite(low):
        text = f"at least {low:g}"
    else:
        text = f"at most {high:g}" if np.isfinite(high) else "any finite one"
    return f"{text} {unit}".rstrip()
