"""Prints what the tests measure: each comparison that an assertion makes, with the numbers of this machine.

A test says by how much a result may be off; this says by how much it is off. Run
``python tools/measure_oracles.py tests/techniques/test_eikonal_trace.py``; arguments go to pytest. The tables of
docs/truth.md come from it.
"""

from __future__ import annotations

import sys
import tempfile
from typing import Any

import pytest


class Measure:
    """Prints assertions as they pass; pytest has put the values in."""

    def pytest_assertion_pass(self, item: pytest.Item, lineno: int, orig: str, expl: str) -> None:
        values = expl.splitlines()[0].replace("np.float64(", "").replace("np.float32(", "").replace(")", "")
        print(f"{item.name}: {orig.split(', f')[0]}\n    {values}")


def main(arguments: list[str]) -> int:
    """The tests of `arguments`, with their assertions printed; the exit code is pytest's."""
    plugins: list[Any] = [Measure()]
    options = ["-o", "enable_assertion_pass_hook=true", "-s", "-q"]
    # Assertions that were compiled without the hook are kept in a cache, so this run has one of its own.
    with tempfile.TemporaryDirectory() as fresh:
        sys.pycache_prefix = fresh
        return int(pytest.main([*options, *arguments], plugins=plugins))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
