"""Light through waves: where it is focused, that none is lost, on the device, on the CPU, and counted by photons."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric, refract
from water_scenes import Still, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

N = 1.333
WHITE = {"base_color": (1.0, 1.0, 1.0), "specular": 0.0}
SUN = (0.4, -0.8, 0.3)


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def scene(
    *objects: Any, waves: Any = None, depth: float = 1.0, lights: Any = None, size: int = 128, **quality: Any
) -> pl.Scene:
    floor = pl.Mesh.plane(8.0, position=(0, -depth, 0), **WHITE)
    water = pl.Water(extent_m=4.0, medium=N, waves=waves, quality=pl.WaterQuality(caustic_size=size, **quality))
    lights = [pl.DirectionalLight(direction=SUN)] if lights is None else lights
    dark = pl.Environment.constant((0.0, 0.0, 0.0))
    camera = pl.Camera(position=(0, 3, 0.1), target=(0, 0, 0))
    return pl.Scene(camera=camera, environment=dark, lights=lights, objects=[floor, water, *objects])


def shine(renderer: Renderer, wanted: pl.Scene) -> None:
    """All that comes before a picture is drawn."""
    renderer._prepare(wanted, (8, 8))
    renderer._simulate(0.0)
    renderer._illuminate(wanted)


def lit(renderer: Renderer, wanted: pl.Scene) -> SimpleNamespace:
    """The maps of a scene, and what made them."""
    from pellucid.scene.water import Water

    shine(renderer, wanted)
    technique, texture = renderer._techniques[Water], renderer.surroundings.submersion.light_map
    layers = range(texture.depth_or_array_layers)
    maps = [renderer.device.read_texture(texture, k).astype(np.float64) for k in layers]
    body, light = technique.bodies[0], technique._light
    tracer = light.tracer(body, light._lamps[0, 0], renderer.surroundings)
    return SimpleNamespace(maps=maps, light=light, body=body, tracer=tracer)


def floor_light(renderer: Renderer, points: Any) -> np.ndarray:
    """(N, 3) irradiance on white surfaces that face up."""
    from pellucid.surroundings import Query

    up, at = np.array([0.0, 1.0, 0.0]), np.atleast_2d(np.asarray(points, np.float64))
    return np.pi * Query(renderer.surroundings).radiance(at + 1e-3 * up, np.broadcast_to(-up, at.shape))


def ripple(amplitude_m: float, waves: int, side: int = 512) -> Still:
    """Straight waves over 4 m, with crests at the borders and in the middle: none of their light leaves the map."""
    x = 4.0 * (np.arange(side) + 0.5) / side - 2.0
    return Still(np.tile(amplitude_m * np.cos(0.5 * np.pi * waves * x), (8, 1)))


@pytest.mark.parametrize("elevation", (15.0, 50.0, 90.0))
def test_level_water_lets_through_what_fresnel_leaves_everywhere(elevation: float, renderer: Renderer) -> None:
    e = np.radians(elevation)
    sun = pl.DirectionalLight(direction=(np.cos(e), -np.sin(e), 0.0))
    passed = 1.0 - fresnel_dielectric(np.sin(e), 1.0, N)
    np.testing.assert_allclose(lit(renderer, scene(lights=[sun])).maps[0][..., :3], passed, rtol=1.5e-3)


@pytest.mark.parametrize("depth", (0.3, 1.5, 2.5))
def test_no_light_is_lost_between_surface_and_floor(depth: float, renderer: Renderer) -> None:
    sun = pl.DirectionalLight(direction=(0, -1, 0))
    found = lit(renderer, scene(waves=ripple(0.03, 4), depth=depth, lights=[sun]))
    photons = found.tracer.photons()
    assert found.maps[0][..., 1].mean() == pytest.approx(photons.flux.mean(), rel=1e-3)
    found.tracer.p["loss"] = 0.0
    assert found.tracer.light_map()[..., 1].mean() == pytest.approx(1.0, rel=1e-3)


def test_a_crest_has_its_focus_where_its_curvature_says(renderer: Renderer) -> None:
    amplitude, waves = 0.01, 4
    curvature = amplitude * (0.5 * np.pi * waves) ** 2
    focus = 1.0 / (curvature * (1.0 - 1.0 / N))
    sun = pl.DirectionalLight(direction=(0, -1, 0))
    passed = 1.0 - fresnel_dielectric(1.0, 1.0, N)
    for share in (0.3, 0.6):
        depth = share * focus
        wanted = scene(waves=ripple(amplitude, waves), depth=depth - amplitude, lights=[sun], size=256)
        row = lit(renderer, wanted).maps[0][128, :, 1] / passed
        crest = row[127:129].mean()
        assert depth / (1.0 - 1.0 / crest) == pytest.approx(focus, rel=0.03)
    wanted = scene(waves=ripple(amplitude, waves), depth=focus - amplitude, lights=[sun], size=256)
    assert lit(renderer, wanted).maps[0][128, 127:129, 1].mean() > 6.0 * passed


WAYS = {
    "rays along the light": {},
    "the iteration": {"caustic_intersection": "iteration", "steps": 3},
    "a camera along the incident light": {"caustic_camera": "incident"},
    "as in the thesis": {"caustic_camera": "incident", "caustic_intersection": "iteration", "steps": 4},
}


@pytest.mark.parametrize("way", WAYS)
def test_cpu_and_device_draw_the_same_map(way: str, renderer: Renderer) -> None:
    ball = pl.Mesh.sphere(0.4, position=(0.3, -0.5, 0.2))
    above = pl.Mesh.sphere(0.3, position=(-0.8, 0.5, -0.6))
    found = lit(renderer, scene(ball, above, waves=sines(0.06), **WAYS[way]))
    cpu, gpu = found.tracer.light_map().astype(np.float64), found.maps[0]
    assert gpu.mean(axis=(0, 1)) == pytest.approx(cpu.mean(axis=(0, 1)), rel=2e-3, abs=1e-4)
    error = np.abs(cpu - gpu)[..., 1]
    assert error.mean() < 0.01 * gpu[..., 1].mean()
    other = lit(renderer, scene(ball, above, waves=sines(0.06), caustics="cpu", **WAYS[way]))
    np.testing.assert_allclose(other.maps[0], cpu, rtol=2e-3, atol=1e-3)


def test_the_map_is_what_a_count_of_photons_finds(renderer: Renderer) -> None:
    middle, radius, depth = np.array([0.3, -0.6, 0.2]), 0.4, 1.2
    found = lit(
        renderer, scene(pl.Mesh.sphere(radius, position=tuple(middle), segments=96), waves=sines(0.06), depth=depth)
    )
    bins, count, rng = 16, 400_000, np.random.default_rng(7)
    xz = rng.uniform(-2.0, 2.0, (count, 2))
    from pellucid.techniques.water.photons import wave_at

    wave = wave_at(found.body.waves, np.zeros(2), xz)
    n = np.stack([-wave[:, 1], np.ones(count), -wave[:, 2]], axis=1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    sun = -np.array(SUN) / np.linalg.norm(SUN)
    facing = n @ sun
    flux = facing / (n[:, 1] * sun[1]) * (1.0 - fresnel_dielectric(facing, 1.0, N))
    way = refract(np.broadcast_to(-sun, n.shape), n, 1.0, N).direction
    origin = np.stack([xz[:, 0], wave[:, 0], xz[:, 1]], axis=1)
    t = (-depth - origin[:, 1]) / way[:, 1]
    to, along = origin - middle, ((origin - middle) * way).sum(axis=1)
    square = along**2 - ((to**2).sum(axis=1) - radius**2)
    t = np.where(square > 0.0, np.minimum(t, -along - np.sqrt(np.maximum(square, 0.0))), t)
    landed = origin + t[:, None] * way
    seen = landed[:, [0, 2]] - np.array(found.tracer.p["slope"]) * landed[:, 1:2]
    counted, _, _ = np.histogram2d(seen[:, 1], seen[:, 0], bins, [[-2, 2]] * 2, weights=flux)
    counted *= bins**2 / count
    mapped = found.maps[0][..., 1].reshape(bins, 128 // bins, bins, 128 // bins).mean(axis=(1, 3))
    noise = np.sqrt(bins**2 / count)  # relative, of one bin: 2.5 %
    error = (mapped - counted) / np.maximum(counted, 0.3)
    assert np.sqrt((error**2).mean()) < 1.3 * noise and np.abs(error).max() < 6.0 * noise
    assert mapped.sum() == pytest.approx(counted.sum(), rel=5e-3)


def disc_of_directions(middle: np.ndarray, radius_deg: float, rng: np.random.Generator, count: int) -> np.ndarray:
    """(N, 3) unit, evenly over a disc that faces the water."""
    aside = np.cross(middle, (0.0, 0.0, 1.0))
    aside /= np.linalg.norm(aside)
    r = np.tan(np.radians(radius_deg)) * np.sqrt(rng.random((count, 1)))
    turn = rng.uniform(0.0, 2.0 * np.pi, (count, 1))
    there = middle + r * (np.cos(turn) * aside + np.sin(turn) * np.cross(middle, aside))
    return np.asarray(there / np.linalg.norm(there, axis=1, keepdims=True))


@pytest.mark.parametrize(("radius_deg", "parts"), [(1.5, 1), (12.0, 10)])
def test_a_wide_lamp_blurs_its_map_as_a_count_of_photons_from_its_disc_does(
    radius_deg: float, parts: int, renderer: Renderer
) -> None:
    from pellucid.techniques.water.photons import wave_at

    depth, bins, count, rng = 1.2, 32, 1_000_000, np.random.default_rng(7)
    wide = pl.DirectionalLight(direction=SUN, angular_radius_deg=radius_deg)
    found = lit(renderer, scene(waves=sines(0.06), depth=depth, lights=[wide]))
    assert len(found.light._lamps[0, 0].parts) == parts
    middle = -np.array(SUN) / np.linalg.norm(SUN)
    to_lamp = disc_of_directions(middle, radius_deg, rng, count)
    xz = rng.uniform(-2.0, 2.0, (count, 2))
    wave = wave_at(found.body.waves, np.zeros(2), xz)
    n = np.stack([-wave[:, 1], np.ones(count), -wave[:, 2]], axis=1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    facing = (n * to_lamp).sum(axis=1)
    flux = facing / (n[:, 1] * middle[1]) * (1.0 - fresnel_dielectric(facing, 1.0, N)) / (to_lamp @ middle).mean()
    way = refract(-to_lamp, n, 1.0, N).direction
    landed = xz + way[:, [0, 2]] * ((-depth - wave[:, 0]) / way[:, 1])[:, None]
    seen = landed + np.array(found.tracer.p["slope"]) * depth
    counted, _, _ = np.histogram2d(seen[:, 1], seen[:, 0], bins, [[-2, 2]] * 2, weights=flux)
    counted *= bins**2 / count
    mapped = found.maps[0][..., 1].reshape(bins, 128 // bins, bins, 128 // bins).mean(axis=(1, 3))
    inner = slice(2, -2)
    error = ((mapped - counted) / np.maximum(counted, 0.3))[inner, inner]
    assert np.sqrt((error**2).mean()) < 1.15 * np.sqrt(bins**2 / count)  # their noise
    assert mapped[inner, inner].std() == pytest.approx(counted[inner, inner].std(), rel=0.03)


def test_cpu_and_device_divide_a_wide_lamp_alike(renderer: Renderer) -> None:
    wide = pl.DirectionalLight(direction=SUN, angular_radius_deg=10.0)
    found = lit(renderer, scene(waves=sines(0.06), lights=[wide]))
    cpu, gpu = found.tracer.light_map().astype(np.float64)[..., 1], found.maps[0][..., 1]
    assert np.abs(cpu - gpu).mean() < 2e-3 * gpu.mean()


def test_shadows_fall_where_refracted_light_puts_them(renderer: Renderer) -> None:
    sun = -np.array(SUN) / np.linalg.norm(SUN)
    inner = refract(-sun, np.array([0.0, 1.0, 0.0]), 1.0, N).direction
    in_water, in_air = np.array([0.5, -0.4, 0.4]), np.array([-0.9, 0.6, -0.8])
    balls = [pl.Mesh.sphere(0.15, position=tuple(p)) for p in (in_water, in_air)]
    lit(renderer, scene(*balls, depth=1.5))
    dark_water = in_water + inner * (-1.5 - in_water[1]) / inner[1]
    entry = in_air - sun * in_air[1] / sun[1]
    dark_air = entry + inner * -1.5 / inner[1]
    straight = in_water - sun * (in_water[1] + 1.5) / sun[1]
    seen = floor_light(renderer, [dark_water, dark_air, straight, (1.2, -1.5, -1.2)])[:, 1]
    assert seen[:2] == pytest.approx(0.0, abs=1e-3) and seen[2:] == pytest.approx(seen[3], rel=1e-3) and seen[3] > 1.0


def test_a_thing_that_stands_out_of_the_water_is_lit_on_both_sides_of_it(renderer: Renderer) -> None:
    post = pl.Mesh.box(0.6, position=(0.0, -0.1, 0.0), **WHITE)
    sun_alone = [pl.DirectionalLight(direction=SUN, cast_shadow=False)]
    shine(renderer, scene(post, depth=1.0, lights=sun_alone))
    from pellucid.surroundings import Query

    side = np.array([-1.0, 0.0, 0.0])
    heights = np.array([0.15, -0.2])
    points = np.stack([np.full(2, -0.3), heights, np.zeros(2)], axis=1)
    dry, under = np.pi * Query(renderer.surroundings).radiance(points + 1e-3 * side, np.tile(-side, (2, 1)))[:, 1]
    sun = -np.array(SUN) / np.linalg.norm(SUN)
    inner = refract(-sun, np.array([0.0, 1.0, 0.0]), 1.0, N).direction
    passed = 1.0 - fresnel_dielectric(sun[1], 1.0, N)
    assert dry == pytest.approx(-3.0 * sun[0], rel=1e-3)
    assert under == pytest.approx(3.0 * passed * sun[1] / -inner[1] * inner[0], rel=0.01)
    wet = lit(renderer, scene(post, depth=1.0))
    assert (wet.maps[0][60:68, 60:68, 1] == 0.0).all()  # no light enters where the post stands


def test_no_sun_no_light(renderer: Renderer) -> None:
    for lights in ([], [pl.DirectionalLight(direction=(0.3, 0.5, 0.1))]):
        shine(renderer, scene(waves=sines(0.06), lights=lights))
        height = renderer.device.read_texture(renderer.surroundings.submersion.light_map)[..., 3]
        assert np.abs(height).max() == pytest.approx(0.06, rel=0.05)
    assert not floor_light(renderer, [(0.1, -1.0, 0.2)]).any()


def test_each_lamp_has_its_own_caustic(renderer: Renderer) -> None:
    suns = [pl.DirectionalLight(direction=d, irradiance=i) for d, i in (((0.5, -1, 0), 1.0), ((-0.5, -1, 0), 2.0))]
    both = lit(renderer, scene(waves=sines(0.06), lights=suns)).maps
    points = np.array([(0.2, -1.0, 0.1), (-0.5, -1.0, 0.4)])
    together = floor_light(renderer, points)
    apart = []
    for k, sun in enumerate(suns):
        np.testing.assert_array_equal(lit(renderer, scene(waves=sines(0.06), lights=[sun])).maps[0], both[k])
        apart.append(floor_light(renderer, points))
    np.testing.assert_allclose(together, sum(apart), rtol=1e-4)


def test_blue_light_is_focused_nearer_than_red(renderer: Renderer) -> None:
    wanted = scene(waves=ripple(0.01, 4), depth=2.0, lights=[pl.DirectionalLight(direction=(0, -1, 0))], size=256)
    water = wanted.objects[1].replace(medium="water", dispersion=True)
    row = lit(renderer, wanted.replace(objects=[wanted.objects[0], water])).maps[0][128, 128, :3]
    assert row[0] < row[1] < row[2]


def test_maps_are_kept_until_something_moves(renderer: Renderer) -> None:
    wanted = scene(waves=sines(0.06))
    light = lit(renderer, wanted).light
    runs = light.photon_runs, light.depth_runs
    shine(renderer, wanted.replace(camera=pl.Camera(position=(1, 2, 0.1), target=(0, 0, 0))))
    assert (light.photon_runs, light.depth_runs) == runs
    floor, water = wanted.objects
    shine(
        renderer, wanted.replace(objects=[floor, water.replace(waves=Still(np.roll(water.waves.heights, 5, axis=1)))])
    )
    assert (light.photon_runs, light.depth_runs) == (runs[0] + 1, runs[1])
    shine(renderer, wanted.replace(lights=[pl.DirectionalLight(direction=(0.2, -1, 0))]))
    assert (light.photon_runs, light.depth_runs) == (runs[0] + 2, runs[1] + 1)


def test_without_caustics_waves_leave_the_light_as_it_is(renderer: Renderer) -> None:
    wanted = scene(waves=sines(0.06), caustics="none")
    floor, water = wanted.objects
    level = lit(renderer, wanted.replace(objects=[floor, water.replace(waves=None)])).maps[0]
    found = lit(renderer, wanted)
    np.testing.assert_allclose(found.maps[0], level, rtol=2e-3)  # half floats; meshes are seen from the highest wave
    submersion = renderer.surroundings.submersion
    before = found.light.photon_runs, submersion.version
    moved = water.replace(waves=Still(np.roll(water.waves.heights, 5, axis=1)))
    shine(renderer, wanted.replace(objects=[floor, moved]))
    assert (found.light.photon_runs, submersion.version) == before


def test_the_camera_of_the_map_does_not_change_the_light_on_the_floor(renderer: Renderer) -> None:
    x, z = np.meshgrid(np.linspace(-0.8, 0.8, 24), np.linspace(-0.8, 0.8, 24))
    points = np.stack([x.ravel(), np.full(x.size, -1.0), z.ravel()], axis=1)
    found = []
    for camera in ("refracted", "incident"):
        lit(renderer, scene(waves=sines(0.06), caustic_camera=camera, size=256, shadows=False))
        found.append(floor_light(renderer, points)[:, 1])
    assert np.abs(found[0] - found[1]).mean() < 0.03 * found[0].mean()
