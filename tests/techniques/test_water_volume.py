"""Light that water scatters on a straight way: the closed forms against sums, and beams that waves and meshes cut."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric, henyey_greenstein
from pellucid.scene.water_quality import WaterQuality
from water_scenes import rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (24, 16)
SUN = (0.5, -0.8, 0.2)
COASTAL = pl.media.get("coastal")
N, G = COASTAL.n_d, COASTAL.asymmetry
ABSORBED, SCATTERED = np.array(COASTAL.absorption_rgb_per_m), np.array(COASTAL.scattering_rgb_per_m)


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def seen(renderer: Renderer, *objects: object, waves: object = None, **quality: object) -> tuple[np.ndarray, pl.Scene]:
    """(N, 3) what a camera in the water sees over a black floor: radiance there over n^2."""
    floor = pl.Mesh.plane(60.0, position=(0, -6, 0), base_color=(0, 0, 0), specular=0.0)
    water = pl.Water(extent_m=50.0, medium=COASTAL, waves=waves, quality=WaterQuality(caustic_size=64, **quality))
    scene = pl.Scene(
        camera=pl.Camera(position=(0, -2.0, 3), target=(0, -3.0, 0), fov_deg=45),
        environment=pl.Environment.constant((0.0, 0.0, 0.0)),
        lights=[pl.DirectionalLight(direction=SUN, irradiance=2.0)],
        objects=[floor, water, *objects],
    )
    return renderer.render(scene, size=SIZE).radiance.reshape(-1, 3).astype(np.float64), scene


def test_light_scattered_once_is_the_sum_over_the_way(renderer: Renderer) -> None:
    found, scene = seen(renderer)
    sun = -np.array(SUN) / np.linalg.norm(SUN)
    inner = np.array([sun[0] / N, 0.0, sun[2] / N])
    inner[1] = np.sqrt(1.0 - inner @ inner)
    origins, ways, _ = rays(scene.camera, SIZE)
    floor = np.where(ways[:, 1] < 0.0, (-6.0 - origins[:, 1]) / np.minimum(ways[:, 1], -1e-9), np.inf)
    below = np.isfinite(floor) & (floor < 15.0)
    assert below.sum() > 100
    flux = 2.0 * (1.0 - fresnel_dielectric(sun[1], 1.0, N)) * sun[1] / inner[1]
    for origin, way, length, radiance in zip(origins[below], ways[below], floor[below], found[below], strict=True):
        s = (np.arange(4000) + 0.5) / 4000 * length
        cosine = inner @ way
        turned = 1.0 + 0.5 * (1.0 - cosine) * (0.5 * (1.0 - G) - 1.0)
        lost = ABSORBED + turned * SCATTERED
        fade = ABSORBED + 0.5 * (1.0 - G) * SCATTERED
        depth = (-origin[1] - s * way[1]) / inner[1]
        beam = np.exp(-lost[:, None] * s - fade[:, None] * depth).mean(axis=1) * length
        expected = flux * SCATTERED * henyey_greenstein(cosine, G) * beam / N**2
        np.testing.assert_allclose(radiance, expected, rtol=2e-3)


def test_beams_under_level_water_are_as_bright_as_without_a_march(renderer: Renderer) -> None:
    plain, _ = seen(renderer)
    marched, _ = seen(renderer, god_rays=True)
    np.testing.assert_allclose(marched, plain, rtol=5e-3)


def test_waves_cut_beams_whose_mean_stays_and_meshes_throw_shadows_into_them(renderer: Renderer) -> None:
    plain, _ = seen(renderer)
    wavy, _ = seen(renderer, waves=sines(0.15), god_rays=True)
    assert wavy.mean() == pytest.approx(plain.mean(), rel=0.06)
    assert np.std(wavy / plain) > 0.02
    roof = pl.Mesh.plane(48.0, position=(0, 0.5, 0), **{"base_color": (0, 0, 0), "specular": 0.0})
    dark, _ = seen(renderer, roof, god_rays=True)
    assert dark.mean() < 0.02 * plain.mean()


def test_the_thesis_goes_towards_one_colour(renderer: Renderer) -> None:
    found, scene = seen(renderer, color="mihalik")
    origins, ways, _ = rays(scene.camera, SIZE)
    floor = np.where(ways[:, 1] < 0.0, (-6.0 - origins[:, 1]) / np.minimum(ways[:, 1], -1e-9), np.inf)
    near = floor < 15.0
    expected = (1.0 - np.exp(-0.5 * floor[near]))[:, None] * np.array([0.0, 0.2, 0.1])
    np.testing.assert_allclose(found[near], expected, rtol=1e-3, atol=1e-5)


def expected_of_the_sky(pixels: np.ndarray, p: np.ndarray, way: np.ndarray, length: float) -> np.ndarray:
    """(3,) radiance that a way of some metres gains from the sky through level water: sum over window and way."""
    rim, counts = np.arcsin(1.0 / N), (60, 120)
    theta = rim * (np.arange(counts[0]) + 0.5) / counts[0]
    phi = 2.0 * np.pi * (np.arange(counts[1]) + 0.5) / counts[1] - np.pi
    t, f = (part.ravel() for part in np.meshgrid(theta, phi, indexing="ij"))
    to_sky = np.stack([np.sin(t) * np.sin(f), np.cos(t), -np.sin(t) * np.cos(f)], axis=1)
    outer = np.arcsin(np.minimum(N * np.sin(t), 1.0))
    rows, columns = pixels.shape[:2]
    sky = pixels[(outer / np.pi * rows).astype(int), ((0.5 + f / (2.0 * np.pi)) * columns).astype(int) % columns]
    solid = np.sin(t) * rim / counts[0] * 2.0 * np.pi / counts[1]
    light = sky * (N**2 * (1.0 - fresnel_dielectric(np.cos(outer), 1.0, N)) * solid)[:, None]
    cosine = to_sky @ way
    phase = henyey_greenstein(cosine, G)
    fade = ABSORBED + 0.5 * (1.0 - G) * SCATTERED
    turned = 1.0 + 0.5 * (1.0 - cosine) * (0.5 * (1.0 - G) - 1.0)
    total = np.zeros(3)
    for s in (np.arange(200) + 0.5) / 200 * length:
        depth = -(p[1] + s * way[1]) / to_sky[:, 1]
        left = np.exp(-fade * depth[:, None] - (ABSORBED + turned[:, None] * SCATTERED) * s)
        total += (light * left * phase[:, None]).sum(axis=0) * length / 200
    return SCATTERED * total


@pytest.mark.parametrize("sky", ["even", "bright on one side"])
def test_the_sky_is_scattered_as_its_window_and_the_phase_function_say(sky: str, renderer: Renderer) -> None:
    """Looking up, past the rim of the window, level and down, three metres deep: black things end the ways."""
    pixels = np.ones((32, 64, 3))
    if sky != "even":
        pixels[:, 40:56] = 8.0  # towards +X
    p = np.array([0.0, -3.0, 0.0])
    water = pl.Water(extent_m=50.0, medium=COASTAL, quality=WaterQuality(caustic_size=16, shadows=False))
    floor = pl.Mesh.plane(60.0, position=(0, -14, 0), base_color=(0, 0, 0), specular=0.0)
    for angle in np.radians([60.0, 30.0, 10.0, -10.0, -30.0, -60.0]):
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        length = min(4.0, 2.7 / max(way[1], 1e-9))
        ball = pl.Mesh.sphere(0.05, position=tuple(p + (length + 0.05) * way), base_color=(0, 0, 0), specular=0.0)
        camera = pl.Camera(position=tuple(p), target=tuple(p + way), fov_deg=0.2)
        scene = pl.Scene(camera, pl.Environment(pixels.astype(np.float32)), [], [floor, ball, water])
        found = renderer.render(scene, size=(3, 3)).radiance[1, 1]
        # One beam for all directions: their ways to a depth differ.
        np.testing.assert_allclose(found, expected_of_the_sky(pixels, p, way, length) / N**2, rtol=0.035)
