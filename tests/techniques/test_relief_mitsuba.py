"""A relief of two layers against path-traced meshes of the same heights (the extra `compare`)."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT

SIZE = (48, 36)


@pytest.mark.slow
def test_two_layers_are_those_of_mitsuba(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("mitsuba")
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    comparison = importlib.import_module("compare_mitsuba_relief")
    theirs = comparison.mitsuba_picture(SIZE, 512, tmp_path).astype(float)
    # A few facets mirror the lamp, too bright for so few pixels; the median of a row leaves them out.
    by_rows = np.median(theirs.reshape(12, 3, SIZE[0], 3).mean(axis=1), axis=1)
    for caustics in (False, True):
        ours = comparison.pellucid_picture(SIZE, 8, caustics).astype(float)
        np.testing.assert_allclose(ours.mean(axis=(0, 1)), theirs.mean(axis=(0, 1)), rtol=0.03)
        rows = np.median(ours.reshape(12, 3, SIZE[0], 3).mean(axis=1), axis=1)
        assert np.abs(rows / by_rows - 1.0).mean() < 0.08
