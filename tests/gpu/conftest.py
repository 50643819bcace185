"""Shaders for one test, written next to nothing else."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from pellucid.gpu.modules import ModuleSource, source


@pytest.fixture
def assemble(tmp_path: Path) -> Callable[..., ModuleSource]:
    """`assemble(text, **imported)`: the module "top" of that text, with files of those names to import."""

    def write(text: str, **imported: str) -> ModuleSource:
        for name, content in {"top": text, **imported}.items():
            (tmp_path / f"{name}.wgsl").write_text(content, encoding="utf-8")
        return source("top", tmp_path)

    return write
