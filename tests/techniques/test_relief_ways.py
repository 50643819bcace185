"""Rays that go on after they have left the translucent layer, and the cut of a relief at an open border."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric

CLEAR = {"absorption": (0.0, 0.0, 0.0)}


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def sky_between(low_deg: float, high_deg: float) -> pl.Environment:
    """Radiance 1 from these elevations, 0 from elsewhere."""
    elevation = 90.0 - (np.arange(360) + 0.5) / 360 * 180.0
    lit = (elevation > low_deg) & (elevation < high_deg)
    return pl.Environment(np.broadcast_to(lit[:, None, None], (360, 720, 3)).astype(np.float32))


def domes(radius: float = 0.3, top_m: float = 0.03, size: int = 64) -> pl.ReliefLayer:
    v, u = (np.mgrid[0:size, 0:size] + 0.5) / size - 0.5
    q = 1.0 - (u**2 + v**2) / radius**2
    return pl.ReliefLayer(np.where(q > 0.0, top_m * np.sqrt(np.maximum(q, 0.0)), np.maximum(0.2 * q, -0.02)))


@pytest.mark.parametrize("search", ["cone", "max_mip"])
def test_domes_vanish_on_a_white_plain_under_a_sky_without_light_from_below(renderer: pl.Renderer, search: str) -> None:
    """Rays upwards see 1, and so do rays downwards, if they find the plain: also those that left a dome through its far
    side, and went in again at the next."""
    plain = pl.ReliefLayer(0.0, colors=(1.0, 1.0, 1.0), specular=0.0)
    quality = pl.ReliefQuality(search=search, reflection="search", environment="map")
    item = pl.ReliefSurface.plane(8.0, plain, domes(), medium=1.5, tile_m=0.1, quality=quality, edges="extend", **CLEAR)
    camera = pl.Camera(position=(0.3, 0.1, -0.35), target=(0.1, 0.0, 0.0), fov_deg=30.0)
    seen = renderer.render(pl.Scene(camera, sky_between(0.0, 90.0), objects=[item]), size=(96, 72)).radiance
    below = seen[8:]
    assert np.isfinite(below).all()
    # What mirrors or passes within a degree of the horizon is blurred with the dark below it.
    assert (np.abs(below - 1.0) < 0.02).all(axis=-1).mean() > 0.99
    assert below.min() > 0.6


def slab(n: float, **look: Any) -> pl.ReliefSurface:
    black = pl.ReliefLayer(-0.5, colors=(0.0, 0.0, 0.0), specular=0.0)
    cover = pl.ReliefLayer(0.0, roughness=0.0)
    quality = pl.ReliefQuality(environment="map")
    return pl.ReliefSurface.plane((2.0, 8.0), black, cover, medium=n, quality=quality, **CLEAR, **look)


def towards_the_cut(angle_deg: float) -> pl.Camera:
    """Looks down along +x at what lies 0.1 m before the border x = 1."""
    a = np.radians(angle_deg)
    place = (0.9 - 2.0 * float(np.sin(a)), 2.0 * float(np.cos(a)), 0.0)
    return pl.Camera(position=place, target=(0.9, 0, 0), up=(0, 0, 1), orthographic_height_m=0.02, far_m=9.0)


def test_light_leaves_through_the_cut_as_snell_says(renderer: pl.Renderer) -> None:
    n, angle = 1.2, np.radians(60.0)
    down = np.sqrt(n**2 - np.sin(angle) ** 2)  # sine of the angle outside the cut: what runs along it is kept
    elevation = -float(np.degrees(np.arcsin(down)))
    mirrored = float(fresnel_dielectric(np.cos(angle), 1.0, n))
    for low, high, wanted in ((-3.0, 3.0, 1.0 - mirrored), (-20.0, -4.0, 0.0), (4.0, 20.0, 0.0)):
        sky = sky_between(elevation + low, elevation + high)
        seen = renderer.render(pl.Scene(towards_the_cut(60.0), sky, objects=[slab(n)]), size=(9, 9)).radiance[4, 4]
        np.testing.assert_allclose(seen, wanted, atol=0.01)


def test_what_comes_in_from_above_cannot_leave_glass_through_an_upright_cut(renderer: pl.Renderer) -> None:
    """The sine to the normal is at most 1 / n, so the sine to that of the cut is at least sqrt(1 - 1 / n^2) > 1 / n."""
    for angle in (20.0, 60.0, 80.0):
        scene = pl.Scene(towards_the_cut(angle), sky_between(-90.0, 0.0), objects=[slab(1.5)])
        assert renderer.render(scene, size=(9, 9)).radiance.max() < 0.01


def test_fewer_pieces_end_on_what_lies_below(renderer: pl.Renderer) -> None:
    plain = pl.ReliefLayer(0.0, colors=(1.0, 1.0, 1.0), specular=0.0)
    camera = pl.Camera(position=(0.3, 0.1, -0.35), target=(0.1, 0.0, 0.0), fov_deg=30.0)
    for pieces in (1, 2, 16):
        quality = pl.ReliefQuality(refraction_pieces=pieces, environment="map")
        item = pl.ReliefSurface.plane(8.0, plain, domes(), medium=1.5, tile_m=0.1, quality=quality, **CLEAR)
        seen = renderer.render(pl.Scene(camera, pl.Environment.constant(1.0), objects=[item]), size=(64, 48))
        np.testing.assert_allclose(seen.radiance, 1.0, rtol=0.005)


def test_the_cut_of_stone_has_one_colour_deep_down_and_light_as_a_flat_wall(renderer: pl.Renderer) -> None:
    """Above the border there are stripes, ridges and their shadows; none of them is drawn out over the cut."""
    stripes = np.where(np.arange(64)[None, :, None] % 2 < 1, 0.8, 0.2) * np.ones((64, 1, 3))
    ridges = np.where(np.arange(64) % 8 < 4, 0.05, 0.0)[None, :] * np.ones((64, 1))
    ridges[16, 16] = -0.5  # so deep does the hull go
    stone = pl.ReliefLayer(ridges, colors=stripes, specular=0.0)
    item = pl.ReliefSurface.plane(1.0, stone, quality=pl.ReliefQuality(shadows="hard", occlusion="texture"))
    lamp = pl.DirectionalLight(direction=(-0.8, -0.36, -0.48), irradiance=1.0)
    camera = pl.Camera(position=(0, -0.25, 2), target=(0, -0.25, 0), orthographic_height_m=0.5, far_m=5.0)
    row = renderer.render(pl.Scene(camera, pl.Environment.constant(0.0), [lamp], [item]), size=(32, 32)).radiance[28]
    np.testing.assert_allclose(row, 0.5 / np.pi * 0.48, rtol=0.01)
