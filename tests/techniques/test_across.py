"""Techniques that see one another: pictures of water and glass in one scene."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.gpu import Device
from pellucid.optics import fresnel_dielectric
from pellucid.surroundings import Query
from water_scenes import rays

SKY = 0.7
BLACK = pl.media.water_body((1e4, 1e4, 1e4), (0.0, 0.0, 0.0), name="ink")


@pytest.fixture(scope="module")
def renderer(device: Device) -> pl.Renderer:
    return pl.Renderer(device)


def even_sky() -> pl.Environment:
    return pl.Environment.constant((SKY, SKY, SKY))


@pytest.mark.parametrize("technique", ["best", "fast"])
def test_a_tank_is_mirrored_in_a_pool_by_both_their_reflectances(renderer: pl.Renderer, technique: str) -> None:
    """Both hold ink, so that the sky alone is seen: mirrored once, by the pool, or by a side of the tank as well."""
    quality = pl.WaterQuality.of(technique, fresnel="exact", shading_rate=1)
    pool = pl.Water(level=0.0, extent_m=(40.0, 10.0), center=(0.0, 5.0), medium=BLACK, quality=quality)
    tank = pl.Water(level=1.0, extent_m=(40.0, 2.0), center=(0.0, -2.0), medium=BLACK)
    camera, size = pl.Camera(position=(0, 1.0, 4.0), target=(0, 0.0, 1.0), fov_deg=40), (24, 24)
    scene = pl.Scene(camera=camera, environment=even_sky(), objects=[pool, tank])
    picture = renderer.render(scene, size).radiance.reshape(-1, 3)
    origins, ways, _ = rays(camera, size)
    down = -ways[:, 1]
    at = origins - (origins[:, 1] / ways[:, 1])[:, None] * ways
    # Where the mirrored ray is as high as the tank's side that faces the pool
    height = down * (at[:, 2] + 1.0) / -ways[:, 2]
    first = fresnel_dielectric(down, 1.0, pool.matter.n_d)
    second = fresnel_dielectric(-ways[:, 2], 1.0, tank.matter.n_d)
    on_pool = (down > 0.0) & (at[:, 2] > 0.02) & (at[:, 2] < 4.0)
    twice, once = on_pool & (height < 0.98), on_pool & (height > 1.02)
    assert twice.sum() > 50 and once.sum() > 50
    np.testing.assert_allclose(picture[twice, 1], (SKY * first * second)[twice], rtol=2e-4)
    np.testing.assert_allclose(picture[once, 1], (SKY * first)[once], rtol=2e-4)


def test_what_stands_for_level_water_is_what_its_own_picture_shows(renderer: pl.Renderer) -> None:
    """Of a lake over a floor, with its sun and its scattered light, from above; where no sun is mirrored."""
    floor = pl.Mesh.checkerboard(8.0, squares=8, position=(0, -1.2, 0), specular=0.0)
    lake = pl.Water(level=0.0, extent_m=8.0, medium="lake")
    sun = pl.DirectionalLight(direction=(0.6, -0.7, 0.4))
    camera, size = pl.Camera(position=(0.3, 1.6, 3.0), target=(0, -0.2, -0.5), fov_deg=50), (32, 24)
    scene = pl.Scene(camera=camera, environment=pl.Environment.sky(sun_disc=False), lights=[sun], objects=[floor, lake])
    picture = renderer.render(scene, size).radiance.reshape(-1, 3)
    origins, ways, _ = rays(camera, size)
    seen = Query(renderer.surroundings).radiance(origins, ways, across=True)
    at = origins - (origins[:, 1] / ways[:, 1])[:, None] * ways
    inside = (ways[:, 1] < 0.0) & (np.abs(at[:, [0, 2]]) < 3.9).all(axis=1)
    # The outermost texels of the floor's pattern lie between two pixels.
    apart = np.abs(seen - picture).max(axis=1)[inside] / picture[inside].max()
    assert inside.sum() > 300
    assert np.quantile(apart, 0.95) < 1e-3 and apart.mean() < 1e-3


@pytest.mark.parametrize("technique", ["best", "fast"])
def test_a_ball_of_glass_is_seen_in_the_water_that_it_lies_in(renderer: pl.Renderer, technique: str) -> None:
    """Red glass of the index of water, all of it under water: it takes green and blue from the light of the floor."""
    floor = pl.Mesh.plane(8.0, position=(0, -1.0, 0), base_color=(0, 0, 0), specular=0.0, emission=(1, 1, 1))
    red = pl.media.constant(1.333, (0.0, 50.0, 50.0))
    ball = pl.RefractiveVolume.from_sdf(
        lambda x, y, z: np.sqrt(x**2 + y**2 + z**2) - 0.3, red, 32, 0.8, position=(0.0, -0.5, 0.0)
    )
    pool = pl.Water(level=0.0, extent_m=8.0, medium=1.333, technique=technique)
    camera, size = pl.Camera(position=(0, 3.0, 0.001), target=(0, 0, 0), fov_deg=40), (33, 33)
    scene = pl.Scene(camera=camera, environment=even_sky(), objects=[floor, ball, pool])
    frame = renderer.render(scene, size)
    share = fresnel_dielectric(1.0, 1.0, 1.333)
    clear = share * SKY + (1.0 - share) / 1.333**2
    middle, beside = frame.radiance[16, 16], frame.radiance[16, 2]
    np.testing.assert_allclose(middle, (clear, share * SKY, share * SKY), rtol=1e-3)
    np.testing.assert_allclose(beside, clear, rtol=2e-2)
    assert frame.depth[16, 16] == pytest.approx(3.0, abs=1e-3)  # that of the surface, not of the ball


def test_a_ball_over_water_shows_the_water_and_not_the_dry_floor(renderer: pl.Renderer) -> None:
    """Glass of the index of air shows what is behind it as if it were not there."""
    floor = pl.Mesh.plane(8.0, position=(0, -1.0, 0), base_color=(0, 0, 0), specular=0.0, emission=(1, 1, 1))
    blue = pl.media.water_body((2.0, 0.5, 0.1), (0.0, 0.0, 0.0), name="blue")
    nothing = pl.media.constant(1.0, (0.1, 0.1, 0.1))
    ball = pl.RefractiveVolume.from_sdf(
        lambda x, y, z: np.sqrt(x**2 + y**2 + z**2) - 0.3, nothing, 32, 0.8, position=(0.0, 0.6, 0.0)
    )
    pool = pl.Water(level=0.0, extent_m=8.0, medium=blue)
    camera = pl.Camera(position=(0, 3.0, 0.001), target=(0, 0, 0), fov_deg=40)
    pictures = [
        renderer.render(pl.Scene(camera=camera, environment=even_sky(), objects=objects), (33, 33)).radiance
        for objects in ([floor, pool], [floor, ball, pool])
    ]
    kept, mirrored = np.exp(-0.1 * 0.6), SKY * fresnel_dielectric(1.0, 1.0, blue.n_d)
    expected = kept * (pictures[0][16, 16] - mirrored) + kept**2 * mirrored  # the sky is mirrored through the ball, too
    np.testing.assert_allclose(pictures[1][16, 16], expected, rtol=1e-3)


def ink_ball(medium: object, **placement: object) -> pl.RefractiveVolume:
    return pl.RefractiveVolume.from_sdf(lambda x, y, z: np.sqrt(x**2 + y**2 + z**2) - 0.3, medium, 48, 0.8, **placement)


def test_from_below_a_ball_over_the_water_is_in_the_window_and_nowhere_else(renderer: pl.Renderer) -> None:
    """It swallows all that enters. Where the straight way leads to it but the level mirrors all, the floor is seen."""
    floor = pl.Mesh.plane(40.0, position=(0, -2.0, 0), base_color=(0, 0, 0), specular=0.0, emission=(1, 1, 1))
    pool = pl.Water(level=0.0, extent_m=40.0, medium=1.333)
    camera, size = pl.Camera(position=(0, -1.0, 0), target=(1.0, 0.0, 0.0), fov_deg=90), (48, 48)
    origins, ways, _ = rays(camera, size)
    up = ways[:, 1]
    steep = np.arcsin(np.minimum(1.333 * np.sqrt(1.0 - up**2), 1.0))
    for place in ((2.4, 0.4, 0.0), (1.2, 0.5, 0.0)):
        ball = ink_ball(pl.media.constant(1.0, (1e4, 1e4, 1e4)), position=place)
        scene = pl.Scene(camera=camera, environment=even_sky(), objects=[floor, pool, ball])
        picture = renderer.render(scene, size).radiance.reshape(-1, 3)[:, 1]
        entry = origins - (origins[:, 1] / np.maximum(up, 1e-9))[:, None] * ways
        bent = np.stack([1.333 * ways[:, 0], np.cos(steep), 1.333 * ways[:, 2]], axis=1)
        off = np.linalg.norm(np.cross(np.array(place) - entry, bent), axis=1) / 0.3
        straight = np.linalg.norm(np.cross(np.array(place) - origins, ways), axis=1) / 0.3
        share = fresnel_dielectric(up, 1.333, 1.0)
        total = (up > 0.25) & (share == 1.0)  # and the floor reaches as far
        window = (up > 0.01) & (share < 0.5)
        hit, missed = window & (off < 0.95), window & (off > 1.1)
        assert hit.sum() > 5 and ((total & (straight < 1.0)).sum() > 5 or place[0] < 2.0)
        np.testing.assert_allclose(picture[total], 1.0 / 1.333**2, rtol=1e-3)
        np.testing.assert_allclose(picture[hit], (share / 1.333**2)[hit], rtol=1e-3)
        np.testing.assert_allclose(picture[missed], (share / 1.333**2 + (1.0 - share) * SKY)[missed], rtol=1e-3)


def test_a_ball_drawn_in_water_is_what_stands_for_it_there(renderer: pl.Renderer) -> None:
    """Half in a pool, from below and from above: the picture of the volume against rays through its triangles."""
    floor = pl.Mesh.plane(8.0, position=(0, -1.0, 0), base_color=(0, 0, 0), specular=0.0, emission=(1, 1, 1))
    pool = pl.Water(level=0.0, extent_m=8.0, medium=1.333)
    tinted = pl.media.constant(1.5, (0.5, 1.0, 2.0))
    for place, look in (((0.0, -0.5, 2.0), (0.0, -0.2, 0.0)), ((0.0, 1.2, 1.6), (0.0, 0.0, 0.0))):
        camera, size = pl.Camera(position=place, target=look, fov_deg=24), (40, 40)
        ball = ink_ball(tinted, position=(0.0, 0.0, 0.0), dispersion=False)
        scene = pl.Scene(camera=camera, environment=even_sky(), objects=[floor, pool, ball])
        frame = renderer.render(scene, size)
        origins, ways, _ = rays(camera, size)
        seen = Query(renderer.surroundings).radiance(origins, ways, across=True)
        seen /= 1.333**2 if place[1] < 0.0 else 1.0  # a camera in water looks out through a port
        off = np.linalg.norm(np.cross(origins, ways), axis=1) / 0.3
        height = (origins + np.sum(-origins * ways, axis=1)[:, None] * ways)[:, 1]
        own = (off < 0.8) & ((height < -0.05) if place[1] < 0.0 else (height > 0.05))
        apart = np.abs(seen - frame.radiance.reshape(-1, 3))[own] / seen[own]
        assert own.sum() > 100
        assert np.median(apart) < 0.01 and np.quantile(apart, 0.9) < 0.06


def test_a_sheet_mirrors_a_tank_of_water(renderer: pl.Renderer) -> None:
    """The tank holds ink: beside that of the sky it takes all from what the sheet mirrors."""
    sheet = pl.RefractiveSheet(np.ones((4, 4, 3), np.float32), 0.2, 4.0, medium=1.333)
    tank = pl.Water(level=3.0, extent_m=(20.0, 2.0), center=(0.0, -3.0), medium=BLACK)
    camera, size = pl.Camera(position=(0, 1.0, 3.0), target=(0, 0.0, 0.0), fov_deg=20), (16, 16)
    with_tank, alone = (
        renderer.render(pl.Scene(camera=camera, environment=even_sky(), objects=objects), size).radiance[..., 1].ravel()
        for objects in ([sheet, tank], [sheet])
    )
    origins, ways, _ = rays(camera, size)
    mirrored = fresnel_dielectric(-ways[:, 1], 1.0, 1.333) * SKY
    lost = mirrored * (1.0 - fresnel_dielectric(-ways[:, 2], 1.0, tank.matter.n_d))
    on_sheet = (origins - (origins[:, 1] / ways[:, 1])[:, None] * ways)[:, 2] > -1.9
    assert on_sheet.sum() > 100
    np.testing.assert_allclose((alone - with_tank)[on_sheet], lost[on_sheet], rtol=5e-3)
