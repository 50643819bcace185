"""Light at a water surface: Snell, Fresnel, the window from below, and nothing lost where nothing is absorbed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.optics.snell import critical_angle, refract
from water_scenes import Still, rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

N = 1.333
SIZE = (48, 36)
UP = np.array([0.0, 1.0, 0.0])


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def half_sky(above: float, below: float) -> pl.Environment:
    """One radiance above the horizon, another below."""
    pixels = np.full((256, 512, 3), below, np.float32)
    pixels[:128] = above
    return pl.Environment(pixels)


def camera_at(position: tuple[float, float, float], target: tuple[float, float, float], **look: float) -> pl.Camera:
    return pl.Camera(position=position, target=target, **({"fov_deg": 60.0, "near_m": 0.01} | look))


@pytest.mark.parametrize("wavy", [False, True])
@pytest.mark.parametrize(
    "camera",
    [
        camera_at((0, 1, 2), (0, 0, 0)),
        camera_at((0, -1, 2), (0, 0, 0)),
        camera_at((0, -0.5, 0), (0.1, 1, 0), fov_deg=120.0),
        camera_at((0, 0, 1), (0, 0, 0)),
        camera_at((9, -0.5, 9), (0, -0.2, 0)),
        camera_at((2, 3, 2), (0, 0, 0), orthographic_height_m=3.0),
    ],
    ids=["above", "below", "looking up", "in the surface", "from the side", "orthographic"],
)
def test_lossless_water_vanishes_in_an_even_sky(wavy: bool, camera: pl.Camera, renderer: Renderer) -> None:
    water = pl.Water(extent_m=8.0, medium=N, waves=sines(0.1) if wavy else None)
    sky = pl.Environment.constant((0.3, 0.5, 0.7))
    frame = renderer.render(pl.Scene(camera=camera, environment=sky, objects=[water]), size=SIZE)
    assert frame.radiance == pytest.approx(np.broadcast_to((0.3, 0.5, 0.7), frame.radiance.shape), rel=1e-4)


@pytest.mark.parametrize("wavy", [False, True])
@pytest.mark.parametrize("height", [1.0, -0.5], ids=["above", "below"])
def test_white_things_in_lossless_water_vanish_in_an_even_sky(wavy: bool, height: float, renderer: Renderer) -> None:
    white: dict[str, Any] = {"base_color": (1, 1, 1), "specular": 0.0}
    floor, ball = (
        pl.Mesh.plane(60.0, position=(0, -1, 0), **white),
        pl.Mesh.sphere(0.4, position=(0.3, -0.1, 0), **white),
    )
    water = pl.Water(extent_m=58.0, medium=N, waves=sines(0.1) if wavy else None)
    sky = pl.Environment.constant((0.3, 0.5, 0.7))
    camera = camera_at((0, height, 2), (0, -0.2, 0))
    frame = renderer.render(pl.Scene(camera=camera, environment=sky, objects=[floor, ball, water]), size=SIZE)
    off = np.abs(frame.radiance / (0.3, 0.5, 0.7) - 1.0).max(axis=2) > 1e-3
    # Shading knows waves from a map of their heights: at a waterline a point may be on its other side.
    assert off.sum() <= (3 if wavy else 0)


@pytest.mark.parametrize("height", [0.8, -0.6], ids=["above", "below"])
def test_water_with_the_index_of_air_vanishes(height: float, renderer: Renderer) -> None:
    stage = [
        pl.Mesh.checkerboard(8.0, squares=16, position=(0, -1.2, 0)),
        pl.Mesh.sphere(0.4, position=(0.3, 0.1, 0), base_color=(0.8, 0.1, 0.1)),
    ]
    # Photons would tell apart the slopes of these coarse waves from those of their heights.
    plain = pl.WaterQuality(caustics="none")
    scene = pl.Scene(
        camera=camera_at((0, height, 2.5), (0, -0.2, 0)),
        environment=pl.Environment.sky(),
        lights=[pl.DirectionalLight(direction=(0.6, -0.7, 0.4))],
        objects=[*stage, pl.Water(extent_m=9.0, medium=1.0, waves=sines(0.1), quality=plain)],
    )
    with_water = renderer.render(scene, size=SIZE).radiance
    without = renderer.render(scene.replace(objects=stage), size=SIZE).radiance
    differs = np.abs(with_water - without).max(axis=2) > 1e-3 * without.max()
    assert differs.mean() < 0.02  # rounding, along edges


def test_the_reflectance_from_above_is_fresnels(renderer: Renderer) -> None:
    camera = camera_at((0, 1, 0), (0, 0, -1.2), fov_deg=90.0)
    scene = pl.Scene(camera=camera, environment=half_sky(1.0, 0.0), objects=[pl.Water(extent_m=1e5, medium=N)])
    frame = renderer.render(scene, size=SIZE)
    ways = rays(camera, SIZE)[1]
    down = ways[:, 1] < -0.05
    expected = fresnel_dielectric(-ways[down, 1], 1.0, N)
    assert frame.radiance.reshape(-1, 3)[down, 1] == pytest.approx(expected, abs=1e-5)


def test_the_window_from_below_is_snells(renderer: Renderer) -> None:
    assert np.degrees(critical_angle(N, 1.0)) == pytest.approx(48.61, abs=0.01)
    camera = pl.Camera(position=(0, -1, 0), target=(0, 0, 0), up=(0, 0, 1), fov_deg=115.0, near_m=0.01)
    scene = pl.Scene(camera=camera, environment=half_sky(1.0, 0.0), objects=[pl.Water(extent_m=1e4, medium=N)])
    seen = renderer.render(scene, size=(96, 96)).radiance[..., 1].reshape(-1)
    ways = rays(camera, (96, 96))[1]
    angle = np.degrees(np.arccos(ways[:, 1]))
    assert (seen[angle > 48.62] == 0.0).all()  # total reflection shows what is below: nothing
    clear = angle < 48.5  # beyond, the horizon's texels
    assert seen[clear] == pytest.approx(1.0 - fresnel_dielectric(ways[clear, 1], N, 1.0), abs=1e-4)


def test_a_submerged_grid_is_where_snell_puts_it(renderer: Renderer) -> None:
    depth, side, size = 1.5, 0.03, (96, 72)
    places = [(x, z) for x in np.linspace(-1.2, 1.2, 7) for z in np.linspace(-1.5, 1.0, 6)]
    corners = np.array([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)]) * side
    vertices = np.concatenate([corners + np.array((x, -depth, z)) for x, z in places])
    faces = np.concatenate([np.array([(0, 1, 2), (0, 2, 3)]) + 4 * k for k in range(len(places))])
    marks = pl.Mesh(vertices, faces, base_color=(0, 0, 0), emission=(1.0, 1.0, 1.0), specular=0.0)
    camera = camera_at((0, 1.2, 2.6), (0, -0.9, 0), fov_deg=55.0)
    water = pl.Water(extent_m=20.0, medium=N)
    dark = pl.Environment.constant((0, 0, 0))
    frame = renderer.render(pl.Scene(camera=camera, environment=dark, objects=[marks, water]), size=size, samples=16)
    found = 0
    for x, z in places:
        i, j = apparent(np.array([x, -depth, z]), camera, size)
        rows, columns = np.mgrid[int(j) - 2 : int(j) + 3, int(i) - 2 : int(i) + 3]
        if rows.min() < 0 or columns.min() < 0 or rows.max() >= size[1] or columns.max() >= size[0]:
            continue
        light = frame.radiance[rows, columns, 1]
        centre = (light * (columns + 0.5)).sum() / light.sum(), (light * (rows + 0.5)).sum() / light.sum()
        assert np.hypot(centre[0] - i, centre[1] - j) < 0.5
        found += 1
    assert found > 25


def apparent(point: np.ndarray, camera: pl.Camera, size: tuple[int, int]) -> tuple[float, float]:
    """Where a camera above flat water sees a point below it, pixels: the ray by Fermat's least optical path."""
    eye = np.asarray(camera.position, float)
    across = point[[0, 2]] - eye[[0, 2]]
    reach = float(np.hypot(*across))
    low, high = 0.0, reach
    for _ in range(60):
        s = 0.5 * (low + high)
        sin_air, sin_water = s / np.hypot(s, eye[1]), (reach - s) / np.hypot(reach - s, point[1])
        low, high = (s, high) if sin_air < N * sin_water else (low, s)
    x, z = eye[[0, 2]] + across * (low / reach)
    clip = camera.projection_matrix(size) @ camera.view_matrix() @ np.array([x, 0.0, z, 1.0])
    return (clip[0] / clip[3] + 1.0) * 0.5 * size[0], (1.0 - clip[1] / clip[3]) * 0.5 * size[1]


