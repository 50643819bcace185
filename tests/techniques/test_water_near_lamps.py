"""Lamps near water: what their light through waves brings to the bottom, against photons counted in float64."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric, refract
from pellucid.surroundings import Query
from pellucid.techniques.water.photons import wave_at
from water_scenes import sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

N, DEPTH, HALF = 1.333, 1.2, 2.0
WHITE = {"base_color": (1.0, 1.0, 1.0), "specular": 0.0}
POINT = pl.PointLight((0.4, 1.5, -0.3), intensity=5.0)
LAMPS: dict[str, list[Any]] = {
    "two points": [POINT, pl.PointLight((-1.2, 0.7, 0.5), intensity=2.0)],
    "a square of half a metre": [pl.AreaLight((0.2, 1.2, 0.1), (0.5, 0, 0), (0, 0, 0.5), radiance=10.0)],
    "a leaning rectangle": [pl.AreaLight((0.0, 0.8, 0.1), (0.4, -0.4, 0), (0, 0, 0.6), radiance=10.0)],
}


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def shine(renderer: Renderer, lights: list[Any], *objects: Any, waves: Any = None, **quality: Any) -> Any:
    """All that comes before a picture is drawn; gives the body of water."""
    floor = pl.Mesh.plane(12.0, position=(0, -DEPTH, 0), **WHITE)
    choices = pl.WaterQuality(caustic_size=128, **quality)
    water = pl.Water(extent_m=2.0 * HALF, medium=N, waves=waves, quality=choices)
    camera, dark = pl.Camera(position=(0, 3, 0.1), target=(0, 0, 0)), pl.Environment.constant(0.0)
    wanted = pl.Scene(camera=camera, environment=dark, lights=lights, objects=[floor, water, *objects])
    renderer._prepare(wanted, (8, 8))
    renderer._simulate(0.0)
    renderer._illuminate(wanted)
    return renderer._techniques[pl.Water].bodies[0]


def floor_light(renderer: Renderer, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """(N,) irradiance of the floor."""
    down = np.tile((0.0, -1.0, 0.0), (x.size, 1))
    points = np.stack([x.ravel(), np.full(x.size, 1e-3 - DEPTH), z.ravel()], axis=1)
    return np.asarray(np.pi * Query(renderer.surroundings).radiance(points, down)[:, 1])


def counted(body: Any, lamp: Any, bins: int, reach: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(bins, bins) irradiance of the floor by photons of one lamp, and how many there were."""
    rng = np.random.default_rng(7)
    xz = rng.uniform(-HALF, HALF, (count, 2))
    wave = wave_at(body.waves, np.zeros(2), xz)
    n = np.stack([-wave[:, 1], np.ones(count), -wave[:, 2]], axis=1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    origin = np.stack([xz[:, 0], wave[:, 0], xz[:, 1]], axis=1)
    way = np.asarray(lamp.position) - origin
    face = None
    if isinstance(lamp, pl.AreaLight):
        u, v = np.asarray(lamp.edge_u), np.asarray(lamp.edge_v)
        way = way + (rng.random((count, 1)) - 0.5) * u + (rng.random((count, 1)) - 0.5) * v
        face = np.cross(u, v)
    metres = np.linalg.norm(way, axis=1)
    way /= metres[:, None]
    intensity = lamp.intensity if face is None else lamp.radiance * np.maximum(-way @ face, 0.0)
    facing = np.maximum((n * way).sum(axis=1), 0.0)
    passed = 1.0 - fresnel_dielectric(facing, 1.0, N)
    power = intensity * passed * facing / n[:, 1] / metres**2 * (2.0 * HALF) ** 2 / count
    inside = refract(-way, n, 1.0, N).direction
    landed = origin + inside * ((-DEPTH - origin[:, 1]) / inside[:, 1])[:, None]
    borders = [[-reach, reach]] * 2
    total, _, _ = np.histogram2d(landed[:, 2], landed[:, 0], bins, borders, weights=power)
    number, _, _ = np.histogram2d(landed[:, 2], landed[:, 0], bins, borders)
    return total / (2.0 * reach / bins) ** 2, number


@pytest.mark.parametrize("name", LAMPS)
def test_the_bottom_is_lit_as_photons_through_waves_light_it(name: str, renderer: Renderer) -> None:
    bins, per, reach = 16, 6, 1.0
    body = shine(renderer, LAMPS[name], waves=sines(0.06))
    side = ((np.arange(bins * per) + 0.5) / (bins * per) * 2.0 - 1.0) * reach
    x, z = np.meshgrid(side, side)
    ours = floor_light(renderer, x, z).reshape(bins, per, bins, per).mean(axis=(1, 3))
    each = [counted(body, lamp, bins, reach, 1_000_000) for lamp in LAMPS[name]]
    expected = sum(total for total, _ in each)
    noise = np.sqrt(1.0 / each[0][1]).mean()
    error = (ours - expected) / np.maximum(expected, 0.3 * expected.mean())
    assert np.sqrt((error**2).mean()) < 1.3 * noise
    assert ours.sum() == pytest.approx(expected.sum(), rel=1e-2)  # four of the count's standard errors
    assert ours.std() == pytest.approx(expected.std(), rel=0.05)


def test_level_water_changes_nothing(renderer: Renderer) -> None:
    x, z = np.meshgrid(np.linspace(-0.9, 0.9, 12), np.linspace(-0.9, 0.9, 12))
    found = []
    for caustics in ("gpu", "none"):
        shine(renderer, [POINT], caustics=caustics)
        found.append(floor_light(renderer, x, z))
    np.testing.assert_allclose(*found, rtol=4e-3)


def test_a_sun_beside_a_lamp_keeps_its_map_and_their_light_adds_up(renderer: Renderer) -> None:
    sun = pl.DirectionalLight((0.4, -0.8, 0.3))
    x, z = np.meshgrid(np.linspace(-0.9, 0.9, 12), np.linspace(-0.9, 0.9, 12))
    under = pl.PointLight((-0.5, -0.4, 0.2), intensity=0.5)  # in the water: shines straight, and has no photons
    lights = {"all": [POINT, sun, under], "sun": [sun], "lamp": [POINT], "under": [under]}
    seen, maps = {}, {}
    for name, lamps in lights.items():
        shine(renderer, lamps, waves=sines(0.06))
        maps[name] = renderer.device.read_texture(renderer.surroundings.submersion.light_map, 0)
        seen[name] = floor_light(renderer, x, z)
    np.testing.assert_array_equal(maps["all"], maps["sun"])
    assert not maps["under"][..., :3].any() and maps["under"][..., 3].any()
    np.testing.assert_allclose(seen["all"], seen["sun"] + seen["lamp"] + seen["under"], rtol=2e-3)


def test_shadows_of_things_over_the_water_and_in_it_follow_the_bent_way(renderer: Renderer) -> None:
    lamp = np.asarray(POINT.position)

    def dark(p: np.ndarray) -> np.ndarray:
        """Where the ray of the lamp through a point over level water lands."""
        entry = lamp + (p - lamp) * lamp[1] / (lamp[1] - p[1])
        way = (entry - lamp) / np.linalg.norm(entry - lamp)
        inside = refract(way, np.array([0.0, 1.0, 0.0]), 1.0, N).direction
        return np.asarray(entry - inside * DEPTH / inside[1])

    above, below = np.array([-0.2, 0.4, 0.1]), np.array([0.75, -0.5, 0.3])
    balls = [pl.Mesh.sphere(r, position=tuple(p)) for r, p in ((0.08, above), (0.15, below))]
    shine(renderer, [POINT], *balls, waves=sines(1e-5))
    straight = lamp + (above - lamp) * (lamp[1] + DEPTH) / (lamp[1] - above[1])
    places = np.array([dark(above), straight, (-0.9, 0.0, -0.9)])
    lit = floor_light(renderer, places[:, 0], places[:, 2])
    assert lit[0] < 0.02 * lit[1] and lit[1] > 0.2 * lit[2] > 0.0
    shine(renderer, [POINT.replace(cast_shadow=False)], *balls, waves=sines(1e-5))
    assert floor_light(renderer, places[:1, 0], places[:1, 2]) > 0.5 * lit[1]
