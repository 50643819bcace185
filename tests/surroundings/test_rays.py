"""The shaders see what the scene says: same hits, same environment, same camera; and nothing is lost."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.gpu import Device
from pellucid.scene import AreaLight, Camera, DirectionalLight, Environment, Mesh, PointLight, Scene
from pellucid.surroundings import Query, Surroundings
from pellucid.surroundings.layouts import SubmersionParams
from surroundings.brute_force import brute_force_hits, random_triangles

CAMERA = Camera((0.4, 0.7, 3.0), (0.1, 0.2, 0.0), fov_deg=50.0)
SIZE = (640, 480)


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def prepared(device: Device, *objects: Mesh, **rest: object) -> Query:
    settings = {"camera": CAMERA, "environment": Environment.constant(1.0), "objects": objects} | rest
    surroundings = Surroundings(device)
    surroundings.prepare(Scene(**settings), SIZE)
    return Query(surroundings)


def soup(triangles: np.ndarray, **look: object) -> Mesh:
    return Mesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), shading="flat", **look)


def test_hits_equal_brute_force(device: Device) -> None:
    triangles = random_triangles(3000, size=0.1).astype(np.float32)
    rng = np.random.default_rng(5)
    origins = rng.uniform(-1.5, 1.5, (500, 3)).astype(np.float32)
    directions = unit(rng.normal(size=(500, 3))).astype(np.float32)
    expected = brute_force_hits(triangles.astype(float), origins.astype(float), directions.astype(float))
    found = prepared(device, soup(triangles)).hits(origins, directions)
    hit = np.isfinite(expected)
    assert 100 < hit.sum() < 500
    np.testing.assert_array_equal(found["valid"] != 0, hit)
    np.testing.assert_array_equal(found["blocked"] != 0, hit)
    np.testing.assert_allclose(found["t"][hit], expected[hit], rtol=1e-5)


def test_a_shadow_ray_ends_at_its_length(device: Device) -> None:
    query = prepared(device, Mesh.plane(2.0))
    down = np.array([[0.0, -1.0, 0.0]])
    assert query.hits([[0, 1, 0]], down, t_max=0.99)["blocked"] == 0
    assert query.hits([[0, 1, 0]], down, t_max=1.01)["blocked"] == 1
    assert query.hits([[0, 1, 0]], down, t_max=0.99)["t"] == np.float32(0.99)


def test_a_single_sided_mesh_is_seen_from_its_front_only_and_always_blocks(device: Device) -> None:
    query = prepared(device, Mesh.plane(2.0, double_sided=False))
    front = query.hits(np.array([[0.1, 1.0, 0.2]]), np.array([[0.0, -1.0, 0.0]]))
    back = query.hits(np.array([[0.1, -1.0, 0.2]]), np.array([[0.0, 1.0, 0.0]]))
    assert front["valid"] == 1 and back["valid"] == 0
    assert front["blocked"] == 1 and back["blocked"] == 1


def test_rays_along_the_axes_hit_an_axis_aligned_box(device: Device) -> None:
    """Zero components of a direction must not turn into undefined products."""
    query = prepared(device, Mesh.box(1.0))
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    found = query.hits(-2.0 * axes + np.array([0.1, 0.13, 0.07]) * (axes == 0), axes)
    np.testing.assert_allclose(found["t"], 1.5, rtol=1e-6)


def test_a_scene_without_meshes_is_all_environment(device: Device) -> None:
    query = prepared(device, environment=Environment.constant((0.2, 0.5, 0.7)))
    directions = unit(np.random.default_rng(0).normal(size=(50, 3)))
    origins = np.zeros((50, 3))
    assert not query.hits(origins, directions)["valid"].any()
    assert not query.hits(origins, directions)["blocked"].any()
    np.testing.assert_allclose(query.radiance(origins, directions), [[0.2, 0.5, 0.7]] * 50, rtol=1e-6)


@pytest.mark.parametrize("rotation_deg", [0.0, 77.0])
def test_environment_equals_the_numpy_look_up(device: Device, rotation_deg: float) -> None:
    pixels = np.random.default_rng(6).gamma(0.5, size=(32, 64, 3)).astype(np.float32)
    sky = Environment(pixels, intensity=1.7, rotation_deg=rotation_deg)
    rng = np.random.default_rng(7)
    seam = np.stack([1e-4 * rng.normal(size=200), rng.normal(size=200), np.abs(rng.normal(size=200))], -1)
    axes = np.eye(3)[[0, 2]]  # not the poles, where any column is as good as another
    directions = unit(np.concatenate([rng.normal(size=(2000, 3)), seam, axes, -axes])).astype(np.float32)
    found = prepared(device, environment=sky).environment(directions)
    # A driver may round the angles to 1e-4 rad, 1e-3 of a texel here.
    np.testing.assert_allclose(found, sky.radiance(directions), rtol=0, atol=1e-3 * 1.7 * pixels.max())


def test_the_seam_of_the_map_is_as_smooth_as_anywhere_else(device: Device) -> None:
    """A map that varies smoothly through +Z: looking across the seam shows no step, on every blurred level."""
    angle = 2 * np.pi * (np.arange(256) + 0.5) / 256
    pixels = np.broadcast_to((2 + np.cos(angle))[None, :, None], (128, 256, 3)).astype(np.float32)
    query = prepared(device, environment=Environment(pixels))
    azimuth = np.pi + np.linspace(-0.2, 0.2, 401)
    directions = np.stack([np.sin(azimuth), 0 * azimuth, -np.cos(azimuth)], -1)
    for lod in range(4):
        steps = np.abs(np.diff(query.environment(directions, lod)[:, 0]))
        assert steps.max() < 1e-3


def test_irradiance_equals_its_basis(device: Device) -> None:
    from pellucid.surroundings.environment import irradiance_basis, irradiance_sh

    pixels = np.random.default_rng(8).random((16, 32, 3)).astype(np.float32)
    normals = unit(np.random.default_rng(9).normal(size=(100, 3)))
    found = prepared(device, environment=Environment(pixels)).irradiance(normals)
    np.testing.assert_allclose(found, irradiance_basis(normals) @ irradiance_sh(pixels), rtol=1e-5)


@pytest.mark.parametrize("camera", [CAMERA, CAMERA.replace(orthographic_height_m=2.0)], ids=["perspective", "parallel"])
@pytest.mark.parametrize("jitter", [(0.0, 0.0), (0.25, -0.4)])
def test_camera_rays_equal_those_of_the_scene(device: Device, camera: Camera, jitter: tuple[float, float]) -> None:
    query = prepared(device, camera=camera)
    query.surroundings.set_camera(camera, (32, 20), jitter)
    origins, directions = query.camera_rays()
    expected_origins, expected_directions = camera.pixel_rays((32, 20), jitter)
    np.testing.assert_allclose(origins, expected_origins, atol=1e-6)
    np.testing.assert_allclose(directions, expected_directions, atol=1e-6)


@pytest.mark.parametrize(("specular", "roughness"), [(0.0, 0.6), (0.04, 0.6), (0.04, 0.1), (0.9, 0.3), (1.0, 1.0)])
def test_a_white_surface_vanishes_in_a_uniform_environment(device: Device, specular: float, roughness: float) -> None:
    ball = Mesh.sphere(1.0, base_color=(1.0, 1.0, 1.0), specular=specular, roughness=roughness)
    query = prepared(device, ball, environment=Environment.constant((0.3, 1.0, 2.0)))
    rng = np.random.default_rng(10)
    origins = 3.0 * unit(rng.normal(size=(500, 3)))
    directions = unit(0.9 * unit(rng.normal(size=(500, 3))) - origins)
    assert query.hits(origins, directions)["valid"].mean() > 0.9
    np.testing.assert_allclose(query.radiance(origins, directions), [[0.3, 1.0, 2.0]] * 500, rtol=5e-3)


def matt_floor() -> Mesh:
    return Mesh.plane(20.0, base_color=(0.5, 0.5, 0.5), specular=0.0)


def floor_radiance(device: Device, light: object, points: np.ndarray, *more: Mesh) -> np.ndarray:
    query = prepared(device, matt_floor(), *more, environment=Environment.constant(0.0), lights=[light])
    start = points + np.array([0.0, 0.01, 0.0])
    return query.radiance(start, np.broadcast_to([0.0, -1.0, 0.0], points.shape))


def test_a_point_light_falls_off_with_the_square_and_the_cosine(device: Device) -> None:
    x = np.linspace(-3, 3, 13)
    points = np.stack([x, 0 * x, 0 * x], -1)
    found = floor_radiance(device, PointLight((0, 2, 0), color=(1, 0.5, 2), intensity=3.0), points)
    expected = 0.5 / np.pi * 3.0 * 2.0 / (4 + x * x) ** 1.5
    np.testing.assert_allclose(found, expected[:, None] * [1, 0.5, 2], rtol=1e-5)


def test_a_directional_light_gives_its_irradiance_times_the_cosine(device: Device) -> None:
    points = np.zeros((1, 3))
    found = floor_radiance(device, DirectionalLight((3, -4, 0), irradiance=2.0, cast_shadow=False), points)
    np.testing.assert_allclose(found, 0.5 / np.pi * 2.0 * 0.8, rtol=1e-6)


def test_an_area_light_gives_the_form_factor_of_a_rectangle(device: Device) -> None:
    """Below the centre, E = 4 L A(a, b): form factor of a rectangle from a corner (Cohen & Wallace 1993)."""
    a = b = 0.5
    corner = 2 * (a / np.hypot(1, a) * np.arctan(b / np.hypot(1, a))) / (2 * np.pi)
    light = AreaLight((0, 1, 0), (1, 0, 0), (0, 0, 1), radiance=2.0)
    points = np.random.default_rng(11).uniform(-1e-3, 1e-3, (10_000, 3)) * [1, 0, 1]  # noise below 0.15 %
    found = floor_radiance(device, light, points)
    np.testing.assert_allclose(found.mean(), 0.5 * 2.0 * 4 * corner, rtol=5e-3)


def test_an_area_light_is_dark_behind(device: Device) -> None:
    light = AreaLight((0, 1, 0), (0, 0, 1), (1, 0, 0), radiance=2.0)
    assert floor_radiance(device, light, np.zeros((1, 3))).max() == 0.0


@pytest.mark.parametrize("casts", [True, False])
def test_a_screen_stops_a_point_light_that_casts_shadows(device: Device, casts: bool) -> None:
    screen = Mesh.box(0.5, position=(0, 1, 0))
    x = np.array([0.0, 0.3, 2.0])
    light = PointLight((0, 2, 0), cast_shadow=casts)
    found = floor_radiance(device, light, np.stack([x, 0 * x, 0 * x], -1), screen)[:, 0]
    np.testing.assert_array_equal(found > 0, [not casts, not casts, True])


def test_a_base_colour_map_stands_the_right_way_up(device: Device) -> None:
    image = np.array([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 1, 1]]], np.float32).repeat(64, 0).repeat(64, 1)
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    card = Mesh(
        corners,
        np.array([[0, 1, 2], [0, 2, 3]]),
        uvs=0.5 + 0.5 * corners[:, :2],
        base_color=(1, 1, 1),
        base_color_map=image,
        specular=0.0,
    )
    origins = np.array([[-0.5, 0.5, 1], [0.5, 0.5, 1], [-0.5, -0.5, 1], [0.5, -0.5, 1]])
    found = prepared(device, card).radiance(origins, np.broadcast_to([0.0, 0.0, -1.0], (4, 3)))
    np.testing.assert_allclose(found, [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], atol=5e-3)


def test_only_what_changed_is_uploaded(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    ball, floor = Mesh.sphere(0.5), Mesh.plane(2.0)
    light = DirectionalLight((-1, -2, -1))
    scene = Scene(camera=CAMERA, environment=Environment.studio(), lights=[light], objects=[ball, floor])
    surroundings = Surroundings(device)
    surroundings.prepare(scene, SIZE)
    version, written = surroundings.shadow_version, []
    real_write = device.write
    monkeypatch.setattr(device, "write", lambda b, d, offset=0: (written.append(b.label), real_write(b, d, offset)))
    monkeypatch.setattr(device, "write_texture", lambda *a, **k: written.append("texture"))
    surroundings.prepare(scene.replace(camera=CAMERA.replace(fov_deg=30.0)), SIZE)
    assert written == ["frame"]
    surroundings.prepare(scene.replace(environment=scene.environment.replace(rotation_deg=10.0)), SIZE)
    assert written == ["frame"] * 2
    surroundings.prepare(scene.replace(objects=[ball.replace(roughness=0.1), floor]), SIZE)
    assert written == ["frame"] * 2 + ["materials", "frame"] and surroundings.shadow_version == version
    surroundings.prepare(scene.replace(lights=[light.replace(irradiance=1.0)]), SIZE)
    assert set(written[4:]) == {"lights", "materials", "frame"}
    surroundings.prepare(scene.replace(objects=[ball.replace(position=(0, 1, 0)), floor]), SIZE)
    assert "bvh_triangles" in written and surroundings.shadow_version > version


def test_memory_and_bounds_are_reported(device: Device) -> None:
    surroundings = prepared(device, Mesh.box(1.0, position=(1, 2, 3)), Mesh.plane(2.0)).surroundings
    lower, upper = surroundings.mesh_bounds_ws[0]
    np.testing.assert_allclose([lower, upper], [[0.5, 1.5, 2.5], [1.5, 2.5, 3.5]])
    assert surroundings.triangle_count == 14
    glossy = 16 * 2 * sum((128 >> k) ** 2 for k in range(6))
    assert 14 * 128 < surroundings.nbytes - glossy - SubmersionParams.itemsize < 20_000
