"""Importing pellucid is quick and quiet: no device, no window, no heavy package."""

from __future__ import annotations

import json
import subprocess
import sys

HEAVY = [
    "wgpu",
    "trimesh",
    "OpenImageIO",
    "rich",
    "typer",
    "scipy",
    "glfw",
    "imgui_bundle",
    "rendercanvas",
    "av",
    "dask",
    "distributed",
]
DRAWING = ["wgpu", "rendercanvas", "glfw", "imgui_bundle"]


def loaded_after(code: str) -> set[str]:
    """Names of the top-level modules that a fresh interpreter holds after running `code`."""
    report = "; import sys, json; print(json.dumps(sorted({m.partition('.')[0] for m in sys.modules})))"
    run = subprocess.run([sys.executable, "-c", code + report], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stderr == "", run.stderr
    return set(json.loads(run.stdout))


def test_importing_loads_nothing_heavy() -> None:
    assert loaded_after("import pellucid").isdisjoint(HEAVY)


def test_describing_a_scene_loads_nothing_that_draws() -> None:
    code = "import pellucid as pl; pl.Scene(camera=pl.Camera(position=(0, 0, 1)), environment=pl.Environment.studio())"
    assert loaded_after(code).isdisjoint(DRAWING)
