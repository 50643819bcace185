"""Ground, stones and plants: the same from the same seed, whole, and where they should be."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields import landscape
from pellucid.fields.landscape import Ground, Patch


def enclosed_volume(patch: Patch) -> float:
    a, b, c = (patch.vertices[patch.faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def edges_of(patch: Patch) -> np.ndarray:
    """How many faces each edge has."""
    return np.unique(np.sort(patch.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True)[1]


@pytest.fixture(scope="module")
def basin() -> Ground:
    return landscape.lake_basin(65, seed=3)


def test_the_lake_is_deep_in_the_middle_and_dry_all_around(basin: Ground) -> None:
    heights = basin.heights_m
    assert heights[32, 32] < -3.0
    assert min(heights[0].min(), heights[-1].min(), heights[:, 0].min(), heights[:, -1].min()) > 0.5
    wet = (heights < 0.0).mean() * basin.size_m**2
    assert wet == pytest.approx(np.pi * 30.0 * 22.0, rel=0.35)
    # One lake: what is wet hangs together.
    from scipy.ndimage import label

    sizes = np.bincount(label(heights < 0.0)[0].ravel())[1:]
    assert sizes.max() > 0.98 * sizes.sum()


def test_a_seed_makes_one_ground_and_the_size_of_the_grid_does_not_move_the_shore(basin: Ground) -> None:
    np.testing.assert_array_equal(landscape.lake_basin(65, seed=3).heights_m, basin.heights_m)
    assert not np.array_equal(landscape.lake_basin(65, seed=4).heights_m, basin.heights_m)
    fine = landscape.lake_basin(129, seed=3).heights_m[::2, ::2]
    assert ((fine < 0.0) != (basin.heights_m < 0.0)).mean() < 0.01


def test_weather_keeps_the_matter_and_takes_the_steepness(basin: Ground) -> None:
    cliff = Ground(np.where(np.arange(33) < 16, 8.0, 0.0)[None, :].repeat(33, 0), 32.0)
    worn = landscape.weathered(cliff, talus=0.7, rounds=400)
    assert worn.heights_m.sum() == pytest.approx(cliff.heights_m.sum(), rel=1e-12)
    assert np.abs(np.diff(worn.heights_m, axis=1)).max() < 0.75 < np.abs(np.diff(cliff.heights_m, axis=1)).max()
    assert np.quantile(basin.steepness(), 0.99) < 1.1


def test_ground_as_triangles_faces_up_and_passes_through_its_heights(basin: Ground) -> None:
    patch = basin.patch()
    a, b, c = (patch.vertices[patch.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 1] > 0.0).all()
    assert len(patch.vertices) == 65**2 and len(patch.faces) == 2 * 64**2
    x, y, z = patch.vertices[::97].T
    np.testing.assert_allclose(basin.height(x, z), y, atol=1e-9)
    # The map lies on it as the colours were worked out: its top row at the lowest z.
    uvs = basin.uvs()
    assert uvs[0].tolist() == [0.0, 1.0] and patch.vertices[0, 2] == -45.0


def test_the_map_is_sand_at_the_shore_and_green_above(basin: Ground) -> None:
    colors = landscape.ground_map(basin, 128)
    assert colors.shape == (128, 128, 3) and colors.dtype == np.float32 and 0.0 <= colors.min() <= colors.max() <= 1.0
    at = (np.arange(128) + 0.5) / 128 - 0.5
    z, x = np.meshgrid(at * 90.0, at * 90.0, indexing="ij")
    height = basin.height(x, z)
    sand, meadow = colors[np.abs(height) < 0.2].mean(axis=0), colors[(height > 1.5) & (height < 3.0)].mean(axis=0)
    assert sand[0] > sand[1] > sand[2] and sand[0] > 2.0 * meadow[0]
    assert meadow[1] > meadow[0] > meadow[2]


@pytest.mark.parametrize("seed", range(4))
def test_a_stone_is_closed_and_about_as_large_as_said(seed: int) -> None:
    stone = landscape.stone(seed, finer=2)
    assert len(stone.faces) == 320 and (edges_of(stone) == 2).all()
    assert 0.25 < enclosed_volume(stone) / (4.0 * np.pi / 3.0) < 1.2
    far = np.linalg.norm(stone.vertices, axis=1)
    assert 0.3 < far.min() < far.max() < 1.8
    sphere = landscape.stone(seed, roughness=0.0, finer=3)
    assert enclosed_volume(sphere) == pytest.approx(4.0 * np.pi / 3.0, rel=0.02)


def test_a_tree_stands_on_its_place_and_has_its_height() -> None:
    trunk, needles = landscape.conifer(6.0, seed=2)
    assert needles.vertices[:, 1].max() == pytest.approx(6.0) and trunk.vertices[:, 1].min() == pytest.approx(-0.3)
    assert (edges_of(needles) == 2).all() and enclosed_volume(needles) > 0.0
    assert len(trunk.faces) + len(needles.faces) < 200


def test_reeds_grow_upwards_in_a_clump() -> None:
    clump = landscape.reeds(50, 1.2, 0.6, seed=1)
    assert len(clump.faces) == 150 and clump.vertices[:, 1].min() == 0.0
    assert 1.0 < clump.vertices[:, 1].max() <= 1.2


def test_patches_are_placed_and_joined() -> None:
    stone = landscape.stone(1)
    placed = stone.placed((1.0, 2.0, 3.0), np.pi / 2.0, (2.0, 1.0, 1.0))
    np.testing.assert_allclose(placed.vertices[:, 2], 3.0 - 2.0 * stone.vertices[:, 0], atol=1e-12)
    both = landscape.joined([stone, placed])
    assert len(both.faces) == 2 * len(stone.faces) and both.faces.max() == len(both.vertices) - 1
    assert enclosed_volume(both) == pytest.approx(3.0 * enclosed_volume(stone))


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: landscape.lake_basin(4), "corners"),
        (lambda: landscape.lake_basin(65, depth_m=-1.0), "depth_m"),
        (lambda: landscape.stone(finer=9), "finer"),
        (lambda: landscape.stone(roughness=1.0), "roughness"),
        (lambda: landscape.conifer(0.0), "conifer"),
        (lambda: landscape.reeds(0), "count"),
        (lambda: landscape.joined([]), "patches"),
    ],
)
def test_each_fault_names_its_field(make, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        make()
    assert caught.value.field == field
