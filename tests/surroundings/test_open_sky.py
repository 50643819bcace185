"""What meshes hide of the sky from surfaces in water, against rays counted one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric
from pellucid.surroundings import Query
from pellucid.surroundings.open_sky import filled
from water_scenes import Still, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

N, HALF, DEPTH, RIM = 1.333, 1.0, 0.8, 0.2
MATT: dict[str, Any] = {"specular": 0.0, "roughness": 1.0}
BALL = pl.Mesh.sphere(0.25, 48, position=(0.2, -0.45, 0.1), base_color=(1e-3,) * 3, **MATT)

UPPER = pl.Environment(np.concatenate([np.ones((32, 128, 3)), np.zeros((32, 128, 3))]).astype(np.float32))


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def pool(albedo: float = 1e-3) -> list[pl.Mesh]:
    """A floor and four walls that stand over the water."""
    high, up = DEPTH + RIM, 0.5 * (RIM - DEPTH)
    color = {"base_color": (albedo,) * 3, **MATT}
    sides = [((0.0, up, -HALF), (90.0, 0.0, 0.0)), ((0.0, up, HALF), (-90.0, 0.0, 0.0))]
    walls = [pl.Mesh.plane((2 * HALF, high), position=p, rotation=turn, **color) for p, turn in sides]
    sides = [((-HALF, up, 0.0), (0.0, 0.0, -90.0)), ((HALF, up, 0.0), (0.0, 0.0, 90.0))]
    walls += [pl.Mesh.plane((high, 2 * HALF), position=p, rotation=turn, **color) for p, turn in sides]
    return [pl.Mesh.plane(2 * HALF, position=(0, -DEPTH, 0), **color), *walls]


def prepare(renderer: Renderer, *meshes: pl.Mesh, shadows: bool = True, **kept: Any) -> None:
    water = pl.Water(extent_m=2 * HALF, medium=N, quality=pl.WaterQuality(shadows=shadows), **kept)
    camera = pl.Camera((0, 2, 2), (0, 0, 0))
    scene = pl.Scene(camera=camera, environment=UPPER, objects=[*meshes, water])
    renderer._prepare(scene, (8, 8))
    renderer._simulate(0.0)
    renderer._illuminate(scene)


def seen_share(renderer: Renderer, p: np.ndarray, n: np.ndarray, count: int = 2000) -> float:
    """Of the irradiance by an even sky through level water, the share that rays find unhidden."""
    k = np.arange(count) + 0.5
    sine, turn = np.sqrt(k / count), k * np.pi * (3.0 - np.sqrt(5.0))
    above = np.stack([sine * np.cos(turn), np.sqrt(1.0 - sine**2), sine * np.sin(turn)], axis=1)
    inside = above * (1.0 / N, 0.0, 1.0 / N)
    inside[:, 1] = np.sqrt(1.0 - (inside**2).sum(axis=1))
    weight = (1.0 - fresnel_dielectric(above[:, 1], 1.0, N)) * np.maximum(inside @ n, 0.0) / inside[:, 1]
    start = np.tile(p + 1e-3 * n, (count, 1))
    wet_m = -start[:, 1] / inside[:, 1]
    query = Query(renderer.surroundings)
    under = query.hits(start, inside)
    hidden = (under["valid"] != 0) & (under["t"] < wet_m)
    hidden |= query.hits(start + wet_m[:, None] * inside, above)["valid"] != 0
    return float((weight * ~hidden).sum() / weight.sum())


def test_walls_and_a_ball_hide_as_much_of_the_sky_as_rays_say(renderer: Renderer) -> None:
    up, aside = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    places = [(np.array([x, -DEPTH, z]), up) for x in (-0.9, -0.4, 0.0, 0.5, 0.9) for z in (-0.8, 0.1, 0.5)]
    places += [(np.array([-HALF, y, z]), aside) for y in (-0.5, -0.2) for z in (-0.6, 0.3)]
    places += [(np.array(BALL.position) + 0.25 * n, n) for n in (up, aside)]
    points, normals = (np.array(part) for part in zip(*places, strict=True))
    light = []
    for shadows in (False, True):
        prepare(renderer, *pool(), BALL, shadows=shadows)
        light.append(Query(renderer.surroundings).radiance(points + 1e-3 * normals, -normals)[:, 1])
    expected = np.array([seen_share(renderer, p, n) for p, n in places])
    found = light[1] / light[0]
    assert expected.min() < 0.4 and expected.max() > 0.9
    # A twenty-fourth of the sky is what one ray of a place tells.
    assert np.abs(found - expected).mean() < 1.0 / 24.0
    assert np.abs(found - expected).max() < 0.1
    assert (found - expected).mean() == pytest.approx(0.0, abs=0.02)


def test_a_white_pool_throws_back_what_it_hides(renderer: Renderer) -> None:
    up = np.array([[0.0, 1.0, 0.0]])
    light = {}
    for albedo in (0.001, 0.5, 1.0):
        for shadows in (False, True):
            prepare(renderer, *pool(albedo), shadows=shadows)
            point = np.array([[-0.8, 1e-3 - DEPTH, -0.8]])
            light[albedo, shadows] = Query(renderer.surroundings).radiance(point, -up)[0, 1]
    shares = [light[albedo, True] / light[albedo, False] for albedo in (0.001, 0.5, 1.0)]
    assert shares[0] < shares[1] < shares[2] == pytest.approx(1.0, abs=2e-3)
    assert shares[1] == pytest.approx(shares[0] / (1.0 - 0.5 * (1.0 - shares[0])), rel=0.01)


def test_rays_are_sent_when_meshes_move_and_only_then(renderer: Renderer) -> None:
    sky = renderer.surroundings.submersion.open_sky
    meshes = [*pool(), BALL]
    waves = sines(0.02)
    prepare(renderer, *meshes, waves=waves)
    runs, settled = sky.ray_runs, renderer.surroundings.submersion.settled
    moved = Still(np.roll(waves.heights, 5, axis=1))
    prepare(renderer, *meshes, waves=moved)
    assert (sky.ray_runs, renderer.surroundings.submersion.settled) == (runs, settled)
    prepare(renderer, *meshes[:-1], BALL.replace(position=(0.1, -0.45, 0.1)), waves=moved)
    assert sky.ray_runs == runs + 1 and renderer.surroundings.submersion.settled > settled


def test_places_in_matter_have_what_is_round_them() -> None:
    values = np.zeros((8, 4, 8, 1), np.float32)
    valid = np.ones((8, 4, 8), bool)
    values[:, 2:] = 0.75
    valid[:, :2] = False  # below a floor
    whole = filled(values, valid)
    assert np.allclose(whole, 0.75)
    assert np.array_equal(filled(values, np.zeros_like(valid)), values)
