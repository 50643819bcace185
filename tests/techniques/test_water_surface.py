"""Where rays meet the surface of water: against exact intersections, from both sides."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl
from pellucid.techniques.water.reference import meet_surface, surface_height
from water_scenes import TILE, rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (64, 48)


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


VIEWS = {
    "from above": ((0.3, 1.2, 3.1), (0.0, 0.0, 0.0)),
    "grazing": ((0.1, 0.25, 3.7), (0.0, 0.12, 0.0)),
    "from below": ((0.3, -1.2, 2.1), (0.0, 0.2, 0.0)),
    "grazing from below": ((0.3, -0.3, 3.3), (0.0, -0.1, 0.0)),
}


@pytest.mark.parametrize("view", VIEWS)
def test_rays_meet_the_surface_where_they_should(view: str, renderer: Renderer) -> None:
    position, target = VIEWS[view]
    source, level = sines(0.15), 0.7
    lifted = [(x, y + level, z) for x, y, z in (position, target)]
    camera = pl.Camera(position=lifted[0], target=lifted[1], fov_deg=50, near_m=0.01)
    water = pl.Water(level=level, extent_m=400.0, waves=source)
    frame = renderer.render(pl.Scene(camera=camera, objects=[water]), size=SIZE)
    origins, ways, cosine = rays(camera, SIZE)
    exact = meet_surface(origins - (0.0, level, 0.0), ways, source.heights, TILE, t_max=20.0)
    found = frame.depth.reshape(-1) / cosine
    near = np.isfinite(exact) & (exact < 15.0)
    assert near.sum() > 300
    error = np.abs(found[near] - exact[near])
    # A crest that stands out by less than half a pixel may be passed; all else is met to rounding.
    assert np.mean(error > 1e-5 * exact[near]) < 0.005
    met = (origins + np.where(near, found, 0.0)[:, None] * ways)[near]
    height = surface_height(met[:, [0, 2]], source.heights, TILE)
    assert met[:, 1] - level == pytest.approx(height, abs=1e-4)


def test_an_orthographic_camera_sees_the_same_surface(renderer: Renderer) -> None:
    source = sines(0.15, seed=2)
    camera = pl.Camera(position=(1.0, 2.0, 2.0), target=(0, 0, 0), orthographic_height_m=2.0)
    frame = renderer.render(pl.Scene(camera=camera, objects=[pl.Water(extent_m=50.0, waves=source)]), size=SIZE)
    origins, ways, cosine = rays(camera, SIZE)
    exact = meet_surface(origins, ways, source.heights, TILE, t_max=20.0)
    assert np.mean(np.abs(frame.depth.reshape(-1) / cosine - exact) > 1e-4 * exact) < 0.01


def test_the_reference_solves_a_plane_and_a_known_wave() -> None:
    slope = np.array([0.0, -0.6, -0.8])
    assert meet_surface([(0.0, 3.0, 0.0)], [slope], np.zeros((4, 4)), TILE) == pytest.approx(5.0)
    source = sines(0.2)
    origins = np.array([(0.2, 1.0, 0.1), (1.0, -0.5, 0.3)])
    ways = np.array([(0.3, -0.5, 0.2), (0.1, 0.6, 0.4)])
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    t = meet_surface(origins, ways, source.heights, TILE)
    ends = origins + t[:, None] * ways
    assert ends[:, 1] == pytest.approx(surface_height(ends[:, [0, 2]], source.heights, TILE), abs=1e-12)
