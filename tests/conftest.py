"""What every test may ask for."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pellucid.gpu import Device

ROOT = Path(__file__).resolve().parent.parent

if not os.environ.get("XDG_RUNTIME_DIR"):
    # The software Vulkan driver looks for it when it starts, so it is set before anything can start one.
    os.environ["XDG_RUNTIME_DIR"] = tempfile.mkdtemp(prefix="pellucid-tests-")


@pytest.fixture(scope="session")
def device() -> Device:
    """One device for the whole run: making one takes longer than most tests."""
    from pellucid.gpu import Device

    return Device.create()


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real inputs that are not part of the repository (``bunny.ply``, ``fuel_injection_64.npy``)."""
    folder = Path(os.environ.get("PELLUCID_SHARED_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no folder {folder}; PELLUCID_SHARED_DATA may name another")
    return folder
