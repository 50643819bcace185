"""Surroundings: directions land where the convention says, energy is right, bad maps are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError, SceneError
from pellucid.io.images import write_image
from pellucid.scene import Environment
from pellucid.scene import sky as daylight
from pellucid.scene.equirect import direction_at, look_up, pixel_directions, pixel_solid_angles

AXES = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def test_a_map_of_directions_looked_up_in_a_direction_gives_it_back() -> None:
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    found = look_up(pixel_directions(512, 1024), directions)
    # bilinear error h^2/8 of unit curvature with a pixel of pi/512; at the poles rows end half a pixel early
    assert np.abs(found - directions).max() < np.pi / 512


def test_every_axis_falls_on_its_place_in_the_picture() -> None:
    directions = pixel_directions(4, 8)
    assert directions[0, :, 1].min() > 0.9 and directions[-1, :, 1].max() < -0.9  # row 0 is up
    middle = directions[1:3].mean(axis=0)
    assert middle[3:5].mean(axis=0) @ [0, 0, -1] > 0.7  # centre columns look along -Z
    assert middle[5:7].mean(axis=0) @ [1, 0, 0] > 0.7  # a quarter to the right is +X


def test_solid_angles_cover_the_sphere() -> None:
    assert (pixel_solid_angles(17, 34) * 34).sum() == pytest.approx(4.0 * np.pi)


def test_a_constant_shines_alike_from_everywhere() -> None:
    environment = Environment.constant((0.25, 0.5, 2.0), intensity=2.0)
    assert environment.radiance(AXES) == pytest.approx(np.tile([0.5, 1.0, 4.0], (6, 1)))
    assert Environment.constant(0.5).radiance(AXES[0]) == pytest.approx([0.5] * 3)


def test_rotation_turns_the_surroundings_counter_clockwise_from_above() -> None:
    pixels = np.zeros((64, 128, 3), np.float32)
    pixels[:, 60:68] = 1.0  # what lies along -Z
    turned = Environment(pixels, rotation_deg=90.0)
    assert turned.radiance(AXES)[:, 0] == pytest.approx([0, 1, 1 / 16, 1 / 16, 0, 0], abs=0.95)
    assert turned.radiance(np.array([-1.0, 0, 0]))[0] == pytest.approx(1.0)
    assert turned.radiance(np.array([0, 0, -1.0]))[0] == pytest.approx(0.0)


def test_the_studio_is_the_same_every_time_and_shows_glass() -> None:
    pixels = Environment.studio().pixels
    assert pixels is Environment.studio(intensity=2.0).pixels and not pixels.flags.writeable
    assert 15.0 < pixels.max() <= 20.5 and pixels.min() > 0.02
    omega = pixel_solid_angles(*pixels.shape[:2])[..., None]
    mean = (pixels * omega).sum((0, 1)) / (4.0 * np.pi)
    assert mean == pytest.approx(np.full(3, mean.mean()), rel=0.05)  # neutral
    assert 0.4 < mean.mean() < 1.2  # exposure 1 suits it
    upper, lower = pixels[:256].mean(), pixels[256:].mean()
    assert lower < upper / 4.0  # dark floor


def test_studio_edges_are_soft_enough_not_to_alias() -> None:
    pixels = Environment.studio().pixels[64:448, :, 1]  # away from the poles
    step = np.maximum(np.abs(np.diff(pixels, axis=0))[:, :-1], np.abs(np.diff(pixels, axis=1))[:-1])
    assert step.max() < 0.25 * pixels.max()


@pytest.mark.parametrize(("elevation", "azimuth"), [(35.0, 40.0), (5.0, -90.0), (80.0, 170.0), (2.0, 0.0), (90.0, 0.0)])
def test_the_sun_stands_where_it_is_told(elevation: float, azimuth: float) -> None:
    pixels = Environment.sky(elevation, azimuth, sun_diameter_deg=1.0).pixels
    omega = pixel_solid_angles(*pixels.shape[:2])
    light = (pixels @ LUMINANCE) * omega * (pixels @ LUMINANCE > 0.2 * (pixels @ LUMINANCE).max())
    centre = (pixel_directions(*pixels.shape[:2]) * light[..., None]).sum((0, 1))
    centre /= np.linalg.norm(centre)
    assert np.degrees(np.arccos(min(1.0, centre @ direction_at(azimuth, elevation)))) < 0.5
    column = (azimuth / 360.0 + 0.5) % 1.0 * pixels.shape[1]
    row = (90.0 - elevation) / 180.0 * pixels.shape[0]
    if 0.0 < elevation < 80.0:
        found = np.argwhere(light == light.max()).mean(axis=0) + 0.5
        assert found == pytest.approx([row, column], abs=2.0)


@pytest.mark.parametrize("diameter", [0.1, 0.53, 2.0, 8.0])
@pytest.mark.parametrize("azimuth", [0.0, 40.1, 179.99])
def test_the_suns_irradiance_does_not_depend_on_how_it_is_drawn(diameter: float, azimuth: float) -> None:
    maps = [
        Environment.sky(35.0, azimuth, sun_diameter_deg=diameter, sun_disc=disc).pixels.astype(float)
        for disc in (True, False)
    ]
    irradiance = ((maps[0] - maps[1]) * pixel_solid_angles(512, 1024)[..., None]).sum((0, 1))
    assert irradiance == pytest.approx(daylight.sun_irradiance(35.0, 3.0), rel=1e-5)


def test_without_air_the_sun_has_the_known_illuminance() -> None:
    # published values lie between 127 and 134 klx [darula2005]; a black body gives a little less than the sun
    lambda_nm = np.arange(380.0, 781.0, 5.0)
    y = daylight._matching_functions(lambda_nm)[1]
    spectrum = daylight._planck(lambda_nm) * daylight.SUN_SOLID_ANGLE_SR
    assert 124e3 < 683.0 * 5e-9 * (y @ spectrum) < 134e3
    whole_nm = np.arange(100.0, 60000.0, 10.0)
    total = (daylight._planck(whole_nm) * daylight.SUN_SOLID_ANGLE_SR).sum() * 10e-9
    assert total == pytest.approx(1361.0, rel=0.005)  # nominal total solar irradiance [prsa2016], W/m^2


def test_matching_functions_have_equal_areas_as_the_standard_demands() -> None:
    areas = daylight._matching_functions(np.arange(360.0, 831.0)).sum(axis=1)
    assert areas == pytest.approx(np.full(3, 106.857), rel=0.01)  # CIE 1931, sum of y at 1 nm


def test_the_sky_is_bluer_and_darker_away_from_the_sun_and_dimmer_with_a_low_sun() -> None:
    sky = Environment.sky(35.0, 0.0, 3.0, sun_disc=False)
    zenith = sky.radiance(np.array([0.0, 1.0, 0.0]))
    near = sky.radiance(direction_at(0.0, 25.0))
    assert zenith[2] > 1.5 * zenith[0] and near @ LUMINANCE > 3.0 * (zenith @ LUMINANCE)
    low = Environment.sky(2.0, 0.0, 3.0, sun_disc=False).radiance(np.array([0.0, 1.0, 0.0]))
    assert low @ LUMINANCE < zenith @ LUMINANCE


def test_zenith_luminance_of_a_clear_day() -> None:
    # Preetham et al., appendix A.2, worked by hand for T = 3 and the sun 45 degrees high:
    # chi = (4/9 - 3/120) pi/2 = 0.65886; (12.1359 - 4.971) tan chi - 0.6465 + 2.4192 = 7.3238 kcd/m^2
    assert daylight._zenith_luminance(np.pi / 4, 3.0) == pytest.approx(7.3238e3, rel=1e-3)
    up = daylight.sky_radiance(np.array([[0.0, 1.0, 0.0]]), 45.0, 0.0, 3.0)[0]
    assert up @ LUMINANCE * daylight.LUMINANCE_UNIT_CD_M2 == pytest.approx(7.3238e3, rel=2e-3)


def test_the_ground_returns_its_share_of_what_falls_on_it() -> None:
    sky = Environment.sky(50.0, 10.0, 3.0, ground_albedo=(1.0, 0.5, 0.0), sun_disc=False)
    omega, up = pixel_solid_angles(512, 1024)[..., None], pixel_directions(512, 1024)[..., 1:2]
    fallen = (sky.pixels * omega * np.maximum(up, 0.0)).sum((0, 1))
    fallen += daylight.sun_irradiance(50.0, 3.0) * np.sin(np.radians(50.0))
    assert sky.pixels[-1, 0] == pytest.approx(fallen / np.pi * [1.0, 0.5, 0.0], rel=0.01)


@pytest.mark.parametrize("name", ["a.exr", "a.hdr", "a.png"])
def test_pictures_become_environments(tmp_path: Path, name: str) -> None:
    value = np.full((4, 8, 3), 255, np.uint8) if name == "a.png" else np.ones((4, 8, 3), np.float32)
    write_image(tmp_path / name, value)
    environment = Environment.load(tmp_path / name, intensity=3.0)
    assert environment.kind == "file"
    assert environment.radiance(AXES) == pytest.approx(np.full((6, 3), 3.0))


@pytest.mark.parametrize("channels", [1, 2, 4])
def test_grey_and_alpha_are_understood(tmp_path: Path, channels: int) -> None:
    pixels = np.full((4, 8, channels), 0.5, np.float32)
    write_image(tmp_path / "a.exr", pixels)
    assert np.array_equal(Environment.load(tmp_path / "a.exr").pixels, np.full((4, 8, 3), 0.5))


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda p: p * np.nan, "not finite, the first in column 0 of row 0"),
        (lambda p: np.where(np.arange(8)[None, :, None] == 5, np.inf, p), "column 5 of row 0"),
        (lambda p: p - 2.0, "negative"),
        (lambda p: p[:, :4], "twice as wide as high"),
        (lambda p: np.concatenate([p, p], axis=1), "twice as wide as high"),
    ],
)
def test_bad_maps_are_refused_with_file_or_field(tmp_path: Path, spoil, words: str) -> None:
    pixels = spoil(np.ones((4, 8, 3), np.float32)).astype(np.float32)
    write_image(tmp_path / "a.exr", pixels)
    with pytest.raises(AssetError, match=words) as caught:
        Environment.load(tmp_path / "a.exr")
    assert caught.value.path.endswith("a.exr")
    with pytest.raises(SceneError, match=r"environment\.pixels"):
        Environment(pixels)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Environment.sky(-1), "environment.sun_elevation_deg"),
        (lambda: Environment.sky(95), "environment.sun_elevation_deg"),
        (lambda: Environment.sky(35, float("nan")), "environment.sun_azimuth_deg"),
        (lambda: Environment.sky(35, 0, 1.0), "environment.turbidity"),
        (lambda: Environment.sky(ground_albedo=2), "environment.ground_albedo[0]"),
        (lambda: Environment.sky(sun_diameter_deg=0), "environment.sun_diameter_deg"),
        (lambda: Environment.constant(-1), "environment.rgb[0]"),
        (lambda: Environment.constant((1, 2)), "environment.rgb"),
        (lambda: Environment.studio(intensity=-1), "environment.intensity"),
        (lambda: Environment.studio(rotation_deg=float("inf")), "environment.rotation_deg"),
        (lambda: Environment(np.ones((4, 8))), "environment.pixels"),
        (lambda: Environment("studio"), "environment.pixels"),
    ],
)
def test_each_fault_names_its_field(make, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        make()
    assert caught.value.field == field
