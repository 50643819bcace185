"""The page on scene files: its example loads, and no field is missing from it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.scene.schema import KNOWN_FIELDS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "scene-files.md").read_text(encoding="utf-8")


def test_the_example_is_a_scene(tmp_path: Path) -> None:
    example = re.search(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    assert example
    (tmp_path / "knot.obj").write_text(
        "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", encoding="utf-8"
    )
    np.save(tmp_path / "n.npy", np.full((4, 4, 4), 1.2))
    (tmp_path / "scene.toml").write_text(example[1].replace("resolution = 96", "resolution = 16"), encoding="utf-8")
    scene = pl.load_scene(tmp_path / "scene.toml")
    assert len(scene.objects) == 3 and len(scene.lights) == 1 and scene.tone_mapping == "khronos"


def test_the_example_of_water_is_one(tmp_path: Path) -> None:
    (tmp_path / "pool.toml").write_text(re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)[1], encoding="utf-8")
    scene = pl.load_scene(tmp_path / "pool.toml")
    water = scene.objects[1]
    assert isinstance(water, pl.Water) and [layer.kind for layer in water.waves.layers] == ["ocean", "ripples"]
    heights = water.waves.layers[1].advance(0.5)
    assert np.isfinite(heights).all() and np.ptp(heights) > 0.001


def test_every_field_is_on_the_page() -> None:
    table = PAGE.partition("## Every field")[2]
    assert sorted(set(KNOWN_FIELDS) - set(re.findall(r"`(\w+)`", table))) == []
