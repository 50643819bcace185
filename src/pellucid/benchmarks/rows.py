"""Rows of a table of timings, and what suites share."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Progress = Callable[[float], None]
SIZE = (800, 600)
RESOLUTION = 128


def bunny_path() -> Path | None:
    """The Stanford bunny, if ``PELLUCID_SHARED_DATA`` names the folder of ``bunny.ply``."""
    path = Path(os.environ.get("PELLUCID_SHARED_DATA", "../shared/data")) / "bunny.ply"
    return path if path.is_file() else None


def row_of(name: str, times: list[float], base: list[float] | None, error: float | None, note: str) -> dict[str, Any]:
    """What the table says of one job: times in milliseconds, and their ratio to those of the base."""
    median = float(np.median(times))
    return {
        "name": name,
        "ms": round(median, 2),
        "min_ms": round(min(times), 2),
        "max_ms": round(max(times), 2),
        "ratio": None if base is None else round(median / float(np.median(base)), 4),
        "error": None if error is None else float(f"{error:.4g}"),
        "note": note,
    }


def device_of(renderer: Any) -> dict[str, Any]:
    """What the numbers were measured on."""
    device = renderer.device
    return {"name": device.name, "software": device.is_software, "cpus": os.cpu_count()}
