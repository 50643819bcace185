"""Squares of pixels that share one look at the water: what they keep of the whole picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl
from water_scenes import sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (97, 61)  # no multiple of any square
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


@pytest.mark.parametrize("rate", [2, 3, 4])
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
    """Reversed depth is linear in the picture on a plane: means of squares are exact."""
    whole, shared = (renderer.render(pool(rate), size=SIZE) for rate in (1, 2))
    off = np.abs(shared.depth - whole.depth) / whole.depth
    # At the borders of the picture and of what stands in the water some of the four squares are missing.
    assert np.median(off) < 1e-6 and np.percentile(off, 80) < 1e-5


def test_an_even_world_stays_even(renderer: Renderer) -> None:
    """Clear water over nothing in an even sky: no square and no border of one shows."""
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 1.0, 3.0), target=(0.0, 0.0, 0.0)),
        environment=pl.Environment.constant((0.5, 0.7, 1.0)),
        objects=[pl.Water(extent_m=50.0, waves=sines(0.1), quality=BY("best", shading_rate=3), medium=1.333)],
    )
    radiance = renderer.render(scene, size=SIZE).radiance
    assert radiance == pytest.approx(np.broadcast_to((0.5, 0.7, 1.0), radiance.shape), rel=1e-4)


def test_a_camera_in_the_water_looks_for_every_pixel(renderer: Renderer) -> None:
    diver = pl.Camera(position=(0.4, -0.6, 3.0), target=(0.0, -0.1, 0.0))
    one, two = (renderer.render(pool(rate, diver, "best"), size=SIZE).radiance for rate in (1, 2))
    assert two == pytest.approx(one)


@pytest.mark.parametrize("rate", [0, 5, 1.5, "2"])
def test_rates_out_of_range_are_refused(rate: object) -> None:
    with pytest.raises(pl.SceneError, match="shading_rate"):
        BY("fast", shading_rate=rate)
