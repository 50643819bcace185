"""Procedural textures: they repeat, agree, keep to physical ranges, and are what their parameters say."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields import textures
from pellucid.fields.textures import Maps
from pellucid.fields.textures.maps import normals_of

NAMES = ["bricks", "brushed_metal", "cobbles", "drops", "hammered_glass", "puddles", "skin", "tiles"]


@cache
def made(name: str, size: int = 96, seed: int = 0, **options: Any) -> Maps:
    return getattr(textures, name)(size=size, seed=seed, **options)


def test_every_texture_is_tried() -> None:
    assert set(NAMES) | {"Maps"} == set(textures.__all__)


@pytest.mark.parametrize("name", NAMES)
def test_heights_go_on_over_the_border_as_they_do_inside(name: str) -> None:
    """Differences and bends over the seam are like those over other lines; a seam would have several times as much."""
    heights = made(name).heights_m.astype(float)
    for axis in (0, 1):
        steps = np.abs(np.diff(heights, axis=axis, append=heights.take([0], axis)))
        bends = np.abs(np.roll(heights, -1, axis) - 2 * heights + np.roll(heights, 1, axis))
        for change, seam in ((steps, (-1,)), (bends, (-1, 0))):
            lines = np.moveaxis(change, axis, 0).mean(axis=1)
            assert lines[list(seam)].max() <= 1.25 * np.delete(lines, seam).max() + 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_colours_go_on_over_the_border_as_they_do_inside(name: str) -> None:
    colors = made(name).colors.astype(float)
    for axis in (0, 1):
        steps = np.abs(np.diff(colors, axis=axis, append=colors.take([0], axis)))
        lines = np.moveaxis(steps, axis, 0).mean(axis=(1, 2))
        assert lines[-1] <= 1.25 * lines[:-1].max() + 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_gives_the_same_bits_and_another_seed_another_surface(name: str) -> None:
    first, again, other = made(name), getattr(textures, name)(size=96), made(name, seed=1)
    for a, b in zip(parts(first), parts(again), strict=True):
        np.testing.assert_array_equal(a, b)
    difference = np.abs(first.heights_m - other.heights_m)
    assert (difference > 0.02 * np.ptp(first.heights_m)).mean() > 0.1


def parts(maps: Maps) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return maps.heights_m, maps.normals, maps.colors


@pytest.mark.parametrize("name", NAMES)
def test_normals_are_those_of_the_heights_in_metres(name: str) -> None:
    """A plane through the four neighbours of a texel has the texel's normal; x to the right, y up, row 0 on top."""
    maps = made(name)
    texel = maps.tile_m / 96
    h = maps.heights_m.astype(float)
    right = np.roll(h, -1, 1) - np.roll(h, 1, 1)
    up = np.roll(h, 1, 0) - np.roll(h, -1, 0)
    n = maps.normals.astype(float)
    np.testing.assert_allclose(n[..., 0] * 2 * texel + n[..., 2] * right, 0.0, atol=1e-5 * texel)
    np.testing.assert_allclose(n[..., 1] * 2 * texel + n[..., 2] * up, 0.0, atol=1e-5 * texel)
    np.testing.assert_allclose(np.linalg.norm(n, axis=-1), 1.0, atol=1e-6)
    assert n[..., 2].min() > 0.0


def test_normals_of_a_wave_are_the_analytic_ones() -> None:
    tile, size = 0.3, 128
    u = (np.arange(size) + 0.5) / size
    v = 1.0 - u[:, None]
    k = 2 * np.pi / tile
    heights = 0.004 * (np.sin(k * tile * u) + np.cos(2 * k * tile * v))
    slope = np.stack(np.broadcast_arrays(0.004 * k * np.cos(k * tile * u), -0.008 * k * np.sin(2 * k * tile * v)), -1)
    n = normals_of(heights, tile).astype(float)
    np.testing.assert_allclose(-n[..., :2] / n[..., 2:], slope, atol=2e-3 * np.abs(slope).max())


