"""Water in scene files."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields.waves import Ripples
from pellucid.scene.schema import WaterFile, WaterQualityFile


def scene(*objects: pl.Water) -> pl.Scene:
    return pl.Scene(camera=pl.Camera(position=(0, 1, 3), target=(0, 0, 0)), objects=list(objects))


@pytest.mark.parametrize("suffix", [".json", ".toml"])
def test_water_is_read_as_it_was_written(suffix: str, tmp_path: Path) -> None:
    ripples = Ripples((24, 32), cell_m=0.1, damping=0.2, boundary="absorb")
    ripples.drop(0.3, -0.2, 0.3, 0.02, 0.5)
    quality = pl.WaterQuality(steps=7, fresnel="schlick", shadows=False)
    water = pl.Water(0.3, (4, 3), (1, -2), ripples, "pond", 1.1, "mihalik", quality, 0.4, (0.1, 0.2, 0.3), 0.7, True)
    pl.save_scene(scene(water, pl.Water()), tmp_path / f"pond{suffix}")
    read, plain = pl.load_scene(tmp_path / f"pond{suffix}").objects
    assert isinstance(read, pl.Water) and isinstance(plain, pl.Water) and plain.waves is None
    same = [f.name for f in dataclasses.fields(pl.Water) if f.name != "waves"]
    assert [getattr(read, name) for name in same] == [getattr(water, name) for name in same]
    assert np.array_equal(read.waves.advance(0.8), ripples.advance(0.8)) and read.waves.advance(0.8).any()


def test_outlines_are_read_as_they_were_written(tmp_path: Path) -> None:
    waters = [
        pl.Water(outline="ellipse", extent_m=(2, 1), depth_m=0.5, floor="round"),
        pl.Water(outline=np.array([(0, 0), (1, 3), (3, 0)]), center=(1, 2), depth_m=0.5, floor_scale=0.5),
        pl.Water(extent_m=3.0, depth_m=1.0),
    ]
    pl.save_scene(scene(*waters), tmp_path / "basins.toml")
    for water, read in zip(waters, pl.load_scene(tmp_path / "basins.toml").objects, strict=True):
        assert isinstance(read, pl.Water)
        same = [f.name for f in dataclasses.fields(pl.Water)]
        assert [getattr(read, name) for name in same] == [getattr(water, name) for name in same]


def test_a_polygon_goes_round_one_way_and_spans_what_its_corners_do() -> None:
    corners = [(0.0, 0.0), (1.0, 3.0), (3.0, 0.0)]
    one, other = (pl.Water(outline=c, center=(1, 2), depth_m=2.0) for c in (corners, corners[::-1]))
    assert sorted(one.outline) == sorted(other.outline) == corners
    for water in (one, other):
        assert water.bounds_m == ((1.0, 2.0), (4.0, 5.0)) and water.size_m == water.extent_m == (3.0, 3.0)
        points = [(1.3, -1.0, 1.0), (0.1, -1.0, 0.2), (0.1, -1.0, 2.0), (2.4, -1.0, 1.1), (1.3, -2.1, 1.0)]
        middle = np.array([water.shape.middle[0] - 1.0, 0.0, water.shape.middle[1] - 2.0])
        assert water.shape.holds(np.array(points) - middle).tolist() == [True, True, False, False, False]


def test_round_floors_are_those_of_balls_and_buckets_those_of_cones() -> None:
    ball = pl.Water(outline="ellipse", extent_m=1.2, depth_m=1.0 + 0.8, floor="round").shape  # of 1 m, 0.8 m under
    depth = np.linspace(0.0, 1.8, 50)
    radius = np.sqrt(1.0 - (depth - 0.8) ** 2)
    assert ball.widest == pytest.approx(1.0 / 0.6)
    bucket = pl.Water(outline="ellipse", extent_m=2.0, depth_m=0.5, floor_scale=0.6).shape
    inner = np.stack([0.999 * radius, -depth, 0.0 * depth], -1)
    assert ball.holds(inner[1:-1]).all() and not ball.holds(inner / (0.999, 1, 1) * (1.001, 1, 1))[1:-1].any()
    assert bucket.holds([(0.0, -0.499, 0.599), (0.79, -0.25, 0.0)]).all()
    assert not bucket.holds([(0.0, -0.499, 0.61), (0.81, -0.25, 0.0), (0.0, -0.51, 0.0)]).any()


@pytest.mark.parametrize(
    ("fields", "where", "reason"),
    [
        ({"outline": "circle"}, "water.outline", "ellipse"),
        ({"outline": None}, "water.outline", "shape"),
        ({"outline": [(0, 0), "x", (1, 1)]}, "water.outline", "corners"),
        ({"outline": [(0, 0), (1, 0)]}, "water.outline", "2 corners"),
        ({"outline": [(np.cos(a), np.sin(a)) for a in np.arange(17) * 2 * np.pi / 17]}, "water.outline", "17 corners"),
        ({"outline": [(0, 0), (1, 0), (1, np.nan)]}, "water.outline[2]", "finite"),
        ({"outline": [(0, 0), (1, 0), (1, 0), (0, 1)]}, "water.outline[1]", "next corner"),
        ({"outline": [(0, 0), (2, 0), (0.5, 0.5), (0, 2)]}, "water.outline[2]", "convex"),
        ({"outline": [(0, 0), (1, 0), (2, 0), (0, 2)]}, "water.outline[1]", "convex"),
        ({"outline": [(0, 0), (1, 1), (2, 2)]}, "water.outline", "convex"),
        (
            {"outline": [(np.cos(a), np.sin(a)) for a in np.arange(5) * 4 * np.pi / 5]},
            "water.outline",
            "more than once",
        ),
        ({"depth_m": 0.0}, "water.depth_m", "0"),
        ({"depth_m": "deep"}, "water.depth_m", "number"),
        ({"floor": "soft", "depth_m": 1.0}, "water.floor", "soft"),
        ({"floor": "round", "depth_m": 1.0}, "water.floor", "ellipse"),
        ({"floor": "round", "outline": "ellipse"}, "water.floor", "deep"),
        ({"floor_scale": 0.5}, "water.floor_scale", "deep"),
        ({"floor_scale": 1.5, "depth_m": 1.0}, "water.floor_scale", "1"),
        ({"floor_scale": 0.5, "depth_m": 1.0, "outline": "ellipse", "floor": "round"}, "water.floor_scale", "flat"),
    ],
)
def test_shapes_that_cannot_be_are_named(fields: dict[str, Any], where: str, reason: str) -> None:
    with pytest.raises(pl.SceneError) as error:
        pl.Water(**fields)
    assert error.value.field.startswith(where) and reason in str(error.value)


def test_waves_of_every_kind_are_read_as_they_were_written(tmp_path: Path) -> None:
    from pellucid.fields import waves

    x = np.linspace(0.0, 1.0, 16)
    sources = [
        waves.Sine(wavelength_m=(2.0, 3.0), amplitude_m=0.1, shape=(16, 16)),
        waves.Gerstner(amplitude_m=0.05, sharpness=0.5, tile_m=(4.0, 8.0), shape=(16, 16)),
        waves.Ocean(wind_m_s=6.0, tile_m=20.0, shape=(16, 16), seed=3),
        waves.Heights(np.outer(np.sin(x), x), tile_m=2.0),
    ]
    sources.append(waves.Sum(sources[2], waves.Ripples((16, 16), 0.1)))
    sources[-1].drop(0.1, 0.1, 0.3, 0.02)
    pl.save_scene(scene(*(pl.Water(waves=source) for source in sources)), tmp_path / "sea.toml")
    for source, read in zip(sources, pl.load_scene(tmp_path / "sea.toml").objects, strict=True):
        assert isinstance(read, pl.Water) and type(read.waves) is type(source)
        assert read.waves.tile_m == source.tile_m and np.array_equal(read.waves.advance(0.7), source.advance(0.7))


def test_a_water_file_has_every_field() -> None:
    assert set(WaterFile.model_fields) - {"type"} == {f.name for f in dataclasses.fields(pl.Water)}
    assert set(WaterQualityFile.model_fields) == {f.name for f in dataclasses.fields(pl.WaterQuality)}


@pytest.mark.parametrize(
    ("text", "field"),
    [
        ('type = "water"\nlevl = 1.0', "objects[0].levl"),
        ('type = "water"\nextent_m = 0.0', "objects[0].extent_m"),
        ('type = "water"\nmedium = "watr"', "objects[0].medium"),
        ('type = "water"\nwaves = { kind = "tides" }', "objects[0].waves.kind"),
        ('type = "water"\nwaves = { kind = "ripples", shape = [8, 8], cell_m = -1.0 }', "objects[0].waves.cell_m"),
        ('type = "water"\nwaves = { kind = "ripples", shape = [8, 8], cell = 1.0 }', "objects[0].waves.cell"),
        ('type = "water"\nquality = { steps = 0 }', "objects[0].quality.steps"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(text: str, field: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f"[camera]\nposition = [0.0, 1.0, 3.0]\n[[objects]]\n{text}\n", encoding="utf-8")
    with pytest.raises(pl.SceneError) as error:
        pl.load_scene(path)
    assert error.value.field.startswith(f"{path}: {field}")


def test_waves_that_no_file_can_state_are_refused(tmp_path: Path) -> None:
    class Own:
        shape, tile_m, limits_m = (4, 4), (1.0, 1.0), (0.0, 0.0)

        def advance(self, time_s: float) -> np.ndarray:
            return np.zeros((4, 4), np.float32)

    with pytest.raises(pl.SceneError, match=r"objects\[0\].waves"):
        pl.save_scene(scene(pl.Water(waves=Own())), tmp_path / "own.json")
    assert not list(tmp_path.iterdir())
