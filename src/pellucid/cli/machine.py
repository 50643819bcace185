"""What this machine has left."""

from __future__ import annotations

import os
import shutil
from pathlib import Path


def free_memory() -> int | None:
    """Bytes of memory that can still be had, or None where the system does not tell."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
        return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, AttributeError):
        return None


def free_disk(folder: Path) -> int:
    """Bytes that can still be written where `folder` lies."""
    return shutil.disk_usage(folder).free
