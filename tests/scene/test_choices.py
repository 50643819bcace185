"""What is given to a quality counts in every technique, whatever it says; copies and scene files keep that."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from pathlib import Path
from typing import Any

import pytest

import pellucid as pl
from pellucid.scene import relief_quality, water_quality
from pellucid.scene.choices import Choices

KINDS: list[tuple[type[Any], Any, tuple[str, ...]]] = [
    (pl.WaterQuality, water_quality.quality_of, water_quality.TECHNIQUES),
    (pl.ReliefQuality, relief_quality.quality_of, relief_quality.TECHNIQUES),
]


@pytest.mark.parametrize(("kind", "quality_of", "techniques"), KINDS)
def test_a_field_that_was_given_its_default_counts_in_every_technique(
    kind: type[Choices], quality_of: Any, techniques: tuple[str, ...]
) -> None:
    chosen = set()
    for technique in techniques:
        of_technique = quality_of(technique, kind())
        for f in dataclasses.fields(kind):  # type: ignore[arg-type]
            drawn = quality_of(technique, kind(**{f.name: f.default}))
            assert getattr(drawn, f.name) == f.default
            others = {g.name for g in dataclasses.fields(kind)} - {f.name}  # type: ignore[arg-type]
            assert all(getattr(drawn, name) == getattr(of_technique, name) for name in others)
            chosen |= {f.name} if getattr(of_technique, f.name) != f.default else set()
    assert len(chosen) > 5, "techniques choose otherwise than the defaults, or nothing is tried here"


@pytest.mark.parametrize("kind", [pl.WaterQuality, pl.ReliefQuality])
def test_what_was_given_is_part_of_a_quality(kind: type[Any]) -> None:
    first = dataclasses.fields(kind)[0]
    plain, said = kind(), kind(**{first.name: first.default})
    assert said != plain and said.given == {first.name} and plain.given == frozenset()
    assert said == kind(first.default) == plain.replace(**{first.name: first.default})
    assert hash(said) == hash(kind(first.default)) and len({plain, said}) == 2
    assert repr(plain) == f"{kind.__name__}()" and repr(said) == f"{kind.__name__}({first.name}={first.default!r})"
    for copied in (copy.copy(said), copy.deepcopy(said), pickle.loads(pickle.dumps(said)), said.replace()):
        assert copied == said and copied.given == said.given
    assert list(inspect.signature(kind).parameters) == [f.name for f in dataclasses.fields(kind)]
    with pytest.raises(pl.SceneError, match="no such field"):
        plain.replace(given=("all",))


@pytest.mark.parametrize("suffix", [".json", ".toml"])
def test_scene_files_say_what_was_given(tmp_path: Path, suffix: str) -> None:
    water = pl.Water(technique="mihalik", quality=pl.WaterQuality(fresnel="exact"))
    steps = pl.ReliefQuality(hue=True, refraction_steps=[8, 5])
    relief = pl.ReliefSurface.plane(1.0, pl.ReliefLayer(0.0), technique="occlusion", quality=steps)
    scene = pl.Scene(pl.Camera(position=(0, 1, 1)), objects=[water, relief, pl.Water()])
    pl.save_scene(scene, tmp_path / f"scene{suffix}")
    read: list[Any] = list(pl.load_scene(tmp_path / f"scene{suffix}").objects)
    assert [thing.quality for thing in read] == [water.quality, steps, pl.WaterQuality()]
    assert [sorted(thing.quality.given) for thing in read] == [["fresnel"], ["hue", "refraction_steps"], []]
