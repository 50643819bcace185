"""What others see of a relief."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl

if TYPE_CHECKING:
    from pellucid.gpu import Device

RED = (0.8, 0.1, 0.1)
SIZE = (48, 36)


@pytest.fixture(scope="module")
def renderer(device: Device) -> pl.Renderer:
    return pl.Renderer(device)


def bumpy(**look: object) -> pl.ReliefSurface:
    u = (np.arange(32) + 0.5) / 32
    heights = 0.01 * np.sin(2.0 * np.pi * u)[:, None] * np.cos(2.0 * np.pi * u)[None, :]
    return pl.ReliefSurface.plane(1.0, pl.ReliefLayer(heights, colors=RED), tile_m=0.25, **look)


def seen_from_above(*objects: object, lamp: bool = False, height_m: float = 0.8) -> pl.Scene:
    lamps = [pl.DirectionalLight(direction=(0.0, -1.0, 0.0), irradiance=3.0)] if lamp else []
    return pl.Scene(
        camera=pl.Camera(position=(0.0, height_m, 0.01), target=(0.0, 0.0, 0.0), fov_deg=40.0),
        environment=pl.Environment.constant((1.0, 1.0, 1.0)),
        lights=lamps,
        objects=list(objects),
    )


def test_a_relief_is_seen_through_glass(renderer: pl.Renderer) -> None:
    slab = pl.RefractiveVolume.from_array(np.full((8, 8, 8), 1.5), 0.2, boundary="sharp", position=(0.0, 0.3, 0.0))
    middle = renderer.render(seen_from_above(bumpy(), slab), SIZE).radiance[16:20, 22:26].mean((0, 1))
    assert middle[0] > 4.0 * middle[1]


def test_the_picture_shows_the_relief_and_not_what_stands_for_it(renderer: pl.Renderer) -> None:
    """From below, where a relief has no back, nothing is drawn."""
    scene = seen_from_above(bumpy())
    below = scene.replace(camera=pl.Camera(position=(0.0, -0.8, 0.01), target=(0.0, 0.0, 0.0), fov_deg=40.0))
    assert np.isinf(renderer.render(below, SIZE).depth).all()
    depth = renderer.render(scene, SIZE).depth
    assert depth.min() > 0.785 and depth[18, 24] == pytest.approx(0.8, abs=0.011)


def test_a_relief_shadows_a_floor(renderer: pl.Renderer) -> None:
    small = bumpy().replace(scale=0.2, position=(0.0, 0.3, 0.0))
    floor = pl.Mesh.plane(4.0)
    under = pl.Camera(position=(0.6, 0.15, 0.0), target=(0.0, 0.0, 0.0), fov_deg=20.0)
    lit = renderer.render(seen_from_above(floor, lamp=True).replace(camera=under), SIZE).radiance[18, 24]
    dark = renderer.render(seen_from_above(floor, small, lamp=True).replace(camera=under), SIZE).radiance[18, 24]
    assert dark[0] < 0.7 * lit[0]


def test_a_relief_does_not_shadow_itself_by_it(renderer: pl.Renderer) -> None:
    flat = pl.ReliefSurface.plane(1.0, pl.ReliefLayer(0.0, colors=RED, specular=0.0))
    scene = seen_from_above(flat, lamp=True)
    found = renderer.render(scene, SIZE).radiance[10:26, 14:34, 0]
    assert found == pytest.approx(np.full(found.shape, RED[0] * (1.0 + 3.0 / np.pi)), rel=2e-3)


def test_what_changes_no_shape_leaves_the_triangles_alone(renderer: pl.Renderer) -> None:
    surface = bumpy(translucent=pl.ReliefLayer(0.02), medium=1.3)
    renderer.render(seen_from_above(surface), SIZE)
    before = renderer.surroundings.geometry
    renderer.render(seen_from_above(surface.replace(medium=1.6, absorption=(1.0, 2.0, 3.0))), SIZE)
    assert renderer.surroundings.geometry is before
    renderer.render(seen_from_above(surface.replace(position=(0.1, 0.0, 0.0))), SIZE)
    assert renderer.surroundings.geometry is not before
