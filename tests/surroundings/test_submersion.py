"""Opaque surfaces in level water: the sky, the sun and lamps reach them through its surface as they should."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.gpu import Device
from pellucid.optics import fresnel_dielectric
from pellucid.scene import AreaLight, Camera, DirectionalLight, Environment, Mesh, PointLight, Scene
from pellucid.surroundings import Query, Surroundings
from pellucid.surroundings.environment import irradiance_sh
from pellucid.surroundings.submersion import WaterRegion, cap_irradiance, sky_through

WHITE = {"base_color": (1.0, 1.0, 1.0), "specular": 0.0}
N = 1.333


def surroundings(device: Device, *objects: object, lights: tuple[object, ...] = (), sky: float = 0.0) -> Surroundings:
    environment = Environment(np.full((8, 16, 3), sky, np.float32))
    around = Surroundings(device)
    around.prepare(
        Scene(camera=Camera((0, 1, 5), (0, 0, 0)), lights=list(lights), objects=list(objects), environment=environment),
        (8, 8),
    )
    return around


def fill(around: Surroundings, **region: object) -> WaterRegion:
    water = WaterRegion(0.0, (-10.0, -10.0), (10.0, 10.0), **region)  # type: ignore[arg-type]
    around.submersion.set([water], map_size=4, depth_size=4, sky=[around.sky_through(water.n)])
    return water


def below(around: Surroundings, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Radiance (N, 3) that surfaces send along their normals."""
    return Query(around).radiance(points + 1e-3 * normals, -normals)


def test_a_round_patch_of_sky_on_a_tilted_surface_is_its_integral() -> None:
    sine2, tilts = 1.0 / N**2, np.linspace(0.0, np.pi, 13)
    theta = np.arcsin(np.sqrt(sine2)) * (np.arange(400) + 0.5) / 400
    phi = 2.0 * np.pi * (np.arange(400) + 0.5) / 400
    t, p = np.meshgrid(theta, phi, indexing="ij")
    area = np.sin(t) * np.arcsin(np.sqrt(sine2)) / 400 * 2.0 * np.pi / 400
    for tilt in tilts:
        facing = np.maximum(np.cos(t) * np.cos(tilt) + np.sin(t) * np.cos(p) * np.sin(tilt), 0.0)
        expected = (facing * area).sum() / (np.pi * sine2)
        assert cap_irradiance(np.cos(tilt), sine2) == pytest.approx(expected, abs=2e-4)


def test_a_uniform_sky_comes_through_with_what_fresnel_leaves_of_it() -> None:
    pixels = np.ones((64, 128, 3))
    through = sky_through(pixels, irradiance_sh(pixels), (N, N, N))
    m = (np.arange(100000) + 0.5) / 100000
    passed = np.mean((1.0 - fresnel_dielectric(m, 1.0, N)) * 2.0 * m)
    np.testing.assert_allclose(through.irradiance, np.pi * passed, rtol=1e-4)
    np.testing.assert_allclose(through.axis, (0, 1, 0), atol=1e-9)
    np.testing.assert_allclose(through.ground, np.pi * N**2, rtol=1e-4)


def test_light_from_one_side_of_the_sky_comes_from_that_side_of_the_window() -> None:
    pixels = np.zeros((64, 128, 3))
    pixels[24, 96] = 1.0  # towards +X, 68.9 degrees from the zenith
    through = sky_through(pixels, irradiance_sh(pixels), (N, N, N))
    theta = np.pi * 24.5 / 64
    assert np.degrees(np.arctan2(*through.axis[[0, 1]])) == pytest.approx(
        np.degrees(np.arcsin(np.sin(theta) / N)), 0.01
    )
    assert abs(through.axis[2]) < 0.05


