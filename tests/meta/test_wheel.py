"""The wheel carries everything: it works where the source tree is not."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"

# Run without the current folder and user packages, with the editable installation's entry taken off the path.
ISOLATE = f"""
import sys
sys.path = [sys.argv[1]] + [p for p in sys.path if p and not p.startswith({str(SOURCE)!r})]
sys.meta_path = [f for f in sys.meta_path if "editable" not in repr(f).lower()]
import pellucid
assert pellucid.__file__.startswith(sys.argv[1]), pellucid.__file__
"""
COMPILE = """
from pellucid.gpu import Device
from pellucid.gpu.modules import compile_module, source
module = source("optics/fresnel")
assert "fn fresnel_dielectric" in module.text
compile_module(Device.create(), "optics/fresnel")
"""
RENDER = """
import numpy as np
import pellucid as pl
ball = pl.RefractiveVolume.from_sdf(
    lambda x, y, z: np.sqrt(x * x + y * y + z * z) - 0.4, medium="N-BK7", resolution=16, extent_m=(1, 1, 1))
scene = pl.Scene(camera=pl.Camera(position=(0, 0, 2)), environment=pl.Environment.studio(), objects=[ball])
radiance = pl.render(scene, size=(32, 24)).radiance
assert radiance.shape == (24, 32, 3) and np.isfinite(radiance).all() and np.ptp(radiance) > 0
"""


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the unpacked wheel."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (wheel,) = folder.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(folder / "site")
    return folder / "site"


def run(code: str, site: Path) -> None:
    command = [sys.executable, "-I", "-c", ISOLATE + code, str(site)]
    done = subprocess.run(command, cwd=site.anchor, env=dict(os.environ), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_wheel_holds_every_file_of_the_package(unpacked: Path) -> None:
    wanted = {p.relative_to(SOURCE) for p in (SOURCE / "pellucid").rglob("*") if p.is_file() and p.suffix != ".pyc"}
    found = {p.relative_to(unpacked) for p in (unpacked / "pellucid").rglob("*") if p.is_file() and p.suffix != ".pyc"}
    assert found == wanted


def test_the_wheel_alone_compiles_a_shader(unpacked: Path) -> None:
    run(COMPILE, unpacked)


def test_the_wheel_alone_renders_glass(unpacked: Path) -> None:
    run(RENDER, unpacked)
