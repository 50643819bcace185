"""Two layers of a relief against closed forms: Snell, Fresnel, absorption, a base under an interface, furnaces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric

DEPTH_M = 0.05
ABSORPTION = (6.0, 2.0, 0.0)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def layered(n: float = 1.5, color: Any = (0.7, 0.5, 0.2), **look: Any) -> pl.ReliefSurface:
    solid = pl.ReliefLayer(0.0, colors=color, specular=0.0)
    cover = pl.ReliefLayer(DEPTH_M, roughness=0.05)
    return pl.ReliefSurface.plane(2.0, solid, cover, **({"medium": n, "absorption": (0.0, 0.0, 0.0)} | look))


def view(angle_deg: float, height_m: float = 0.1) -> pl.Camera:
    a = np.radians(angle_deg)
    away = (2.0 * float(np.sin(a)), 2.0 * float(np.cos(a)), 0.0)
    return pl.Camera(position=away, target=(0, 0, 0), up=(0, 0, -1), orthographic_height_m=height_m, far_m=10.0)


def middle(renderer: pl.Renderer, scene: pl.Scene) -> np.ndarray:
    return renderer.render(scene, size=(9, 9)).radiance[4, 4].astype(float)


def through(n: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shares of diffuse light that come down to the base and back to it, by sums over cosines outside and inside."""
    m = (np.arange(200_000) + 0.5) / 200_000
    inside = np.sqrt(1.0 - (1.0 - m * m) / n**2)
    down = np.array([np.mean(2 * m * (1 - fresnel_dielectric(m, 1.0, n)) * t ** (1 / inside)) for t in y])
    back = np.array([np.mean(2 * m * fresnel_dielectric(m, n, 1.0) * t ** (2 / m)) for t in y])
    return down, back


@pytest.mark.parametrize("angle_deg", [0.0, 50.0, 75.0])
def test_flat_layers_under_an_even_sky_have_the_radiance_of_the_closed_form(
    renderer: pl.Renderer, angle_deg: float
) -> None:
    n, albedo = 1.5, np.array([0.7, 0.5, 0.2])
    item = layered(n, tuple(albedo), absorption=ABSORPTION)
    seen = middle(renderer, pl.Scene(view(angle_deg), pl.Environment.constant(2.0), objects=[item]))
    cos_i = np.cos(np.radians(angle_deg))
    cos_t = np.sqrt(1.0 - np.sin(np.radians(angle_deg)) ** 2 / n**2)
    mirrored = float(fresnel_dielectric(cos_i, 1.0, n))
    once = np.exp(-np.array(ABSORPTION) * DEPTH_M)
    down, back = through(n, once)
    base = albedo * down / (1.0 - albedo * back)
    wanted = 2.0 * (mirrored + (1.0 - mirrored) * once ** (1.0 / cos_t) * base / n**2)
    np.testing.assert_allclose(seen, wanted, rtol=0.005)


def test_flat_layers_under_a_lamp_have_the_radiance_of_the_closed_form(renderer: pl.Renderer) -> None:
    n, albedo, irradiance = 1.5, np.array([0.7, 0.5, 0.2]), 3.0
    item = layered(n, tuple(albedo), absorption=ABSORPTION)
    lamp = pl.DirectionalLight(direction=(-0.8, -0.6, 0.0), irradiance=irradiance)
    seen = middle(renderer, pl.Scene(view(40.0), pl.Environment.constant(0.0), [lamp], [item]))
    cos_i, cos_l = np.cos(np.radians(40.0)), 0.6
    cos_t, cos_lt = (np.sqrt(1.0 - (1.0 - c * c) / n**2) for c in (cos_i, cos_l))
    once = np.exp(-np.array(ABSORPTION) * DEPTH_M)
    entering = irradiance * cos_l * (1.0 - fresnel_dielectric(cos_l, 1.0, n)) * once ** (1.0 / cos_lt)
    leaving = (1.0 - fresnel_dielectric(cos_i, 1.0, n)) * once ** (1.0 / cos_t) / n**2
    wanted = leaving * entering * albedo / np.pi / (1.0 - albedo * through(n, once)[1])
    np.testing.assert_allclose(seen, wanted, rtol=0.005)


def test_a_flat_layer_shifts_what_is_below_as_snell_says(renderer: pl.Renderer) -> None:
    n, angle = 1.5, np.radians(60.0)
    ramp = np.broadcast_to(np.linspace(0.0, 0.8, 512)[None, :, None], (4, 512, 3))
    item = layered(n, ramp, tiling=False)
    scene = pl.Scene(view(60.0, height_m=1.0), pl.Environment.constant(1.0), objects=[item])
    row = renderer.render(scene, size=(33, 33)).radiance[16, :, 1].astype(float)
    mirrored = fresnel_dielectric(np.cos(angle), 1.0, n)
    down, back = (float(s[0]) for s in through(n, np.ones(1)))
    base = (row - mirrored) * n**2 / (1.0 - mirrored)  # albedo down / (1 - albedo back)
    found = base / (down + base * back) / 0.8
    # across the picture the camera's right is the world's -x, tilted
    across = (np.arange(33) + 0.5) / 33 - 0.5
    right = scene.camera.axes()[0]
    entry = across / right[0] + DEPTH_M * np.tan(angle)  # on the upper surface, metres along x
    x = entry - DEPTH_M * np.sin(angle) / np.sqrt(n**2 - np.sin(angle) ** 2)
    texel = 0.5 + x / 2.0
    inside = (texel > 0.01) & (texel < 0.99)
    assert inside.sum() > 20
    np.testing.assert_allclose(found[inside] * 511 / 512, texel[inside] - 0.5 / 512, atol=1.0 / 512)