def test_white_surfaces_in_clear_water_return_a_uniform_sky_n2_times(device: Device) -> None:
    ball = Mesh.sphere(1.0, position=(0, -3, 0), segments=64, **WHITE)
    glossy = Mesh.sphere(1.0, position=(5, -3, 0), segments=64, base_color=(1, 1, 1), specular=0.04, roughness=0.5)
    around = surroundings(device, ball, glossy, sky=0.7)
    fill(around)
    ways = np.random.default_rng(1).normal(size=(64, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    np.testing.assert_allclose(below(around, ways + ball.position, ways), 0.7 * N**2, rtol=2e-3)
    np.testing.assert_allclose(below(around, ways + glossy.position, ways), 0.7 * N**2, rtol=5e-3)


def test_without_water_and_above_it_nothing_changes(device: Device) -> None:
    floor, lamp = Mesh.plane(4.0, **WHITE), PointLight((0.3, 1, 0), intensity=2.0)
    around = surroundings(device, floor, lights=(lamp, DirectionalLight((1, -2, 0))), sky=0.7)
    points = np.array([[0.1, 0, 0.2], [1, 0, -1]])
    before = below(around, points, np.tile((0.0, 1.0, 0.0), (2, 1)))
    fill(around, limits_m=(-0.1, 0.1))
    np.testing.assert_allclose(below(around, points, np.tile((0.0, 1.0, 0.0), (2, 1))), before, rtol=1e-5)
    around.submersion.set([])
    assert np.array_equal(below(around, points, np.tile((0.0, 1.0, 0.0), (2, 1))), before)


def test_the_sky_fades_with_the_depth_as_its_rays_do(device: Device) -> None:
    absorption = (0.05, 0.2, 0.6)
    around = surroundings(device, Mesh.plane(18.0, position=(0, -2, 0), base_color=(0, 0, 0), specular=0.0), sky=1.0)
    fill(around, absorption_per_m=absorption)
    dark = below(around, np.array([[0.0, -2, 0]]), np.array([[0.0, 1, 0]]))
    assert not dark.any()
    around = surroundings(device, Mesh.plane(18.0, position=(0, -2, 0), base_color=(1e-3,) * 3, specular=0.0), sky=1.0)
    fill(around, absorption_per_m=absorption)
    seen = below(around, np.array([[0.0, -2, 0]]), np.array([[0.0, 1, 0]]))[0] * np.pi / 1e-3
    m = (np.arange(20000) + 0.5) / 20000
    inner = np.sqrt(1.0 - (1.0 - m**2) / N**2)
    for c, a in enumerate(absorption):
        rays = (1.0 - fresnel_dielectric(m, 1.0, N)) * np.exp(-2.0 * a / inner) * 2.0 * m
        assert seen[c] == pytest.approx(np.pi * rays.mean(), rel=0.01)


@pytest.mark.parametrize("elevation", (8.0, 30.0, 60.0, 90.0))
def test_the_sun_is_refracted_and_fades_by_beer(device: Device, elevation: float) -> None:
    e, depth = np.radians(elevation), 3.0
    sun = DirectionalLight((-np.cos(e), -np.sin(e), 0.0), irradiance=2.0)
    around = surroundings(device, Mesh.plane(18.0, position=(0, -depth, 0), **WHITE), lights=(sun, sun, sun, sun, sun))
    absorption, scattering = np.array([0.1, 0.2, 0.4]), np.array([0.3, 0.1, 0.0])
    fill(around, absorption_per_m=tuple(absorption), scattering_per_m=tuple(scattering), asymmetry=0.6)
    around.submersion.set([around.submersion.regions[0]], map_size=4, depth_size=4)
    seen = below(around, np.array([[0.0, -depth, 0]]), np.array([[0.0, 1, 0]]))[0] * np.pi
    cosine = np.sqrt(1.0 - (np.cos(e) / N) ** 2)
    one = (
        2.0
        * np.sin(e)
        * (1.0 - fresnel_dielectric(np.sin(e), 1.0, N))
        * np.exp(-(absorption + 0.2 * scattering) * depth / cosine)
    )
    np.testing.assert_allclose(seen, one, rtol=1e-4)  # four suns have maps, which are still dark; the fifth has none


def test_a_lamp_over_the_water_is_seen_where_snell_and_energy_put_it(device: Device) -> None:
    lamp = PointLight((0.0, 2.0, 0.0), intensity=5.0)
    around = surroundings(device, Mesh.plane(19.0, position=(0, -1.5, 0), **WHITE), lights=(lamp,))
    fill(around, absorption_per_m=(0.2, 0.2, 0.2))
    angle = np.radians(np.linspace(1.0, 75.0, 2000))  # above; where its rays land
    inner = np.arcsin(np.sin(angle) / N)
    x = 2.0 * np.tan(angle) + 1.5 * np.tan(inner)
    flux = 5.0 * (1.0 - fresnel_dielectric(np.cos(angle), 1.0, N)) * np.sin(angle) * np.exp(-0.2 * 1.5 / np.cos(inner))
    expected = flux / (x * np.gradient(x, angle))
    at = np.array([0.05, 0.5, 1.0, 3.0, 6.0])
    points = np.stack([at, np.full(5, -1.5), np.zeros(5)], axis=1)
    seen = below(around, points, np.tile((0.0, 1.0, 0.0), (5, 1)))[:, 0] * np.pi
    np.testing.assert_allclose(seen, np.interp(at, x, expected), rtol=3e-3)


def test_shadows_of_lamps_follow_the_bent_way(device: Device) -> None:
    bar = Mesh.box(0.2, position=(1.0, 0.5, 0.0), **WHITE)
    lamp = PointLight((0.0, 1.0, 0.0), intensity=5.0)
    around = surroundings(device, Mesh.plane(19.0, position=(0, -2.0, 0), **WHITE), bar, lights=(lamp,))
    fill(around)
    bent = 1.0 * np.tan(a := np.arctan(2.0)) + 2.0 * np.tan(np.arcsin(np.sin(a) / N))
    points = np.array([[bent, -2.0, 0.0], [6.0, -2.0, 0.0]])  # behind the bar, as bent and as straight light has it
    seen = below(around, points, np.tile((0.0, 1.0, 0.0), (2, 1)))[:, 0]
    assert seen[0] == 0.0 and seen[1] > 0.0


def test_a_lamp_in_the_water_shines_straight_and_fades(device: Device) -> None:
    lamps = (PointLight((0.0, -1.0, 0.0), intensity=5.0), AreaLight((0, -1, 0), (0.2, 0, 0), (0, 0, 0.2), radiance=0.0))
    around = surroundings(device, Mesh.plane(9.0, position=(0, -2.0, 0), **WHITE), lights=lamps)
    fill(around, absorption_per_m=(0.5, 0.5, 0.5))
    seen = below(around, np.array([[0.0, -2.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))[0] * np.pi
    np.testing.assert_allclose(seen, 5.0 * np.exp(-0.5), rtol=1e-4)


def test_there_are_not_more_waters_than_there_is_room_for(device: Device) -> None:
    around = surroundings(device)
    with pytest.raises(SceneError, match="at most 4"):
        around.submersion.set([WaterRegion(0.0, (0.0, 0.0), (1.0, 1.0))] * 5)
