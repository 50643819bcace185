"""Timings that the README quotes and anyone can print again; never asserted by a test.

Every suite runs its variants in turn, several rounds after a warm-up, and states medians and ratios of one run.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pellucid.benchmarks.eikonal import eikonal
from pellucid.benchmarks.light import light
from pellucid.benchmarks.relief import relief
from pellucid.benchmarks.water import water

SUITES: dict[str, Callable[..., dict[str, Any]]] = {
    "eikonal": eikonal,
    "light": light,
    "relief": relief,
    "water": water,
}