@pytest.mark.parametrize("wave_m", [0.0, 0.01])
def test_a_lossless_layer_over_a_white_base_vanishes_in_an_even_sky(renderer: pl.Renderer, wave_m: float) -> None:
    v, u = (np.mgrid[0:64, 0:64] + 0.5) / 64 * 2.0 * np.pi
    cover = pl.ReliefLayer(0.03 + wave_m * np.sin(3 * u) * np.cos(2 * v), roughness=0.05)
    solid = pl.ReliefLayer(0.01 * np.cos(u + v), colors=(1.0, 1.0, 1.0))
    item = pl.ReliefSurface.plane(0.4, solid, cover, medium=1.5, absorption=(0.0, 0.0, 0.0))
    camera = pl.Camera(position=(0.2, 0.3, 0.3), fov_deg=45)
    frame = renderer.render(pl.Scene(camera, pl.Environment.constant(1.0), objects=[item]), size=(64, 48))
    assert np.isfinite(frame.depth).mean() > 0.3
    np.testing.assert_allclose(frame.radiance, 1.0, rtol=0.005)


def test_where_the_layers_cross_the_solid_one_is_dry(renderer: pl.Renderer) -> None:
    heights = np.where(np.arange(64)[None, :] < 32, 0.0, 0.02) * np.ones((64, 1))
    sky = pl.Environment.constant(1.0)
    solid = pl.ReliefLayer(heights, colors=(0.5, 0.5, 0.5))
    both = pl.ReliefSurface.plane(1.0, solid, pl.ReliefLayer(0.02), medium=1.5)
    alone = both.replace(translucent=None)
    camera = pl.Camera(position=(0, 2, 0), up=(0, 0, -1), orthographic_height_m=0.9, far_m=5.0)
    wet, dry = (renderer.render(pl.Scene(camera, sky, objects=[o]), size=(32, 32)).radiance for o in (both, alone))
    np.testing.assert_allclose(wet[:, 18:], dry[:, 18:], rtol=1e-5)  # where they are equally high
    assert (wet[:, :14] < 0.9 * dry[:, :14]).all()


def test_dispersion_parts_the_colours_and_loses_no_light(renderer: pl.Renderer) -> None:
    stripes = np.where(np.arange(64)[None, :, None] % 8 < 4, 1.0, 0.0) * np.ones((64, 1, 3))
    item = layered(color=stripes, medium="N-SF66", dispersion=True)
    lit = pl.Scene(view(60.0, 0.5), pl.Environment.constant(1.0), objects=[item])
    apart = renderer.render(lit, size=(48, 16)).radiance
    spread = apart.max(axis=2) - apart.min(axis=2)
    assert spread.max() > 0.01
    white = layered(color=(1.0, 1.0, 1.0), medium="N-SF66", dispersion=True)
    even = renderer.render(pl.Scene(view(60.0, 0.5), pl.Environment.constant(1.0), objects=[white]), size=(8, 8))
    np.testing.assert_allclose(even.radiance, 1.0, rtol=0.005)


def test_plane_refraction_of_flat_layers_is_that_of_the_search(renderer: pl.Renderer) -> None:
    ramp = np.broadcast_to(np.linspace(0.1, 0.8, 64)[None, :, None], (4, 64, 3))
    found = []
    for refraction in ("search", "plane"):
        item = layered(color=ramp, quality=pl.ReliefQuality(refraction=refraction))
        found.append(middle(renderer, pl.Scene(view(40.0), pl.Environment.constant(1.0), objects=[item])))
    np.testing.assert_allclose(found[0], found[1], rtol=1e-3)


def test_a_cube_of_the_scene_shows_what_rays_do(renderer: pl.Renderer) -> None:
    ways = [(0.8, 0.6, 0.0), (-0.8, 0.6, 0.0), (0.0, 0.6, 0.8), (0.0, 0.6, -0.8), (0.0, 1.0, 0.01)]
    colors = [(0.9, 0.1, 0.1), (0.1, 0.9, 0.1), (0.1, 0.1, 0.9), (0.9, 0.9, 0.1), (0.1, 0.9, 0.9)]
    things = [
        pl.Mesh.box(3.0, position=tuple(8.0 * np.array(way)), base_color=color)
        for way, color in zip(ways, colors, strict=True)
    ]
    sky = pl.Environment.constant(1.0)
    items = [
        layered(quality=pl.ReliefQuality(environment=environment), color=(0.0, 0.0, 0.0))
        for environment in ("rays", "cube_once")
    ]
    found = []
    for x, y, z in ways:
        camera = pl.Camera(position=(-2 * x, 2 * y, -2 * z), up=(0.1, 0, 1), orthographic_height_m=0.1, far_m=10.0)
        by_ray, by_cube = (middle(renderer, pl.Scene(camera, sky, objects=[item, *things])) for item in items)
        np.testing.assert_allclose(by_cube, by_ray, rtol=0.01)
        found.append(by_ray / by_ray.max())
    assert all(np.abs(a - b).max() > 0.1 for k, a in enumerate(found) for b in found[:k])