@pytest.mark.parametrize("name", NAMES)
def test_all_parts_have_the_stated_form(name: str) -> None:
    maps = made(name)
    assert [p.shape for p in parts(maps)] == [(96, 96), (96, 96, 3), (96, 96, 3)]
    for part in parts(maps):
        assert part.dtype == np.float32 and np.isfinite(part).all() and not part.flags.writeable
    assert maps.colors.min() >= 0.0 and maps.colors.max() <= 1.0


@pytest.mark.parametrize(
    ("name", "low_mm", "high_mm"),
    [("bricks", 5.0, 1.3), ("cobbles", 18 + 5 * 4.0, 0.0), ("tiles", 1.8, 0.35), ("hammered_glass", 0.7, 0.0),
     ("brushed_metal", 0.008, 0.0), ("skin", 0.12, 0.03)],
)  # fmt: skip
def test_relief_is_as_deep_as_asked(name: str, low_mm: float, high_mm: float) -> None:
    heights = 1e3 * made(name).heights_m
    assert 0.6 * low_mm <= -heights.min() <= 1.35 * low_mm
    assert heights.max() <= high_mm + 1e-6


def test_bricks_cover_what_bricks_cover() -> None:
    """65 x 215 mm with joints of 10 mm: 0.83 of a wall is brick; two bricks by six courses fill 0.45 m."""
    maps = made("bricks", size=256, wear=0.0)
    assert (maps.heights_m > -0.0025).mean() == pytest.approx(0.065 * 0.215 / (0.075 * 0.225), abs=0.05)
    rows = (maps.heights_m > -0.0025).mean(axis=1) > 0.5
    assert np.count_nonzero(rows & ~np.roll(rows, 1)) == 6
    bond = (maps.heights_m > -0.0025)[[20, 63]]  # two courses, by half a brick apart
    assert (bond[0] == np.roll(bond[1], 64)).mean() > 0.95


def test_finer_maps_show_the_same_surface() -> None:
    for name in ("bricks", "tiles", "skin", "hammered_glass"):
        coarse, fine = made(name).heights_m, made(name, size=192).heights_m
        mean = fine.reshape(96, 2, 96, 2).mean(axis=(1, 3))
        assert np.corrcoef(coarse.ravel(), mean.ravel())[0, 1] > 0.97, name


# ---- water ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle_deg", [25.0, 60.0, 80.0])
def test_drops_meet_the_plane_at_the_contact_angle(angle_deg: float) -> None:
    maps = textures.drops(512, 2, 0.02, contact_angle_deg=angle_deg, volumes_ul=(5.0, 25.0))
    heights = maps.heights_m.astype(float)
    slope = np.hypot(*(n / maps.normals[..., 2] for n in (maps.normals[..., 0], maps.normals[..., 1])))
    rim = (heights > 0) & (np.roll(heights, 1, 1) <= 0)
    # Half a texel x inside, a cap has the slope r / sqrt((r / tan theta)^2 + 2 r x): 2.5 degrees less at 80 degrees.
    assert np.degrees(np.arctan(np.median(slope[rim]))) == pytest.approx(angle_deg, abs=3.0)


@pytest.mark.parametrize("coverage", [0.1, 0.3, 0.5])
def test_drops_wet_as_much_as_asked(coverage: float) -> None:
    wet = (textures.drops(128, 3, 0.05, coverage=coverage).heights_m > 0).mean()
    assert wet == pytest.approx(coverage, abs=0.02)


def test_without_drops_the_map_lies_below() -> None:
    assert (textures.drops(32, coverage=0.0, below_m=0.002).heights_m == np.float32(-0.002)).all()


def test_some_drops_have_merged() -> None:
    """A round drop fills pi / 4 of the square around its longer side; two that have merged fill half of that."""
    from scipy.ndimage import find_objects, label

    numbers, count = label(made("drops", size=192).heights_m > 0)
    filled = []
    for number, box in enumerate(find_objects(numbers), start=1):
        side = max(s.stop - s.start for s in box)
        filled.append(np.count_nonzero(numbers == number) / side**2)
    assert count > 50
    assert np.median(filled) == pytest.approx(np.pi / 4, abs=0.1) and min(filled) < 0.55


