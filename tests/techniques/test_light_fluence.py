"""The light simulator against closed forms and against photons, one by one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, map_coordinates

import oracles
import pellucid as pl
from pellucid.fields import shapes
from pellucid.techniques.eikonal.light_params import grid_of
from pellucid.techniques.eikonal.prepare import prepare
from pellucid.techniques.eikonal.reference import Cylinder, Limits, Matter, Sphere, World, trace_light

DOWN = pl.DirectionalLight(direction=(0, 0, -1), irradiance=2.0)
CAMERA = pl.Camera(position=(0, 0.1, 0.5))


def light_in(volume: pl.Volume, *lights: Any, **options: Any) -> Any:
    """`pellucid.illuminate` for a volume that stands alone; options of LightQuality."""
    placed = pl.RefractiveVolume(volume, light=pl.LightQuality(**options))
    return pl.illuminate(pl.Scene(camera=CAMERA, lights=list(lights), objects=[placed]), placed)


def centres(volume: pl.Volume) -> np.ndarray:
    """(Z, Y, X, 3) metres."""
    axes = [((np.arange(n) + 0.5) / n - 0.5) * e for n, e in zip(volume.shape[::-1], volume.extent_m, strict=True)]
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    return np.stack([x, y, z], axis=-1)


def empty(shape: tuple[int, int, int], **fields: Any) -> pl.Volume:
    """Index 1 everywhere in a box with voxels of 1 cm."""
    return pl.Volume.from_array(np.ones(shape), tuple(0.01 * n for n in shape[::-1]), **fields)


def off_by(found: np.ndarray, truth: np.ndarray, where: np.ndarray | None = None) -> float:
    """Root of the mean square of the difference, relative to that of the truth."""
    where = np.ones(truth.shape[:3], bool) if where is None else where
    return float(np.sqrt(np.square(found - truth)[where].mean() / np.square(truth)[where].mean()))


# ---- closed forms -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("direction", [(0, 0, -1), (1, 0, 0), (0.4, -0.7, 0.3)])
def test_an_empty_volume_keeps_the_fluence(direction: tuple[float, float, float]) -> None:
    light = light_in(empty((12, 16, 20)), pl.DirectionalLight(direction, color=(1.0, 0.5, 0.25), irradiance=2.0))
    expected = np.broadcast_to(2.0 * np.array([1.0, 0.5, 0.25]), light.fluence.shape)
    way = np.asarray(direction) / np.linalg.norm(direction)
    inner = np.s_[2:-2, 2:-2, 2:-2]  # tubes end in a straight cut where they leave at an angle, right on average only
    assert off_by(light.fluence[inner], expected[inner]) < 0.01
    assert off_by(light.fluence, expected) < 0.08
    assert light.fluence.mean((0, 1, 2)) == pytest.approx(expected[0, 0, 0], rel=2e-3)
    assert np.abs(light.direction - way).max() < 0.01
    assert light.flux_out == pytest.approx(light.flux_in, rel=1e-4)


def test_the_grid_is_that_of_the_volume_even_where_a_body_reaches_the_faces_of_its_box() -> None:
    rod = pl.Volume.from_sdf(lambda x, y, z: np.hypot(x, y) - 0.02 + 0.0 * z, 1.5, 24, (0.06, 0.08, 0.04))
    light = light_in(rod, DOWN)
    assert light.fluence.shape == light.direction.shape == (*rod.shape, 3)
    outside = np.hypot(*np.moveaxis(centres(rod)[..., :2], -1, 0)) > 0.027
    assert light.fluence[outside] == pytest.approx(2.0, rel=0.1)


def test_the_flux_that_enters_is_that_of_the_lit_faces() -> None:
    """Irradiance times projected area, in world metres."""
    volume, direction = empty((12, 16, 20)), np.array([0.4, -0.7, 0.3])
    placed = pl.RefractiveVolume(volume, scale=3.0, rotation=(0, 0, 90))
    lamp = pl.DirectionalLight(tuple(direction), irradiance=2.0)
    light = pl.illuminate(pl.Scene(camera=CAMERA, lights=[lamp], objects=[placed]), placed)
    x, y, z = 3.0 * np.array([0.16, 0.20, 0.12])  # a quarter turn about z exchanges x and y
    area = np.abs(direction / np.linalg.norm(direction)) @ [y * z, x * z, x * y]
    assert light.flux_in == pytest.approx(np.full(3, 2.0 * area), rel=1e-3)


@pytest.mark.parametrize("position", [(0.0, 0.02, 0.13), (0.05, 0.0, -0.01)], ids=["outside", "inside"])
def test_a_point_light_falls_with_the_square_of_the_distance(position: tuple[float, float, float]) -> None:
    volume = empty((20, 20, 20))
    light = light_in(volume, pl.PointLight(position, intensity=0.3))
    away = centres(volume) - position
    square = (away**2).sum(-1)
    far = square > 0.04**2  # nearer, 1/d^2 is not constant within a voxel
    far[:2], far[-2:] = False, False  # where tubes begin and end in straight cuts
    far[:, :2], far[:, -2:], far[:, :, :2], far[:, :, -2:] = False, False, False, False
    expected = np.repeat((0.3 / square)[..., None], 3, -1)
    assert off_by(light.fluence, expected, far) < 0.06
    assert light.fluence[far].mean() == pytest.approx(expected[far].mean(), rel=0.01)
    assert np.abs(light.direction - away / np.sqrt(square)[..., None])[far].mean() < 0.05  # cells of two voxels


def test_a_lamp_inside_the_box_gives_all_its_light() -> None:
    light = light_in(empty((12, 12, 12)), pl.PointLight((0.01, 0.0, 0.02), intensity=0.3))
    assert light.flux_in == pytest.approx(np.full(3, 4.0 * np.pi * 0.3), rel=2e-3)
    assert light.flux_out == pytest.approx(light.flux_in, rel=1e-3)


def test_absorption_is_exact() -> None:
    """Fluence is the mean of exp(-sigma s) over each voxel of an index-matched slab, and over the fields of a box."""
    sigma = np.array([5.0, 20.0, 80.0])
    mean = -np.diff(np.exp(-np.arange(17)[:, None] * 0.01 * sigma), axis=0) / (0.01 * sigma)
    field = np.broadcast_to(sigma, (16, 12, 12, 3))
    body = pl.Volume.from_sdf(shapes.box((0.3, 0.3, 0.12)), pl.media.resolve(1.0).with_absorption(sigma), 16, 0.16)
    in_field = light_in(empty((16, 12, 12), absorption=field), DOWN)
    in_body = light_in(body, DOWN)
    assert in_field.fluence[::-1, 5, 5] == pytest.approx(2.0 * mean, rel=5e-3, abs=2e-4)
    assert in_body.fluence[13:1:-1, 8, 8] == pytest.approx(2.0 * mean[:12], rel=5e-3, abs=2e-4)
    assert in_field.flux_absorbed / in_field.flux_in == pytest.approx(1.0 - np.exp(-0.16 * sigma), rel=1e-3)
    assert in_body.flux_absorbed == pytest.approx(2.0 * 0.16**2 * (1.0 - np.exp(-0.12 * sigma)), rel=5e-3)


def test_what_is_absorbed_is_the_extinction_times_the_fluence() -> None:
    sigma = np.array([4.0, 9.0, 2.0])
    n = shapes.luneburg(0.05)(*np.moveaxis(centres(empty((24, 24, 24))) * 0.5, -1, 0))
    volume = pl.Volume.from_array(n, 0.12, absorption=np.broadcast_to(sigma, (24, 24, 24, 3)))
    light = light_in(volume, pl.DirectionalLight((0.2, -0.3, -1.0), irradiance=2.0))
    assert light.fluence.sum((0, 1, 2)) * 0.005**3 * sigma == pytest.approx(light.flux_absorbed, rel=5e-3)


def test_a_luneburg_lens_focuses_on_its_rim() -> None:
    radius, count = 0.04, 48
    volume = pl.Volume.from_function(shapes.luneburg(radius), count, 0.1)
    light = light_in(volume, DOWN)
    k, j, i = np.unravel_index(np.argmax(light.fluence[..., 1]), volume.shape)
    assert np.linalg.norm(centres(volume)[k, j, i] - [0, 0, -radius]) < 1.0 * 0.1 / count
    assert light.fluence[k, j, i, 1] > 50 * 2.0


def test_a_glass_ball_has_its_focus_where_snell_puts_it() -> None:
    """The waist of the beam, within one voxel. An aperture of opaque voxels lets the middle of the light through."""
    count, extent, radius, n = 48, 0.1, 0.02, 1.5
    ball = pl.Volume.from_sdf(shapes.sphere(radius), n, count, extent)
    place = centres(ball)
    stop = np.zeros((*ball.shape, 4), np.float32)
    stop[-2, ..., 3] = np.hypot(place[-2, ..., 0], place[-2, ..., 1]) > 0.45 * radius
    light = light_in(ball.replace(opaque=stop), DOWN, bounces=2)
    square = np.square(place[..., 0]) + np.square(place[..., 1])
    weight = light.fluence[..., 1] * (square < (0.5 * radius) ** 2)
    slices = place[:, 0, 0, 2]
    behind = (slices < -1.1 * radius) & (slices > -1.9 * radius)
    spread = (weight * square).sum((1, 2))[behind] / weight.sum((1, 2))[behind]
    second, first, _ = np.polyfit(slices[behind], spread, 2)
    # The same of rays: their start is even over the aperture.
    r = np.sqrt((np.arange(200) + 0.5) / 200) * 0.45 * radius
    starts = np.stack([r, np.zeros(200), np.full(200, 0.05)], axis=1)
    x, d = oracles.through_ball(starts, np.broadcast_to([0.0, 0.0, -1.0], starts.shape), radius, n)
    across, slope = x[:, 0] - d[:, 0] / d[:, 2] * x[:, 2], d[:, 0] / d[:, 2]
    waist = -(across * slope).mean() / (slope**2).mean()
    assert -first / (2.0 * second) == pytest.approx(waist, abs=extent / count)


def test_a_folded_front_adds_up() -> None:
    """Two prisms bend two beams over each other: where they overlap, the fluence is the sum of both."""
    n, slope, top = 1.5, np.radians(30.0), 0.025
    tall = 0.03 * np.tan(slope)
    roof = shapes.extruded_polygon([(-0.03, 0.0), (0.0, -tall), (0.03, 0.0)], 0.052)  # in x and y
    volume = pl.Volume.from_sdf(lambda x, y, z: roof(x, y - top, z), n, 64, (0.08, 0.08, 0.06))
    place = centres(volume)
    x, y, z = np.moveaxis(place, -1, 0)
    # Two slits keep light from the edges, which are round in samples.
    slit = (np.abs(x) > 0.006) & (np.abs(x) < 0.022) & (np.abs(z) < 0.018)
    stop = np.zeros((*volume.shape, 4), np.float32)
    stop[..., 3] = (y > 0.035) & (y < 0.0375) & ~slit
    light = light_in(volume.replace(opaque=stop), pl.DirectionalLight((0, -1, 0), irradiance=2.0), bounces=2)
    refracted = np.arcsin(n * np.sin(slope))
    through = 1.0 - oracles.fresnel(np.array([1e-6, slope]), np.array([1.0, n]), np.array([n, 1.0]))
    # A beam keeps its flux when refraction at the slope changes its width by the ratio of the cosines.
    one = 2.0 * through.prod() * np.cos(slope) / np.cos(refracted)
    both = (np.abs(x) < 0.003) & (np.abs(z) < 0.012) & (y > -0.034) & (y < -0.028)
    assert both.sum() > 200
    assert light.fluence[both][:, 1].mean() == pytest.approx(2.0 * one, rel=0.02)
    assert off_by(light.fluence, np.full_like(light.fluence, 2.0 * one), both) < 0.05
    assert light.direction[both].mean(0) == pytest.approx([0.0, -np.cos(refracted - slope), 0.0], abs=0.02)


def test_lights_and_colours_add() -> None:
    ball = pl.Volume.from_sdf(shapes.sphere(0.03), pl.media.resolve(1.4).with_absorption((3, 8, 20)), 24, 0.1)
    red = pl.DirectionalLight((0.3, -1, 0.2), color=(1.0, 0.2, 0.0), irradiance=1.5)
    blue = pl.PointLight((0.1, 0.15, 0.0), color=(0.0, 0.3, 1.0), intensity=0.05)
    first, second, both = light_in(ball, red), light_in(ball, blue), light_in(ball, red, blue)
    # Not to the last digit: what is weak enough to be drawn by chance is measured against the strongest light.
    assert off_by(both.fluence, first.fluence + second.fluence) < 0.04
    assert both.fluence.mean((0, 1, 2)) == pytest.approx((first.fluence + second.fluence).mean((0, 1, 2)), rel=5e-3)
    assert both.flux_in == pytest.approx(first.flux_in + second.flux_in, rel=1e-4)
    assert first.fluence[..., 2].max() == 0.0 and second.fluence[..., 0].max() == 0.0


# ---- convergence and the intensity law ----------------------------------------------------------------------


def away_from_singular_points(volume: pl.Volume, fluence: np.ndarray, most: float) -> np.ndarray:
    """Not within 1.5 voxels of a surface, and not where light is gathered."""
    return (np.abs(volume.regions[0].sdf) > 1.5 * volume.voxel_m[0]) & (fluence.max(-1) < most)


@pytest.mark.slow
def test_a_front_twice_as_fine_changes_little() -> None:
    glass = pl.media.resolve(1.5).with_absorption((5, 10, 20))
    ball = pl.Volume.from_sdf(shapes.sphere(0.035), glass, 64, 0.1)
    coarse, fine = light_in(ball, DOWN), light_in(ball, DOWN, front_voxels=0.5)
    assert off_by(coarse.fluence, fine.fluence, away_from_singular_points(ball, fine.fluence, 4.0)) < 0.02


def test_the_intensity_law_agrees_where_the_front_is_not_folded() -> None:
    volume = pl.Volume.from_function(shapes.luneburg(0.04), 32, 0.1)
    flux, intensity = light_in(volume, DOWN), light_in(volume, DOWN, method="intensity")
    place = centres(volume)
    # Nearer to the focus the strongest patch of a voxel is more than the mean of its patches.
    upper = (np.linalg.norm(place, axis=-1) < 0.035) & (place[..., 2] > 0.003)
    assert off_by(intensity.fluence, flux.fluence, upper) < 0.05


# ---- photons ------------------------------------------------------------------------------------------------

COLOURS = (5.0, 10.0, 20.0)


def as_sampled(volume: pl.Volume, smoothing_voxels: float = 0.75) -> Any:
    """The field that rays see: the index smoothed, and central differences of n^2/2, interpolated linearly."""
    n = gaussian_filter(volume.ambient_n + volume.delta_n.astype(np.float64), smoothing_voxels, mode="nearest")
    force = np.gradient(0.5 * n * n, volume.voxel_m[0])
    size = np.array(volume.shape[::-1])

    def field(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = ((x / np.array(volume.extent_m) + 0.5) * size - 0.5)[:, ::-1].T
        index = map_coordinates(n, at, order=1, mode="nearest")
        pull = np.stack([map_coordinates(f, at, order=1, mode="nearest") for f in force[::-1]], axis=1)
        return index, pull / index[:, None]

    return field


def in_cells(field: np.ndarray) -> np.ndarray:
    """Means of 2 x 2 x 2 voxels."""
    z, y, x, _ = field.shape
    return np.asarray(field.reshape(z // 2, 2, y // 2, 2, x // 2, 2, 3).mean((1, 3, 5)))


@pytest.mark.slow
@pytest.mark.parametrize("count", [48, 64])
def test_a_ball_holds_the_light_that_photons_bring(count: int) -> None:
    ball = pl.Volume.from_sdf(shapes.sphere(0.035), pl.media.resolve(1.5).with_absorption(COLOURS), count, 0.1)
    light = light_in(ball, DOWN)
    world = World((0.1,) * 3, [Sphere(0.035, Matter(1.5, COLOURS))])
    truth = trace_light(world, [DOWN], ball.shape, 8.0, limits=Limits(bounces=9), random=True)
    assert off_by(light.fluence, truth.fluence) < 0.05
    assert light.flux_absorbed == pytest.approx(truth.flux_absorbed, rel=0.01)
    # Directions are kept in cells of two voxels.
    way = in_cells(truth.direction * truth.fluence.mean(-1, keepdims=True))
    found = in_cells(light.direction * truth.fluence.mean(-1, keepdims=True))
    assert off_by(found, way) < 0.03


@pytest.mark.slow
def test_a_cylinder_lens_holds_the_light_that_photons_bring() -> None:
    """As good as two-dimensional: a cylinder across the light, looked at in its middle."""
    lamp = pl.DirectionalLight((0.2, 0.0, -1.0), irradiance=2.0)
    glass = pl.media.resolve(1.5).with_absorption(COLOURS)
    body = pl.Volume.from_sdf(lambda x, y, z: np.hypot(x, z) - 0.03 + 0.0 * y, glass, 96, (0.1, 0.05, 0.1))
    light = light_in(body, lamp)
    world = World(body.extent_m, [Cylinder(0.03, Matter(1.5, COLOURS), axis=1)])
    truth = trace_light(world, [lamp], body.shape, 8.0, limits=Limits(bounces=9), random=True)
    middle = np.s_[:, 18:-18]  # the cylinder is cut off by the box, and sampled edges are round
    assert off_by(light.fluence[middle], truth.fluence[middle]) < 0.05


@pytest.mark.slow
def test_a_luneburg_lens_holds_the_light_that_photons_bring() -> None:
    volume = pl.Volume.from_function(shapes.luneburg(0.04), 48, 0.1)
    light = light_in(volume, DOWN)
    world = World((0.1,) * 3, background=Matter(as_sampled(volume)), step_m=1e-3)
    truth = trace_light(world, [DOWN], volume.shape, 3.0, random=True)
    assert off_by(light.fluence, truth.fluence) < 0.05


@pytest.mark.slow
def test_a_ball_near_a_lamp_holds_the_light_that_photons_bring() -> None:
    lamp = pl.PointLight((0.05, 0.04, 0.16), intensity=0.05)
    ball = pl.Volume.from_sdf(shapes.sphere(0.035), pl.media.resolve(1.5).with_absorption(COLOURS), 48, 0.1)
    light = light_in(ball, lamp)
    world = World((0.1,) * 3, [Sphere(0.035, Matter(1.5, COLOURS))])
    truth = trace_light(world, [lamp], ball.shape, 6.0, limits=Limits(bounces=9), random=True)
    assert off_by(light.fluence, truth.fluence) < 0.07
    assert light.flux_absorbed == pytest.approx(truth.flux_absorbed, rel=0.01)


def test_larger_voxels_of_the_fluence_hold_the_mean_of_the_smaller() -> None:
    ball = pl.Volume.from_sdf(shapes.sphere(0.03), 1.5, 32, 0.1)
    fine, coarse = light_in(ball, DOWN), light_in(ball, DOWN, fluence_voxels=2.0)
    assert coarse.fluence.shape == fine.fluence.shape
    means = fine.fluence.reshape(16, 2, 16, 2, 16, 2, 3).mean((1, 3, 5))
    assert off_by(coarse.fluence[::2, ::2, ::2], means, means.max(-1) < 4.0) < 0.05
    assert coarse.fluence.mean() == pytest.approx(fine.fluence.mean(), rel=0.01)
    assert coarse.patches < 0.5 * fine.patches


def test_fluence_that_no_buffer_holds_gets_larger_voxels() -> None:
    prepared = prepare(pl.Volume.from_sdf(shapes.sphere(0.03), 1.5, 32, 0.1), "sharp")
    whole = grid_of(prepared, pl.LightQuality(), 12 * 40**3)
    fewer = grid_of(prepared, pl.LightQuality(), 12 * 20**3)
    assert min(whole) >= 32
    assert 18**3 < np.prod(fewer) <= 20**3
