"""Run the command line as a user does, and small things to give it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from cli.cubes import cube_text


@dataclass(frozen=True)
class Said:
    """What a command said and how it ended."""

    code: int
    out: str
    err: str


Pellucid = Callable[..., Said]


@pytest.fixture
def pellucid(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Pellucid:
    """pellucid("media", "N-BK7") -> Said; in this process, since a new device for each call takes a second."""

    def run(*arguments: object) -> Said:
        from pellucid.cli import main

        monkeypatch.setattr("sys.argv", ["pellucid", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as end:
            main()
        captured = capfd.readouterr()
        return Said(int(end.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture
def cube(tmp_path: Path) -> Path:
    path = tmp_path / "cube.obj"
    path.write_text(cube_text())
    return path


@pytest.fixture
def slab(tmp_path: Path) -> Path:
    """An index array that is 1.5 everywhere."""
    path = tmp_path / "slab.npy"
    np.save(path, np.full((8, 8, 8), 1.5, np.float32))
    return path
