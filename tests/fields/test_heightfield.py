"""Height fields: slopes, bounds, cones and distances against every pair of points."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.heightfield import (
    bounds_pyramid,
    cell_maxima,
    complexity_map,
    cone_map,
    distance_map,
    slopes_of,
)

SIZE = (11, 14)
both_edges = pytest.mark.parametrize("tiling", [True, False])


def heights(seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).random(SIZE).astype(np.float32)


def at(h: np.ndarray, column: np.ndarray, row: np.ndarray, tiling: bool) -> np.ndarray:
    """Bilinear height at any columns and rows, counted in texel centres."""
    i, j = np.floor(column).astype(int), np.floor(row).astype(int)
    x, y = column - i, row - j
    rows, columns = h.shape

    def sample(b: np.ndarray, a: np.ndarray) -> np.ndarray:
        return h[b % rows, a % columns] if tiling else h[np.clip(b, 0, rows - 1), np.clip(a, 0, columns - 1)]

    upper = (1 - x) * sample(j, i) + x * sample(j, i + 1)
    lower = (1 - x) * sample(j + 1, i) + x * sample(j + 1, i + 1)
    return (1 - y) * upper + y * lower


def test_slopes_of_a_plane_and_of_a_wave() -> None:
    rows, columns = np.mgrid[0:8, 0:16]
    plane = 0.25 * 0.1 * columns - 0.5 * 0.2 * rows
    np.testing.assert_allclose(slopes_of(plane, (0.1, 0.2), tiling=False), [[(0.25, 0.5)] * 16] * 8, atol=1e-6)
    wave = np.sin(2 * np.pi * columns / 16)
    found = slopes_of(wave, (1 / 16, 1 / 8))[..., 0]
    exact_difference = np.cos(2 * np.pi * columns / 16) * np.sin(2 * np.pi / 16) * 16
    np.testing.assert_allclose(found, exact_difference, atol=1e-5)


@both_edges
@pytest.mark.parametrize("shape", [(8, 16), (7, 13), (1, 5)])
def test_bounds_hold_for_every_node(tiling: bool, shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(1)
    solid, upper = rng.random((2, *shape)).astype(np.float32)
    levels = bounds_pyramid(solid, upper, tiling)
    assert levels[-1].shape == (1, 1, 4)
    for k, level in enumerate(levels):
        h, w = level.shape[:2]
        assert (h, w) == (max(1, shape[0] >> k), max(1, shape[1] >> k))
        row = np.minimum(np.arange(shape[0]) >> k, h - 1)
        column = np.minimum(np.arange(shape[1]) >> k, w - 1)
        of_cell = level[row][:, column]
        for y, x in rng.random((20, 2)):
            places = np.meshgrid(np.arange(shape[1]) + x, np.arange(shape[0]) + y)
            for layer, (top, bottom) in ((solid, (0, 1)), (upper, (2, 3))):
                z = at(layer, *places, tiling)
                assert (z <= of_cell[..., top] + 1e-6).all() and (z >= of_cell[..., bottom] - 1e-6).all()
    assert levels[-1][0, 0].tolist() == [solid.max(), solid.min(), upper.max(), upper.min()]


def test_without_a_second_layer_it_lies_below_the_first() -> None:
    level = bounds_pyramid(heights())[0]
    assert (level[..., 2] < level[..., 0]).all() and (level[..., 3] < level[..., 1]).all()


@both_edges
def test_cones_are_the_narrowest_that_hold_for_all_corners(tiling: bool) -> None:
    h = heights()
    cones = cone_map(h, tiling)
    highest = cell_maxima(h, tiling)
    rows, columns = SIZE
    for quadrant in range(4):
        column_sign, row_sign = 1 - 2 * (quadrant & 1), 1 - (quadrant & 2)
        for j, i in ((0, 0), (4, 7), (10, 13), (10, 0), (6, 12)):
            m, ratio = cones[quadrant, j, i]
            assert m == highest[j, i]
            steps = np.arange(2 * max(SIZE))
            dx, dy = np.meshgrid(steps, steps)
            a, b = i + column_sign * dx, j + row_sign * dy
            # Beyond a border that does not repeat there are no more cells of other heights.
            a, b = (a % columns, b % rows) if tiling else (np.clip(a, 0, columns - 1), np.clip(b, 0, rows - 1))
            gap = dx + dy
            needed = np.max(np.where(gap > 0, (highest[b, a] - m) / np.maximum(gap, 1), 0.0))
            assert ratio == pytest.approx(max(needed, 0.0), rel=1e-5, abs=1e-7)


@both_edges
@pytest.mark.parametrize("gaps", [3, 96])
def test_no_bilinear_surface_reaches_above_a_cone(tiling: bool, gaps: int) -> None:
    h = heights()
    cones = cone_map(h, tiling, gaps).astype(np.float64)
    rng = np.random.default_rng(5)
    n = 200_000
    cell = np.stack([rng.integers(0, SIZE[1], n), rng.integers(0, SIZE[0], n)])
    leaves = cell + rng.random((2, n))
    quadrant = rng.integers(0, 4, n)
    sign = np.stack([1 - 2 * (quadrant & 1), 1 - (quadrant & 2)])
    # On the border where a ray of the quadrant leaves the cell.
    which = rng.integers(0, 2, n)
    leaves[which, np.arange(n)] = (cell + (sign > 0))[which, np.arange(n)]
    way = rng.random((2, n)) * rng.choice([0.3, 3.0, 20.0], n)
    m, ratio = cones[quadrant, cell[1], cell[0]].T
    beyond = leaves + sign * way
    assert (at(h, beyond[0], beyond[1], tiling) <= m + ratio * way.sum(axis=0) + 1e-6).all()


@both_edges
def test_no_matter_is_nearer_than_the_looked_up_distance(tiling: bool) -> None:
    from scipy.ndimage import map_coordinates

    h, cell, layers = heights() * 0.1, (0.02, 0.03), 17
    found = distance_map(h, cell, 0.0, 0.4, layers, tiling)
    fine = 6
    margin = 8 if tiling else 0
    columns = np.arange(-margin * fine, (SIZE[1] + margin) * fine) / fine
    rows = np.arange(-margin * fine, (SIZE[0] + margin) * fine) / fine
    surface = at(h, *np.meshgrid(columns, rows), tiling)
    rng = np.random.default_rng(2)
    used = 0
    for _ in range(300):
        p = rng.random(3) * (SIZE[1] - 1, SIZE[0] - 1, layers - 1)
        looked_up = float(map_coordinates(found, p[::-1, None], order=1)[0])
        z = p[2] * 0.4 / (layers - 1)
        gaps = np.hypot((columns[None] - p[0]) * cell[0], (rows[:, None] - p[1]) * cell[1])
        true = np.hypot(gaps, np.maximum(z - surface, 0.0)).min()
        assert looked_up <= true
        used += looked_up > 0.3 * true
    assert used > 60


def test_over_a_plane_the_distance_is_the_height() -> None:
    found = distance_map(np.zeros((6, 6)), (0.1, 0.1), 0.0, 1.0, 11)
    half_diagonal = np.sqrt(3) * 0.05
    np.testing.assert_allclose(found[:, 2, 3], np.maximum(np.linspace(0, 1, 11) - half_diagonal, 0.0), atol=1e-5)


def test_a_plane_is_simple_and_noise_is_not() -> None:
    ramp = np.tile(np.arange(32.0), (32, 1))
    assert complexity_map(ramp, tiling=False)[:, 5:-5].max() == 0.0
    assert complexity_map(np.zeros((8, 8))).max() == 0.0
    assert complexity_map(heights()).mean() > 0.9


def test_what_is_wrong_is_said() -> None:
    with pytest.raises(SceneError, match="heights_m"):
        cone_map(np.zeros(4))
    with pytest.raises(SceneError, match="finite"):
        bounds_pyramid(np.full((4, 4), np.nan))
    with pytest.raises(SceneError, match="translucent"):
        bounds_pyramid(np.zeros((4, 4)), np.zeros((4, 5)))
    with pytest.raises(SceneError, match="cell_m"):
        slopes_of(np.zeros((4, 4)), (0.0, 1.0))
    with pytest.raises(SceneError, match="layers"):
        distance_map(np.zeros((4, 4)), (1.0, 1.0), 0.5, 0.5)
    with pytest.raises(SceneError, match="radius"):
        complexity_map(np.zeros((4, 4)), radius=0)
