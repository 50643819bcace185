"""Every example runs headless at a small size and shows what it says."""

from __future__ import annotations

import importlib.util
import inspect
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from pellucid.io.images import read_image

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("[0-9]*.py"))
SMALL: dict[str, Any] = {"size": (64, 48), "resolution": 32, "samples": 2}


def load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(number: int, output: Path, **changes: Any) -> Any:
    (path,) = (p for p in EXAMPLES if p.name.startswith(f"{number:02d}_"))
    main = load(path).main
    wanted = {name: value for name, value in (SMALL | changes).items() if name in inspect.signature(main).parameters}
    return main(output, **wanted)


def test_numbers_run_without_gaps() -> None:
    assert [int(p.name[:2]) for p in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_an_example_says_what_there_is_to_see(path: Path) -> None:
    assert (load(path).__doc__ or "").startswith("You should see: ")


def test_glass_ball_shows_the_board_upside_down(tmp_path: Path) -> None:
    frame = run(1, tmp_path)
    assert (tmp_path / "glass_ball.png").stat().st_size > 0
    assert np.isfinite(frame.radiance).all() and frame.radiance.std() > 0.01


def test_own_mesh_becomes_a_body_of_its_size(tmp_path: Path) -> None:
    animal = run(2, tmp_path)
    # The tallest edge of the box is that of the mesh and three voxels of margin on each side.
    height = float(np.ptp(np.loadtxt([r[2:] for r in (tmp_path / "animal.obj").open() if r.startswith("v ")])[:, 1]))
    assert animal.volume.extent_m[1] == pytest.approx(height * 32 / 26, rel=1e-3)
    assert (tmp_path / "own_mesh.png").exists()


def test_named_media_prints_indices(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(3, tmp_path)
    printed = capsys.readouterr().out
    assert "diamond" in printed and "2.41" in printed  # n_D of diamond is 2.417


def test_luneburg_lens_gathers_parallel_rays() -> None:
    assert run(4, Path(), resolution=96) < 0.01


def test_a_numpy_index_bends_the_board(tmp_path: Path) -> None:
    frame = run(5, tmp_path)
    middle, rim = frame.radiance[20:28, 28:36], frame.radiance[:6]
    assert np.isfinite(frame.radiance).all() and middle.std() > 0.0 and rim.std() > 0.0


def test_samples_smooth_and_exr_keeps_radiance(tmp_path: Path) -> None:
    from pellucid.io.images import read_image

    rough, fine = run(6, tmp_path, samples=8)
    assert not np.array_equal(rough.radiance, fine.radiance)
    kept = read_image(tmp_path / "amber_cube.exr")[..., :3]
    np.testing.assert_allclose(kept, fine.radiance, rtol=1e-3, atol=1e-4)


def test_environment_comes_back_from_a_file(tmp_path: Path) -> None:
    frame = run(7, tmp_path)
    # The camera is 0.2 m from the middle of a ball of 0.03 m; only the foreground may be nearer.
    assert 0.03 < frame.depth.min() < 0.2
    assert np.isinf(frame.depth).any() and (tmp_path / "sunset_depth.png").exists()


def test_dispersion_colours_white_bars(tmp_path: Path) -> None:
    coloured, plain = run(8, tmp_path, size=(96, 72))

    def colour(frame: Any) -> float:
        middle = frame.radiance[24:48, 36:60]
        return float(np.ptp(middle, axis=2).mean() / middle.mean())

    assert colour(coloured) > 3.0 * colour(plain)


def test_rings_spread_on_water(tmp_path: Path) -> None:
    frames = run(9, tmp_path, samples=1)
    assert len(list(tmp_path.glob("rings_*.png"))) == len(frames) == 6
    assert all(np.isfinite(f.radiance).all() for f in frames)
    assert all(not np.array_equal(a.radiance, b.radiance) for a, b in pairwise(frames))


def test_rain_goes_on_where_it_stopped(tmp_path: Path) -> None:
    paths = run(10, tmp_path, samples=1, frames=3, film=False)
    assert [p.name for p in paths] == ["frame_0000.png", "frame_0001.png", "frame_0002.png"]
    drawn = [p.read_bytes() for p in paths]
    assert len(set(drawn)) == 3
    paths[1].unlink()
    before = [paths[k].stat().st_mtime_ns for k in (0, 2)]
    assert [p.read_bytes() for p in run(10, tmp_path, samples=1, frames=3, film=False)] == drawn
    assert [paths[k].stat().st_mtime_ns for k in (0, 2)] == before


def test_sheets_refract_and_show_where_they_err(tmp_path: Path) -> None:
    made = run(11, tmp_path, samples=1, frames=2)
    assert {name: len(paths) for name, paths in made.items()} == {"article": 2, "exact": 2, "error": 2}
    article, exact, error = (read_image(made[name][1]) for name in ("article", "exact", "error"))
    assert 0.001 < np.abs(article - exact).mean() < 0.1
    assert error.std() > 0.05


def test_a_pool_and_a_day_at_the_lake_move_and_go_on(tmp_path: Path) -> None:
    made = run(12, tmp_path, size=(32, 24), samples=1, frames=2, corners=33)
    assert {name: len(paths) for name, paths in made.items()} == {"pool": 2, "day": 2}
    assert (tmp_path / "lake.mtl").exists()
    for first, second in made.values():
        assert first.read_bytes() != second.read_bytes()
    made["pool"][1].unlink()
    kept = made["pool"][0].stat().st_mtime_ns
    run(12, tmp_path, size=(32, 24), samples=1, frames=2, corners=33)
    assert made["pool"][1].exists() and made["pool"][0].stat().st_mtime_ns == kept
