"""Volumes at many wavelengths: what must not change, and a spectrum against Snell and the standard observer."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import shapes
from pellucid.optics import refract
from pellucid.spectra import colour_matching, stratified
from pellucid.techniques.eikonal.prepare import prepare
from pellucid.techniques.eikonal.wavelengths import at_sample, common_draws, draws_of

SIZE = (96, 72)
CAMERA = pl.Camera(position=(0.02, 0.07, 0.22), target=(0.0, 0.0, 0.0), fov_deg=30.0)
FLINT = pl.media.get("N-SF11").with_absorption((0.0, 0.0, 0.0))
XYZ_FROM_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture(scope="module")
def flint():
    return pl.Volume.from_sdf(shapes.sphere(0.04), FLINT, 48, 0.1)


def scene(*objects, environment=None, camera=CAMERA):
    around = environment or pl.Environment.constant((0.3, 1.0, 0.6))
    return pl.Scene(camera=camera, environment=around, objects=list(objects), tone_mapping="linear")


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_lossless_glass_vanishes_in_coloured_light_at_every_wavelength(renderer, flint, boundary):
    item = pl.RefractiveVolume(flint, boundary=boundary, spectral=5)
    frame = renderer.render(scene(item), SIZE, samples=2)
    error = np.abs(frame.radiance - (0.3, 1.0, 0.6)).max()
    assert np.isfinite(frame.depth).any() and error < 5e-3, f"off by {error:.1e}"


def test_bodies_of_different_numbers_of_wavelengths_vanish_together(renderer, flint):
    bodies = [
        pl.RefractiveVolume(flint, scale=0.6, position=(0.01, 0.0, 0.03), spectral=6),
        pl.RefractiveVolume(flint, scale=0.6, position=(-0.01, 0.0, -0.03)),
    ]
    frame = renderer.render(scene(*bodies), SIZE, samples=2)
    error = np.abs(frame.radiance - (0.3, 1.0, 0.6)).max()
    assert np.isfinite(frame.depth).any() and error < 5e-3, f"off by {error:.1e}"


def test_matter_without_dispersion_looks_the_same(renderer):
    ball = pl.Volume.from_sdf(shapes.sphere(0.04), 1.6, 48, 0.1)
    around = pl.Environment.studio()
    frames = [renderer.render(scene(pl.RefractiveVolume(ball, spectral=n), environment=around), SIZE) for n in (0, 16)]
    np.testing.assert_array_equal(frames[0].radiance, frames[1].radiance)


def test_a_coloured_picture_through_many_wavelengths_keeps_its_colours(renderer):
    """Straight through a plate nothing is bent: only Fresnel tells the wavelengths apart, by parts in a thousand."""
    plate = pl.Volume.from_sdf(shapes.box((0.06, 0.06, 0.02)), "N-BK7", 48, 0.1)
    board = pl.Mesh.checkerboard(
        0.1, squares=4, colors=((0.8, 0.1, 0.05), (0.1, 0.2, 0.7)), position=(0, 0, -0.03), rotation=(90, 0, 0)
    )
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.04)
    frames = [
        renderer.render(scene(board, pl.RefractiveVolume(plate, spectral=n), camera=camera), (32, 24)) for n in (0, 12)
    ]
    assert np.ptp(frames[0].radiance[..., 0]) > 0.1
    np.testing.assert_allclose(frames[1].radiance, frames[0].radiance, atol=3e-3)


GLASS = pl.media.get("N-SF66")
APEX = np.radians(20.0)
BACK = np.array([np.sin(APEX), 0.0, -np.cos(APEX)])


def prism(x, y, z):
    """Front face square to the view, back face through the origin at 20 deg."""
    sides = np.maximum(np.abs(x) - 0.045, np.abs(y) - 0.01)
    return np.maximum(np.maximum(z - 0.02, BACK[0] * x + BACK[2] * z), sides)


def behind_prism(opaque, spectral, width_m, size):
    """A scene that is looked at through the prism from far away, `width_m` wide."""
    quality = pl.Quality(bounces=2, min_weight=0.2)
    item = pl.RefractiveVolume.from_sdf(prism, GLASS, 96, (0.1, 0.03, 0.05), spectral=spectral, quality=quality)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=width_m * size[1] / size[0])
    return scene(opaque, item, camera=camera, environment=pl.Environment.constant((0.0, 0.0, 0.0)))


def test_a_slit_through_a_prism_has_its_lines_at_their_angles_with_the_colours_of_the_observer(renderer):
    """Light leaves the back face at arcsin(n sin 20 deg) to its normal.

    Through it a bright slit of 0.2 mm, half a metre behind, shows once for each of 12 wavelengths, apart.
    """
    count, slit_z, width_m, pixels = 12, -0.5, 0.09, 1800
    lambdas = stratified(count)
    way = refract(np.array([0.0, 0.0, -1.0]), -BACK, GLASS.n(lambdas), 1.0).direction
    slope = way[:, 0] / -way[:, 2]  # sideways for each metre away from the viewer
    # A ray at x leaves the back face at z = x tan(apex) and meets the slit at x + (z - slit_z) slope.
    slit_x = float(np.mean(-slit_z * slope))
    expected_x = (slit_x + slit_z * slope) / (1.0 + np.tan(APEX) * slope)
    gap = np.abs(np.diff(expected_x)).min()
    assert gap > 3e-4, "the lines are apart"

    place = {"position": (slit_x, 0.0, slit_z), "base_color": (0, 0, 0)}
    slit = pl.Mesh.box((2e-4, 0.2, 1e-4), emission=(1.0, 1.0, 1.0), **place)
    size = (pixels, 4)
    row = renderer.render(behind_prism(slit, count, width_m, size), size).radiance[1].astype(float)
    x = ((np.arange(pixels) + 0.5) / pixels - 0.5) * width_m
    for k in range(count):
        near = np.abs(x - expected_x[k]) < 0.5 * gap
        light = np.abs(row[near]).sum(axis=1)
        position = (light @ x[near]) / light.sum()
        assert abs(position - expected_x[k]) < 3e-5, f"{lambdas[k]:.0f} nm is off by {position - expected_x[k]:.1e} m"
        xyz = XYZ_FROM_RGB @ row[near].sum(axis=0)
        locus = colour_matching(lambdas[k])
        np.testing.assert_allclose(xyz / xyz.sum(), locus / locus.sum(), atol=5e-4)


def test_many_pictures_of_few_wavelengths_are_one_of_many(renderer):
    """Each sample has wavelengths of its own: 16 pictures of 8 are nearer to the truth than a single one of 8."""
    bar = pl.Mesh.box((0.01, 0.2, 1e-4), emission=(1.0, 0.8, 0.6), position=(-0.2, 0.0, -0.5), base_color=(0, 0, 0))
    size = (64, 4)

    def picture(spectral, samples):
        return renderer.render(behind_prism(bar, spectral, 0.08, size), size, samples=samples).radiance

    truth = picture(64, 16)
    assert truth.max() > 0.3
    once, many, three = (np.abs(picture(*how) - truth).mean() for how in ((8, 1), (8, 16), (0, 16)))
    assert many < 0.25 * once and many < 0.1 * three, f"{many:.1e} of {once:.1e} and {three:.1e}"


def test_regions_share_their_textures_whatever_the_number_of_wavelengths(device, flint):
    from pellucid.techniques.eikonal.resources import upload

    sizes = {n: upload(device, prepare(flint, "sharp", spectral=n)).nbytes for n in (0, 4, 64)}
    assert len(set(sizes.values())) == 1


def test_a_field_of_three_channels_is_carried_on_to_other_wavelengths():
    glass = pl.media.get("N-SF11")
    n = np.broadcast_to(glass.n_rgb, (8, 8, 8, 3))
    volume = pl.Volume.from_array(n, 0.01)
    prepared = prepare(volume, "sharp", spectral=8)
    for channel in prepared.channels:
        # N-SF11 turns up steeply towards 400 nm: the three channels lie between 464 and 611 nm.
        tolerance = 5e-3 if channel.lambda_nm < 440 else 5e-4
        assert channel.index.mean() == pytest.approx(glass.n(channel.lambda_nm) - 1.0, abs=tolerance)
    np.testing.assert_array_equal(prepare(volume, "sharp").channels[2].index, volume.delta_n[..., 2])


def test_draws_say_which_channel_and_what_it_is_worth(flint):
    plain, three, many = (
        prepare(flint, "sharp", dispersion=d, spectral=s) for d, s in ((False, 8), (True, 0), (True, 8))
    )
    for prepared, count in ((plain, 1), (three, 3), (many, 8)):
        draws = draws_of(prepared)
        assert [channel for channel, _ in draws] == list(range(count))
        np.testing.assert_allclose(sum(matrix for _, matrix in draws), np.eye(3), atol=1e-12)
    together = common_draws([plain, three, many])
    assert [channels[2] for channels, _ in together] == list(range(8))
    assert {channels[0] for channels, _ in together} == {0}
    assert [channels[1] for channels, _ in together] == [2, 2, 2, 1, 1, 0, 0, 0]
    assert at_sample(three, 5) is three
    assert [c.lambda_nm for c in at_sample(many, 5).channels] == list(stratified(8, 5))


@pytest.mark.parametrize("wrong", [1, 3, 65, -4, 8.0, True, "many"])
def test_a_wrong_number_of_wavelengths_is_said(flint, wrong):
    with pytest.raises(pl.SceneError, match=r"refractive_volume\.spectral"):
        pl.RefractiveVolume(flint, spectral=wrong)


def test_fields_of_too_many_wavelengths_say_what_to_do():
    n = np.broadcast_to(np.float32([1.5, 1.51, 1.52]), (160, 160, 160, 3))
    with pytest.raises(pl.SceneError, match=r"spectral.*use up to 13") as caught:
        prepare(pl.Volume.from_array(n, 0.1), "smooth", spectral=32)
    assert "GiB" in str(caught.value)


def test_light_through_many_wavelengths_loses_and_lands_as_much_of_each_colour(device):
    """Coloured glass under a coloured lamp: absorbed, let through and landed on a floor, 8 wavelengths against 3."""
    glass = pl.media.get("N-SF11").with_absorption((5.0, 30.0, 60.0))
    ball = pl.Volume.from_sdf(shapes.sphere(0.03), glass, 32, 0.08)
    lamp = pl.DirectionalLight((0.0, -1.0, 0.1), (1.0, 0.8, 0.5), 2.0)
    floor = pl.Mesh.plane(0.6, position=(0.0, -0.05, 0.0))
    found = {}
    for spectral in (0, 8):
        item = pl.RefractiveVolume(ball, spectral=spectral)
        lit = scene(floor, item).replace(lights=[lamp])
        sums = pl.illuminate(lit, item)
        np.testing.assert_allclose(sums.flux_absorbed + sums.flux_out + sums.flux_ended, sums.flux_in, rtol=1e-4)
        renderer = pl.Renderer(device)
        renderer.render(lit, (32, 24))
        landed = renderer.surroundings.caustics.landed_flux()
        found[spectral] = sums.flux_in, sums.flux_absorbed, sums.flux_out, landed["caustic"].reshape(-1, 3).sum(axis=0)
    for three, many in zip(*found.values(), strict=True):
        np.testing.assert_allclose(many, three, rtol=0.02)
