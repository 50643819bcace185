"""Blocks of pixels that share one look at the water: what they keep of the whole picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl
from pellucid.surroundings.camera import view_of
from pellucid.techniques.water.blocks import block_of, divided
from water_scenes import sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (97, 61)  # no multiple of any block
BY = pl.WaterQuality.of


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def pool(rate: int, camera: pl.Camera | None = None, technique: str = "fast", **water: object) -> pl.Scene:
    """A post and a ball cross the surface over a white floor."""
    floor = pl.Mesh.plane(30.0, position=(0.0, -1.5, 0.0), base_color=(0.8, 0.8, 0.8))
    post = pl.Mesh.box((0.12, 3.0, 0.12), position=(-0.5, 0.0, 0.6), base_color=(0.7, 0.1, 0.1))
    ball = pl.Mesh.sphere(0.5, position=(0.6, 0.0, 0.0), base_color=(0.1, 0.6, 0.2))
    water = {"extent_m": 24.0, "medium": "coastal", **water}
    return pl.Scene(
        camera=camera or pl.Camera(position=(0.4, 2.4, 3.0), target=(0.0, -0.5, 0.0), fov_deg=45),
        environment=pl.Environment.constant((0.5, 0.7, 1.0)),
        lights=[pl.DirectionalLight(direction=(-0.4, -1.0, -0.3))],
        objects=[floor, post, ball, pl.Water(quality=BY(technique, shading_rate=rate), technique="best", **water)],
    )


@pytest.mark.parametrize("rate", [4, 6, 9, 16])
def test_what_cuts_the_water_stays_sharp(rate: int, renderer: Renderer) -> None:
    whole, shared = (renderer.render(pool(r, waves=sines(0.05)), size=SIZE) for r in (1, rate))
    dry = renderer.render(pool(1, waves=sines(0.05)).replace(objects=pool(1).objects[:-1]), size=SIZE)
    covered = whole.depth < dry.depth
    assert 0.5 < covered.mean() < 0.95
    assert np.mean((shared.depth < dry.depth) != covered) < 0.01
    opaque = ~covered & (shared.depth >= dry.depth)
    assert shared.radiance[opaque] == pytest.approx(whole.radiance[opaque], rel=1e-6)
    both = covered & (shared.depth < dry.depth)
    assert np.median(np.abs(shared.depth - whole.depth)[both] / whole.depth[both]) < 1e-3
    assert shared.radiance[both].mean() == pytest.approx(whole.radiance[both].mean(), rel=0.03)


def test_depth_of_level_water_is_that_of_every_pixel(renderer: Renderer) -> None:
    """Reversed depth is linear in the picture on a plane: means of blocks are exact."""
    whole, shared = (renderer.render(pool(rate), size=SIZE) for rate in (1, 6))
    off = np.abs(shared.depth - whole.depth) / whole.depth
    # At the borders of the picture and of what stands in the water some of the four blocks are missing.
    assert np.median(off) < 1e-6 and np.percentile(off, 80) < 1e-5


def test_an_even_world_stays_even(renderer: Renderer) -> None:
    """Clear water over nothing in an even sky: no block and no border of one shows."""
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 1.0, 3.0), target=(0.0, 0.0, 0.0)),
        environment=pl.Environment.constant((0.5, 0.7, 1.0)),
        objects=[pl.Water(extent_m=50.0, waves=sines(0.1), quality=BY("best", shading_rate=8), medium=1.333)],
    )
    radiance = renderer.render(scene, size=SIZE).radiance
    assert radiance == pytest.approx(np.broadcast_to((0.5, 0.7, 1.0), radiance.shape), rel=1e-4)


def test_a_camera_in_the_water_looks_for_every_pixel(renderer: Renderer) -> None:
    diver = pl.Camera(position=(0.4, -0.6, 3.0), target=(0.0, -0.1, 0.0))
    one, two = (renderer.render(pool(rate, diver, "best"), size=SIZE).radiance for rate in (1, 6))
    assert two == pytest.approx(one)


def test_blocks_cover_squares_of_level_water() -> None:
    def block(count: int, *target: float, **how: object) -> tuple[int, int]:
        return block_of(count, view_of(pl.Camera((0.0, 2.0, 0.0), target, **how), (80, 60)))

    assert block(6, 0.0, 1.8, -10.0) == (6, 1)  # along the level
    assert block(6, 0.0, 0.0, -0.1) == (3, 2) and block(4, 0.0, 0.0, -0.1) == (2, 2)  # down
    assert block(16, 0.0, 0.0, -3.464) == (5, 3)  # by 30 degrees
    assert block(6, 0.0, 1.8, -10.0, up=(1.0, 0.0, 0.0)) == (1, 6)  # a camera on its side
    assert all(block(1, 0.0, y, -1.0) == (1, 1) for y in (-5.0, 0.0, 2.0, 4.0))


@pytest.mark.parametrize("region", [(0, 0, 97, 61), (5, 7, 1, 1), (13, 20, 40, 9)])
def test_blocks_cover_all_pixels_of_a_region(region: tuple[int, int, int, int]) -> None:
    left, top, width, height = region
    for across, down in ((6, 1), (3, 2), (5, 3)):
        x, y, wide, high = divided(region, (across, down))
        assert x * across <= left and y * down <= top
        assert left + width <= (x + wide) * across < left + width + across
        assert top + height <= (y + high) * down < top + height + down


@pytest.mark.parametrize("rate", [0, 17, 1.5, "2"])
def test_rates_out_of_range_are_refused(rate: object) -> None:
    with pytest.raises(pl.SceneError, match="shading_rate"):
        BY("fast", shading_rate=rate)
