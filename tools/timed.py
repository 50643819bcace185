"""What the tools that compare programs share."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def timed(make: Callable[[], T]) -> tuple[T, float]:
    """What is made, and the seconds of processor time that it took, of all threads."""
    start = time.process_time()
    made = make()
    return made, time.process_time() - start
