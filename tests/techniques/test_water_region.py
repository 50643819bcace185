"""Which pixels may show water."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.techniques.water.region import covered

SIZE = (80, 60)
LOW, HIGH, TOP = (-3.0, -2.0), (4.0, 5.0), 0.3


def pixels(camera: pl.Camera, points: np.ndarray) -> np.ndarray:
    """(K, 2) places in the picture of those points that it shows."""
    clip = np.c_[points, np.ones(len(points))] @ (camera.projection_matrix(SIZE) @ camera.view_matrix()).T
    clip = clip[clip[:, 3] > 1e-3]
    ndc = clip[:, :2] / clip[:, 3:]
    return (ndc[np.abs(ndc).max(axis=1) < 1.0] * (0.5, -0.5) + 0.5) * SIZE


@pytest.mark.parametrize("orthographic", [False, True])
def test_all_that_is_below_the_rectangle_is_covered(orthographic: bool) -> None:
    rng = np.random.default_rng(4)
    depth = np.r_[np.zeros(2000), rng.exponential(30.0, 4000)]
    x, z = (rng.uniform(LOW[k], HIGH[k], len(depth)) for k in (0, 1))
    points = np.stack([x, TOP - depth, z], axis=1)
    shown, smaller = 0, 0
    for _ in range(60):
        look = {"orthographic_height_m": 6.0} if orthographic else {"fov_deg": rng.uniform(20.0, 100.0)}
        position, target = rng.uniform(-9.0, 9.0, (2, 3))
        camera = pl.Camera(position=tuple(position), target=tuple(target), near_m=0.01, **look)
        clip = np.asarray(camera.projection_matrix(SIZE) @ camera.view_matrix(), np.float64)
        left, top, width, height = covered(LOW, HIGH, TOP, clip, SIZE)
        seen = pixels(camera, points)
        assert ((seen >= (left, top)) & (seen <= (left + width, top + height))).all()
        shown += len(seen)
        smaller += width * height < 0.9 * SIZE[0] * SIZE[1]
    assert shown > 1000 and smaller > 10


def test_what_has_a_floor_covers_no_more_than_the_box_above_it() -> None:
    rng = np.random.default_rng(5)
    points = rng.uniform((LOW[0], TOP - 1.5, LOW[1]), (HIGH[0], TOP, HIGH[1]), (4000, 3))
    camera = pl.Camera(position=(0, 0.5, 20), target=(0, 0, 0), near_m=0.01)
    clip = np.asarray(camera.projection_matrix(SIZE) @ camera.view_matrix(), np.float64)
    left, top, width, height = covered(LOW, HIGH, TOP, clip, SIZE, TOP - 1.5)
    seen = pixels(camera, points)
    assert ((seen >= (left, top)) & (seen <= (left + width, top + height))).all()
    assert height <= np.ptp(seen[:, 1]) + 5 and covered(LOW, HIGH, TOP, clip, SIZE)[3] > height + 10


def test_what_is_behind_the_camera_covers_nothing_and_a_sea_ends_at_the_horizon() -> None:
    camera = pl.Camera(position=(0, 9, 20), target=(0, 9, 40), near_m=0.01)
    clip = np.asarray(camera.projection_matrix(SIZE) @ camera.view_matrix(), np.float64)
    assert 0 in covered(LOW, HIGH, TOP, clip, SIZE)[2:]
    _, top, _, height = covered((-1e6, -1e6), (1e6, 1e6), 0.0, clip, SIZE)
    assert top in (28, 29) and top + height == 60
