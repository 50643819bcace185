"""Borders of water that stands free, and what look-ups in pictures do where no picture shows what is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl
from pellucid.surroundings.geometry import gather
from pellucid.techniques.water.borders import has_open_border, is_aside
from water_scenes import rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (96, 72)
FLOOR = pl.Mesh.checkerboard(8.0, squares=16, position=(0, -1.2, 0))
BALL = pl.Mesh.sphere(0.4, position=(0.5, -0.5, 0), base_color=(0.8, 0.1, 0.1))
SUN = pl.DirectionalLight(direction=(0.6, -0.7, 0.4))


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def wall(x: float, turned: bool, height_m: float) -> pl.Mesh:
    """A wall without thickness from 1.2 m below the level, at x or at z = x, 4 m long."""
    a, b = ((x, -2.0), (x, 2.0)) if not turned else ((-2.0, x), (2.0, x))
    corners = [(a[0], -1.2, a[1]), (b[0], -1.2, b[1]), (b[0], height_m, b[1]), (a[0], height_m, a[1])]
    return pl.Mesh(np.array(corners), np.array([(0, 1, 2), (0, 2, 3)]))


def terrain(rim_m: float) -> pl.Mesh:
    """Ground that rises from 1 m below the level in the middle to a height 1 m beyond the border, and on."""
    s = np.linspace(-6.0, 6.0, 41)
    x, z = np.meshgrid(s, s)
    y = -1.0 + (rim_m + 1.0) * np.maximum(np.abs(x), np.abs(z)) / 3.0
    i = np.arange(x.size).reshape(x.shape)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)])
    return pl.Mesh(np.stack([x, y, z], -1).reshape(-1, 3), faces)


WALLS = [wall(x, turned, 0.1) for x in (-2.0, 2.0) for turned in (False, True)]


@pytest.mark.parametrize(
    ("meshes", "lowest_m", "expected"),
    [
        ([], 0.0, True),
        ([FLOOR], 0.0, True),
        (WALLS, 0.0, False),
        (WALLS, -0.2, False),
        (WALLS[1:], 0.0, True),
        ([*WALLS[1:], wall(-2.0, False, -0.1)], 0.0, True),
        ([*WALLS[1:], wall(-2.0, False, -0.1)], -0.2, False),
        ([terrain(1.0)], 0.0, False),
        ([terrain(0.3)], 0.0, True),
    ],
    ids=["nothing", "floor", "walls", "lower waves", "one missing", "one low", "low enough", "land", "low land"],
)
def test_borders_are_open_where_neither_walls_nor_land_are_higher(
    meshes: list[pl.Mesh], lowest_m: float, expected: bool
) -> None:
    assert has_open_border(pl.Water(extent_m=4.0), lowest_m, gather(meshes)) == expected


def test_cameras_over_the_rectangle_see_no_border_from_outside() -> None:
    from pellucid.surroundings.camera import view_of

    water = pl.Water(extent_m=4.0, center=(1.0, 0.0))
    seen = [is_aside(water, view_of(pl.Camera(position=(x, 1.0, 0.5), target=(0, 0, 0)), (8, 8))) for x in (2.9, 3.1)]
    assert seen == [False, True]
    parallel = pl.Camera(position=(1.0, 1.0, 0.5), target=(0, 0, 0), orthographic_height_m=2.0)
    assert is_aside(water, view_of(parallel, (8, 8)))


def best_and_fast(camera: pl.Camera, water: pl.Water, renderer: Renderer) -> tuple[pl.Frame, pl.Frame]:
    best, fast = (
        renderer.render(
            pl.Scene(
                camera=camera,
                environment=pl.Environment.sky(),
                lights=[SUN],
                objects=[FLOOR, BALL, water.replace(technique=how)],
            ),
            size=SIZE,
        )
        for how in ("best", "fast")
    )
    return best, fast


def test_borders_are_seen_by_rays_where_surfaces_are_looked_up(renderer: Renderer) -> None:
    camera = pl.Camera(position=(4.5, 1.0, 5.0), target=(0, -0.5, 0), fov_deg=45)
    each_pixel = pl.WaterQuality(shading_rate=1)
    best, fast = best_and_fast(camera, pl.Water(extent_m=4.0, medium="clear lake", quality=each_pixel), renderer)
    origins, ways, cosine = rays(camera, SIZE)
    with np.errstate(invalid="ignore"):
        x, y, z = (origins + (best.depth.reshape(-1) / cosine)[:, None] * ways).T
    side = ((np.maximum(np.abs(x), np.abs(z)) - 2.0 < 1e-4) & (y < -1e-3) & (y > -1.19)).reshape(best.depth.shape)
    assert side.sum() > 500
    assert np.array_equal(best.radiance[side], fast.radiance[side])
    assert (best.radiance != fast.radiance).any()  # its surface is looked up


def test_between_trough_and_crest_nothing_is_looked_up(renderer: Renderer) -> None:
    camera = pl.Camera(position=(0, 0.0, 1.7), target=(0, -0.05, 0), fov_deg=60, near_m=0.01)
    best, fast = best_and_fast(camera, pl.Water(extent_m=4.0, waves=sines(0.1)), renderer)
    assert np.array_equal(best.radiance, fast.radiance)
