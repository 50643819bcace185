"""Light scattered once, against Mitsuba 3 (the extra `compare`)."""

from __future__ import annotations

import importlib
from types import ModuleType

import numpy as np
import pytest

from conftest import ROOT

SIZE = (64, 48)


@pytest.fixture(scope="module")
def comparison() -> ModuleType:
    """tools/compare_mitsuba.py."""
    pytest.importorskip("mitsuba")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "tools"))
        return importlib.import_module("compare_mitsuba")


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "samples"), [("block", 1024), ("ball", 12288)])
def test_scattered_light_is_that_of_mitsuba(comparison: ModuleType, scene: str, samples: int) -> None:
    found = comparison.compared(scene, SIZE, samples, 64)
    theirs, ours, photons = (found["mean"][name] for name in ("mitsuba", "pellucid", "photons"))
    assert (theirs > 0.0).all()
    assert np.abs(ours / theirs - 1.0).max() < 0.03
    assert np.abs(photons / theirs - 1.0).max() < 0.03
    # The photon tracer has no noise of its own kind: here the pictures can be compared pixel by pixel.
    counted = found["counted"]
    ours, photons = (found["pictures"][name][counted] for name in ("pellucid", "photons"))
    assert np.sqrt(np.square(ours - photons).mean() / np.square(photons).mean()) < 0.05