def test_absorption_goes_by_the_length_of_the_refracted_ray(renderer: Renderer) -> None:
    floor = pl.Mesh.plane(40.0, position=(0, -0.7, 0), base_color=(0, 0, 0), emission=(1, 1, 1), specular=0.0)
    ink = pl.media.constant(N, (0.3, 0.6, 1.2))
    camera = camera_at((0, 1, 2), (0, 0, 0))
    dark = pl.Environment.constant((0, 0, 0))
    water = pl.Water(extent_m=40.0, medium=ink)
    frame = renderer.render(pl.Scene(camera=camera, environment=dark, objects=[floor, water]), size=SIZE)
    ways = rays(camera, SIZE)[1]
    down = ways[:, 1] < -0.15
    inside = refract(ways[down], UP, 1.0, N).direction
    kept = np.exp(np.outer(0.7 / inside[:, 1], (0.3, 0.6, 1.2)))
    share = (1.0 - fresnel_dielectric(-ways[down, 1], 1.0, N)) / N**2
    assert frame.radiance.reshape(-1, 3)[down] == pytest.approx(share[:, None] * kept, rel=1e-3)


def test_colours_part_where_they_are_refracted_apart(renderer: Renderer) -> None:
    floor = pl.Mesh.checkerboard(12.0, squares=48, position=(0, -2.0, 0))
    water = pl.Water(extent_m=12.0, medium="water", dispersion=True)
    scene = pl.Scene(camera=camera_at((0, 1, 2), (0, 0, 0)), objects=[floor, water])
    apart = renderer.render(scene, size=SIZE).radiance
    together = renderer.render(scene.replace(objects=[floor, water.replace(dispersion=False)]), size=SIZE).radiance
    assert np.abs(apart - together).max() > 0.01
    assert apart.mean(axis=(0, 1)) == pytest.approx(together.mean(axis=(0, 1)), rel=0.02)


def test_waves_that_are_level_are_a_flat_surface(renderer: Renderer) -> None:
    scene = pl.Scene(camera=camera_at((0, 1, 2), (0, 0, 0)), objects=[pl.Water(extent_m=8.0)])
    flat = renderer.render(scene, size=SIZE)
    still = renderer.render(scene.replace(objects=[pl.Water(extent_m=8.0, waves=Still(np.zeros((8, 8))))]), size=SIZE)
    assert still.radiance == pytest.approx(flat.radiance, rel=1e-5)