def test_puddles_stand_level_and_cover_the_asked_share() -> None:
    ground = made("cobbles")
    water = textures.puddles(over=ground, coverage=0.3)
    assert np.ptp(water.heights_m) == 0.0 and water.tile_m == ground.tile_m
    assert (water.heights_m > ground.heights_m).mean() == pytest.approx(0.3, abs=0.01)
    plain = made("puddles", coverage=0.25)
    assert (plain.heights_m > 0).mean() == pytest.approx(0.25, abs=0.01)
    assert np.median(plain.heights_m[plain.heights_m > 0]) == pytest.approx(0.003, rel=0.1)


def test_scratches_run_along_u() -> None:
    n = made("brushed_metal").normals
    assert np.abs(n[..., 1]).mean() > 8 * np.abs(n[..., 0]).mean()


def test_the_example_of_the_page_runs() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "textures.md").read_text(encoding="utf-8")
    code = page.split("```python\n")[1].split("```")[0]
    assert code.count("256") == 7
    values: dict[str, Any] = {}
    exec(compile(code.replace("256", "64"), "textures.md", "exec"), values)
    assert [h.shape for h in values["heights"]] == [(64, 64)] * 2
    assert (values["water"].heights_m > values["ground"].heights_m).mean() == pytest.approx(0.4, abs=0.02)


# ---- bad input --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("options", "field"),
    [({"size": 4}, "size"), ({"size": 64.0}, "size"), ({"seed": -1}, "seed"), ({"tile_m": 0.0}, "tile_m"),
     ({"tile_m": np.nan}, "tile_m"), ({"seed": "a"}, "seed")],
)  # fmt: skip
def test_what_all_share_is_checked(name: str, options: dict, field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        getattr(textures, name)(**options)


@pytest.mark.parametrize(
    ("name", "options", "field"),
    [
        ("bricks", {"joint_m": 0.05}, "joint_m"),
        ("bricks", {"wear": 1.5}, "wear"),
        ("bricks", {"brick_color": (1, 2, 3)}, "brick_color"),
        ("bricks", {"mortar_color": "grey"}, "mortar_color"),
        ("cobbles", {"stone_m": 1.0}, "stone_m"),
        ("cobbles", {"gap_m": -0.1}, "gap_m"),
        ("tiles", {"relief_m": -1.0}, "relief_m"),
        ("hammered_glass", {"hollow_m": 1.0}, "hollow_m"),
        ("drops", {"contact_angle_deg": 95.0}, "contact_angle_deg"),
        ("drops", {"volumes_ul": (5.0, 1.0)}, "volumes_ul"),
        ("drops", {"volumes_ul": 5.0}, "volumes_ul"),
        ("drops", {"volumes_ul": (1e-5, 1e-4)}, "volumes_ul"),
        ("drops", {"volumes_ul": (1.0, 1e6)}, "volumes_ul"),
        ("drops", {"coverage": 1.0}, "coverage"),
        ("puddles", {"over": np.zeros((4, 4))}, "over"),
        ("brushed_metal", {"stroke_m": 1.0}, "stroke_m"),
        ("skin", {"cell_m": 0.0}, "cell_m"),
    ],
)
def test_parameters_are_checked(name: str, options: dict, field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        getattr(textures, name)(**options)


def test_maps_check_what_they_are_given() -> None:
    flat, up, grey = np.zeros((4, 4)), np.tile([0.0, 0.0, 1.0], (4, 4, 1)), np.full((4, 4, 3), 0.5)
    for field, values in (
        ("heights_m", (flat[0], up, grey, 1.0)),
        ("heights_m", (flat + np.nan, up, grey, 1.0)),
        ("normals", (flat, up[:2], grey, 1.0)),
        ("normals", (flat, 2 * up, grey, 1.0)),
        ("colors", (flat, up, grey + 1, 1.0)),
        ("tile_m", (flat, up, grey, -1.0)),
    ):
        with pytest.raises(SceneError, match=rf"^{field}: "):
            Maps(*values)
