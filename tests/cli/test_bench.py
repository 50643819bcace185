"""`pellucid bench`: a table, or only JSON."""

from __future__ import annotations

import importlib
import json
import sys
from types import ModuleType

import numpy as np
import pytest

from pellucid.scene import Camera


def fake(progress, repeat=3):
    progress(1.0)
    rows = [
        {"name": "slow", "ms": np.float64(20.0), "min_ms": 19, "max_ms": 21, "ratio": 1.0, "error": None, "note": ""},
        {"name": "fast", "ms": 5.0, "min_ms": 4, "max_ms": 6, "ratio": 0.25, "error": 0.01, "note": f"{repeat} runs"},
    ]
    return {"device": {"device": "abacus"}, "suite": "sums", "rows": rows}


@pytest.fixture
def suites(monkeypatch):
    module = ModuleType("pellucid.benchmarks")
    module.SUITES = {"sums": fake, "fixed": lambda progress: fake(progress)}
    monkeypatch.setitem(sys.modules, "pellucid.benchmarks", module)


def test_a_table(pellucid, suites):
    said = pellucid("bench", "sums")
    assert said.code == 0, said.err
    assert "abacus" in said.out and "fast" in said.out and "0.25" in said.out


def test_json_alone_on_standard_output(pellucid, suites):
    said = pellucid("bench", "sums", "--json", "--repeat", "7")
    assert said.code == 0 and said.err == ""
    report = json.loads(said.out)
    assert report["rows"][0]["ms"] == 20.0 and report["rows"][1]["note"] == "7 runs"


def test_a_suite_without_repeats(pellucid, suites):
    said = pellucid("bench", "fixed", "--repeat", "7")
    assert said.code == 2 and "--repeat" in said.err


def test_an_unknown_suite(pellucid, suites):
    said = pellucid("bench", "sum")
    assert said.code == 1 and "did you mean sums" in said.err


def test_an_installation_without_benchmarks(pellucid, monkeypatch):
    monkeypatch.setitem(sys.modules, "pellucid.benchmarks", None)
    said = pellucid("bench")
    assert said.code == 1 and said.err.startswith("error: ") and "benchmarks" in said.err


def test_the_light_suite_prints_its_rows(pellucid, monkeypatch):
    """With two small balls in place of its jobs."""
    suite = importlib.import_module("pellucid.benchmarks.light")
    jobs = {
        suite.BASE: suite._Job(lambda: suite._ball(16), "small"),
        "floor": suite._Job(lambda: suite._ball(12), "", floor=True),
    }
    monkeypatch.setattr(suite, "_jobs", lambda: jobs)
    monkeypatch.setattr(suite, "RESOLUTION", 16)
    monkeypatch.setattr(suite, "SIZE", (48, 36))
    said = pellucid("bench", "light", "--json", "--repeat", "1")
    assert said.code == 0, said.err
    rows = {row["name"]: row for row in json.loads(said.out)["rows"]}
    assert list(rows) == [suite.BASE, "floor", "view_clear_16", "view_scattering_16"]
    assert rows[suite.BASE]["ratio"] == 1.0 and all(row["ms"] > 0.0 for row in rows.values())
    assert "patches" in rows["floor"]["note"]


def test_the_relief_suite_prints_its_rows(pellucid, monkeypatch):
    """Two of its surfaces."""
    suite = importlib.import_module("pellucid.benchmarks.relief")
    rows = suite._rows()
    assert {"base", "relief", "relief_thesis", "occlusion_hue", "occlusion_hue_thesis"} <= set(rows)
    monkeypatch.setattr(suite, "_rows", lambda: {name: rows[name] for name in ("base", "lamp_moves")})
    monkeypatch.setattr(suite, "SIZE", (32, 24))
    said = pellucid("bench", "relief", "--json", "--repeat", "1")
    assert said.code == 0, said.err
    printed = {row["name"]: row for row in json.loads(said.out)["rows"]}
    assert list(printed) == ["base", "lamp_moves"]
    assert printed["base"]["ratio"] == 1.0 and printed["lamp_moves"]["ms"] > 0.0


def test_the_water_suite_prints_its_rows(pellucid, monkeypatch):
    """A small lake, from rays and from pictures of it."""
    suite = importlib.import_module("pellucid.benchmarks.water")
    rows = suite._rows()
    sizes = {f"{name}_textures_{side}" for name in ("lake", "lake_mihalik") for side in (256, 512, 1024)}
    assert {"lake", "lake_caustics", "lake_mihalik", "lake_mihalik_caustics", "lake_moving_camera"} | sizes <= set(rows)
    rows["lake_caustics"].quality = rows["lake_caustics"].quality.replace(texture_size=32, caustic_size=32)
    rows["lake_best"].quality = rows["lake_best"].quality.replace(caustic_size=32)
    kept = ("lake_dry", "lake_caustics", "lake_best")
    monkeypatch.setattr(suite, "_rows", lambda: {name: rows[name] for name in kept})
    monkeypatch.setattr(suite, "GROUND", {"corners": 33, "trees": 1, "texels": 32})
    monkeypatch.setattr(suite, "SIZE", (32, 24))
    said = pellucid("bench", "water", "--json", "--repeat", "1")
    assert said.code == 0, said.err
    printed = {row["name"]: row for row in json.loads(said.out)["rows"]}
    assert tuple(printed) == kept and printed["lake_dry"]["ratio"] == 1.0
    for row in printed.values():
        assert row["fps"] > 0.0 and sum(row["passes"].values()) == pytest.approx(row["ms"], rel=0.5)
    assert printed["lake_caustics"]["error"] > 0.0 and printed["lake_best"]["error"] is None
    assert "water shade" in printed["lake_best"]["passes"]


def test_a_camera_that_flies_is_never_at_rest():
    suite = importlib.import_module("pellucid.benchmarks.water")
    rows = suite._rows()
    assert {name for name, row in rows.items() if row.flies} == {name for name in rows if "moving_camera" in name}
    camera = Camera((1.5, 1.6, 20.5), (-0.5, 0.45, 8.0))
    assert len({suite._flown(camera, k).position for k in range(suite.WARM_UP + suite.FRAMES)}) == 7
