"""Sheets in a picture: where rays land, places in the picture, borders, what is mirrored, errors, light, motion."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import Ripples
from pellucid.gpu.probe import probe
from pellucid.io.images import write_image
from pellucid.optics import exact_factor, fresnel_dielectric, opposite_factor, refract
from pellucid.scene.sphere_maps import sphere_map, sphere_map_uv
from pellucid.techniques.sheet import reference
from pellucid.techniques.sheet.prepare import faces_of, picture_levels, vertices_of

N = 1.333
SIZE = (48, 40)
ONE = pl.Environment.constant(1.0)
GREY = np.full((4, 4, 3), 0.5, np.float32)
CAMERA = pl.Camera((0.5, 1.1, 1.3), (0.05, 0.0, 0.1), fov_deg=38)
RNG = np.random.default_rng(5)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def waves(height_m: float = 0.02) -> np.ndarray:
    z, x = np.mgrid[0:48, 0:48] / 48 * 2 * np.pi
    return height_m * np.sin(2 * x + 0.5) * np.cos(z)


def drawn(renderer: pl.Renderer, camera: pl.Camera = CAMERA, size: tuple[int, int] = SIZE, **look: Any) -> pl.Frame:
    """A picture of a sheet in a uniform environment."""
    given = {"picture": GREY, "depth_m": 0.4, "size_m": 2.0, "medium": N} | look
    scene = pl.Scene(camera, ONE, objects=[pl.RefractiveSheet(**given)], tone_mapping="linear")
    return renderer.render(scene, size)


def shown(renderer: pl.Renderer, show: str, **look: Any) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of the pixels that show the sheet, and which do."""
    frame = drawn(renderer, show=show, **look)
    return frame.radiance.astype(np.float64), np.isfinite(frame.depth)


def rays(camera: pl.Camera, size: tuple[int, int] = SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Origins and unit directions (H, W, 3) through pixel centres."""
    world = np.linalg.inv(np.asarray(camera.view_matrix(), float))
    projection = np.asarray(camera.projection_matrix(size), float)
    x = (2 * (np.arange(size[0]) + 0.5) / size[0] - 1) / projection[0, 0]
    y = (1 - 2 * (np.arange(size[1]) + 0.5) / size[1]) / projection[1, 1]
    d = np.stack([*np.meshgrid(x, y), -np.ones((size[1], size[0]))], -1) @ world[:3, :3].T
    return np.broadcast_to(world[:3, 3], d.shape), d / np.linalg.norm(d, axis=-1, keepdims=True)


def level_hits(camera: pl.Camera, depth: float = 0.4, n: float = N) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where rays enter a level sheet, x and z of where they end by Snell's law, and their reflectance."""
    origin, d = rays(camera)
    p = origin - d * (origin[..., 1:2] / d[..., 1:2])
    up = np.broadcast_to((0.0, 1.0, 0.0), d.shape)
    down = refract(d, up, np.ones(d.shape[:2]), np.full(d.shape[:2], n)).direction
    return p, (p + down * (depth / -down[..., 1:2]))[..., (0, 2)], fresnel_dielectric(-d[..., 1], 1.0, n)


# ---- laws ------------------------------------------------------------------------------------------------------


def test_hits_and_places_are_those_of_the_reference(device: pl.Device) -> None:
    p = RNG.normal(size=(64, 3)).astype(np.float32).astype(float) * (1.0, 0.05, 1.0)
    d = RNG.normal(size=(64, 3))
    d[:, 1] = -np.abs(d[:, 1]) - 0.05
    d = (d / np.linalg.norm(d, axis=1, keepdims=True)).astype(np.float32).astype(float)
    p = p.astype(np.float32).astype(float)
    found = probe("techniques/sheet/shaders/hit", "sheet_hit", p, d, np.float32(0.4), device=device)
    expected = reference.picture_hit(p, d, float(np.float32(0.4)))
    np.testing.assert_allclose(found["xz"], expected.xz, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(found["path"], expected.path, rtol=1e-5)
    low, size = np.array([-0.5, -1.0]), np.array([1.0, 2.0])
    uv = probe("techniques/sheet/shaders/hit", "sheet_uv", expected.xz, low, size, device=device)
    np.testing.assert_allclose(uv, reference.picture_uv(expected.xz, low, size), atol=1e-6)
    n = RNG.normal(size=(64, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    turned = probe("techniques/sheet/shaders/hit", "sheet_facing", n, d, device=device)
    np.testing.assert_allclose(turned, reference.facing(n, d), atol=2e-4)
    assert (-np.sum(turned * d, axis=1) > 0.5 * reference.GRAZING).all()


def test_sphere_maps_and_colours_are_those_of_the_reference(device: pl.Device) -> None:
    d = RNG.normal(size=(64, 3))
    d = (d / np.linalg.norm(d, axis=1, keepdims=True)).astype(np.float32)
    for rule in ("ball", "linear"):
        found = probe("techniques/sheet/shaders/sphere_map", f"sphere_map_{rule}", d, device=device)
        np.testing.assert_allclose(found, sphere_map_uv(d, rule), atol=1e-5)
    values = np.linspace(-0.2, 1.2, 64).astype(np.float32)
    found = probe("techniques/sheet/shaders/false_colour", "sheet_false_colour", values, device=device)
    np.testing.assert_allclose(found, reference.false_colour(values), atol=2e-6)
    np.testing.assert_array_equal(reference.false_colour([0.0, 0.2, 0.4, 0.6, 0.8, 1.0]), [
        [0, 0, 0], [0, 0, 1], [0, 1, 0], [1, 1, 0], [1, 0, 0], [1, 1, 1]
    ])  # fmt: skip


def test_all_rays_end_at_one_depth_below_the_level() -> None:
    y = RNG.uniform(-0.3, 0.3, 200)
    p = np.stack([RNG.normal(size=200), y, RNG.normal(size=200)], 1)
    d = RNG.normal(size=(200, 3))
    d[:, 1] = -np.abs(d[:, 1]) - 0.01
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    hit = reference.picture_hit(p, d, 0.5)
    np.testing.assert_allclose(p[:, 1] + hit.path * d[:, 1], -0.5, atol=1e-12)
    np.testing.assert_allclose(hit.xz, (p + hit.path[:, None] * d)[:, (0, 2)], atol=1e-12)


def test_corners_of_the_mesh_are_corners_of_the_picture() -> None:
    low, high = np.array([-1.5, 0.25]), np.array([0.5, 2.25])
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [low[0], high[1]], [high[0], high[1]]])
    found = reference.picture_uv(corners, low, high - low)
    np.testing.assert_array_equal(found, [[0, 0], [1, 0], [0, 1], [1, 1]])
    np.testing.assert_allclose(reference.picture_uv((low + high) / 2, low, high - low), 0.5)


# ---- where rays land -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("per", ["fragment", "vertex"])
def test_a_level_sheet_shifts_by_snells_law(renderer: pl.Renderer, per: str) -> None:
    uv, seen = shown(renderer, "uv", per=per, segments=64)
    _, xz, reflectance = level_hits(CAMERA)
    expected = np.clip((xz + 1.0) / 2.0, 0.0, 1.0)
    inner = seen & (np.abs(xz) < 0.9).all(axis=-1)
    assert inner.sum() > 300
    # Between vertices 3 cm apart a straight line is off by h^2/8 times the second derivative, below 1 / m.
    bound = 2e-6 if per == "fragment" else 0.5 * (2.0 / 64) ** 2 / 8 * 1.0
    np.testing.assert_allclose(uv[..., :2][inner], expected[inner], atol=bound)
    np.testing.assert_allclose(uv[..., 2][inner], 1.0 - reflectance[inner], atol=2e-5 if per == "fragment" else 1e-3)


def test_a_parallel_camera_sees_a_parallel_shift(renderer: pl.Renderer) -> None:
    camera = pl.Camera((1.0, 1.0, 0.0), orthographic_height_m=1.0)
    uv, seen = shown(renderer, "uv", camera=camera)
    _, d = rays(camera)
    origin = np.asarray(camera.position)
    angle = np.arcsin(np.sin(np.pi / 4) / N)
    # The centre pixels look at the origin: they are shifted by depth * tan(refracted angle) towards -x.
    middle = uv[SIZE[1] // 2 - 1 : SIZE[1] // 2 + 1, SIZE[0] // 2 - 1 : SIZE[0] // 2 + 1, :2].mean(axis=(0, 1))
    assert seen.any() and np.isfinite(d).all() and origin[0] == 1.0
    np.testing.assert_allclose(2.0 * middle - 1.0, [-0.4 * np.tan(angle), 0.0], atol=1e-5)


def test_factor_zero_is_not_refracted(renderer: pl.Renderer) -> None:
    uv, seen = shown(renderer, "uv", refraction="approximate", factor=0.0, waves=waves(0.05))
    origin, d = rays(CAMERA)
    xz = (origin - d * ((origin[..., 1:2] + 0.4) / d[..., 1:2]))[..., (0, 2)]
    inner = seen & (np.abs(xz) < 0.98).all(axis=-1)
    assert inner.sum() > 300
    np.testing.assert_allclose(uv[..., :2][inner], (xz[inner] + 1.0) / 2.0, atol=2e-6)


def test_the_exact_factor_at_an_angle_is_snells_law_there(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.0, 1.0, 1.0), orthographic_height_m=1.0)
    factor = float(exact_factor(np.cos(np.pi / 4), 1.0, N))
    off, seen = shown(renderer, "error_values", camera=camera, refraction="approximate", factor=factor)
    assert seen.any() and np.abs(off[seen]).max() < 2e-6


def test_errors_are_those_of_the_reference(renderer: pl.Renderer) -> None:
    off, seen = shown(renderer, "error_values", refraction="approximate", scale=0.9)
    camera = CAMERA
    origin, d = rays(camera)
    p = (origin - d * (origin[..., 1:2] / d[..., 1:2])) / 0.9
    n = np.array([0.0, 1.0, 0.0])
    from pellucid.optics import fitted_factor

    factor = float(fitted_factor(1.0, N, np.radians(60.0)))
    approximate, exact = (reference.picture_hit(p, reference.inward(d, n, 1.0, N, k), 0.4).xz for k in (factor, None))
    expected = 0.9 * (approximate - exact)
    np.testing.assert_allclose(off[..., 1:][seen], expected[seen], atol=3e-6)
    np.testing.assert_allclose(off[..., 0][seen], np.linalg.norm(expected[seen], axis=-1), atol=3e-6)
    assert off[seen][:, 0].max() > 0.005
    colours, _ = shown(renderer, "error", refraction="approximate", scale=0.9, error_scale=0.02)
    np.testing.assert_allclose(colours[seen], reference.false_colour(off[..., 0] / 0.02)[seen], atol=2e-3)
    widths, _ = shown(renderer, "error_uv", refraction="approximate", scale=0.9, error_scale=0.02)
    np.testing.assert_allclose(widths[seen], reference.false_colour(off[..., 0] / 1.8 / 0.02)[seen], atol=2e-3)


def test_exact_in_every_fragment_has_no_error(renderer: pl.Renderer) -> None:
    off, seen = shown(renderer, "error_values", waves=waves())
    assert seen.any() and not off[seen].any()


def test_vertices_come_to_fragments_as_the_square_of_their_distance(renderer: pl.Renderer) -> None:
    worst = []
    for segments in (16, 32, 64):
        off, seen = shown(renderer, "error_values", segments=segments, per="vertex")
        worst.append(off[..., 0][seen].max())
    orders = np.log2(np.array(worst[:-1]) / worst[1:])
    assert (orders > 1.7).all() and (orders < 2.3).all(), worst
    rough, seen = shown(renderer, "error_values", segments=24, per="vertex", waves=waves())
    fine, _ = shown(renderer, "error_values", segments=384, per="vertex", waves=waves())
    assert fine[..., 0][seen].mean() < 0.02 * rough[..., 0][seen].mean()


# ---- borders ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("per", ["fragment", "vertex"])
@pytest.mark.parametrize("borders", ["clamp", "shrink"])
def test_both_rules_keep_places_in_the_picture(renderer: pl.Renderer, borders: str, per: str) -> None:
    look: dict[str, Any] = {"borders": borders, "per": per, "waves": waves(0.05), "depth_m": 1.5, "segments": 48}
    uv, seen = shown(renderer, "uv", **look)
    inside = uv[..., :2][seen]
    assert inside.min() >= 0.0 and inside.max() <= 1.0
    at_border = ((inside == 0.0) | (inside == 1.0)).any(axis=1).mean()
    # Clamped, a good part of the sheet shows nothing but borders; shrunk, next to none.
    assert at_border > 0.15 if borders == "clamp" else at_border < 0.02


def test_limits_shrink_to_the_largest_deviation() -> None:
    low, high = np.array([-1.0, -2.0]), np.array([1.0, 2.0])
    hits = np.array([[0.0, 0.0], [1.25, -1.0], [-0.5, -2.5], [0.5, 1.0]])
    found = reference.shrunk_limits(hits, low, high)
    np.testing.assert_array_equal(found[0], [-1.0, -2.5])
    np.testing.assert_array_equal(found[1], [1.25, 2.0])


def test_a_given_deviation_does_not_depend_on_the_camera(renderer: pl.Renderer) -> None:
    uv, seen = shown(renderer, "uv", borders="shrink", deviation_m=0.5)
    _, xz, _ = level_hits(CAMERA)
    np.testing.assert_allclose(uv[..., :2][seen], np.clip((xz[seen] + 1.5) / 3.0, 0.0, 1.0), atol=2e-6)


# ---- what is seen ----------------------------------------------------------------------------------------------


def test_the_top_of_the_picture_lies_towards_minus_z(renderer: pl.Renderer) -> None:
    picture = np.zeros((4, 4, 3), np.float32)
    picture[0, 0] = (1.0, 0.0, 0.0)  # upper left
    picture[3, 3] = (0.0, 1.0, 0.0)
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    found = drawn(renderer, above, (32, 32), picture=picture, reflection="none").radiance
    np.testing.assert_allclose(found[2, 2], (1.0, 0.0, 0.0), atol=2e-3)
    np.testing.assert_allclose(found[29, 29], (0.0, 1.0, 0.0), atol=2e-3)


def test_fresnels_law_or_a_fixed_share(renderer: pl.Renderer) -> None:
    _, _, reflectance = level_hits(CAMERA)
    exact = drawn(renderer)
    seen = np.isfinite(exact.depth)
    np.testing.assert_allclose(exact.radiance[..., 0][seen], (0.5 + 0.5 * reflectance)[seen], atol=2e-4)
    fixed = drawn(renderer, blend=0.3).radiance[..., 0][seen]
    np.testing.assert_allclose(fixed, 0.5 * 0.7 + 0.3, atol=2e-4)
    np.testing.assert_allclose(drawn(renderer, reflection="none").radiance[seen], 0.5, atol=2e-4)


def test_absorption_is_that_of_the_way_to_the_picture(renderer: pl.Renderer) -> None:
    frame = drawn(renderer, absorption=(0.0, 1.0, 4.0), reflection="none")
    p, xz, _ = level_hits(CAMERA)
    seen = np.isfinite(frame.depth) & (np.abs(xz) < 1.0).all(axis=-1)
    way = np.sqrt(((p[..., (0, 2)] - xz) ** 2).sum(axis=-1) + 0.4**2)[..., None]
    np.testing.assert_allclose(frame.radiance[seen], (0.5 * np.exp(-way * (0.0, 1.0, 4.0)))[seen], rtol=1e-3)


@pytest.mark.parametrize("rule", ["ball", "linear"])
def test_a_sphere_map_of_the_sky_shows_the_sky(renderer: pl.Renderer, rule: str) -> None:
    sky = pl.Environment.sky(40.0, 30.0, sun_disc=False)
    pictures = []
    for look in ({"reflection": "environment"}, {"reflection": "sphere_map", "sphere_map": sphere_map(sky, 512, rule)}):
        sheet = pl.RefractiveSheet(GREY * 0.0, waves=waves(), size_m=2.0, blend=1.0, sphere_rule=rule, **look)  # type: ignore[arg-type]
        frame = renderer.render(pl.Scene(CAMERA, sky, objects=[sheet]), SIZE)
        pictures.append(frame.radiance[np.isfinite(frame.depth)])
    assert pictures[0].std() > 0.01
    np.testing.assert_allclose(pictures[1], pictures[0], rtol=0.02, atol=0.002)


def test_from_below_there_is_snells_window_and_the_mirrored_picture(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.0, -0.2, 0.0), (0.0, 0.0, 0.0), up=(0, 0, -1), fov_deg=110)
    share, seen = shown(renderer, "uv", camera=camera, size_m=20.0)
    _, d = rays(camera)
    angle = np.degrees(np.arccos(np.clip(d[..., 1], -1.0, 1.0)))
    window = np.degrees(np.arcsin(1 / N))
    np.testing.assert_allclose(share[..., 2][seen & (angle > window + 0.1)], 1.0)
    inside = seen & (angle < window - 0.1)
    np.testing.assert_allclose(share[..., 2][inside], fresnel_dielectric(d[..., 1], N, 1.0)[inside], atol=1e-4)
    # Mirrored at the level: the ray goes 0.2 m up and 0.4 m down.
    beyond = seen & (angle > window + 0.1)
    xz = 0.6 * d[..., (0, 2)] / d[..., 1:2]
    np.testing.assert_allclose(share[..., :2][beyond], (xz[beyond] + 10.0) / 20.0, atol=2e-6)
    # Radiance in matter is n^2 times as large: a picture of 1 in a sky of 1 is n^2 everywhere.
    frame = drawn(renderer, camera, picture=np.ones((2, 2, 3), np.float32), size_m=20.0)
    np.testing.assert_allclose(frame.radiance[seen], N * N, rtol=1e-3)


def test_rays_that_rise_under_steep_waves_do_not_end_in_the_dark(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.1, -0.3, 1.2), (0.0, -0.05, -0.2), fov_deg=70)
    steep = waves(0.1)
    frame = drawn(renderer, camera, waves=steep, picture=np.ones((2, 2, 3), np.float32), absorption=(0.3, 0.3, 0.3))
    assert frame.radiance[np.isfinite(frame.depth)].min() > 0.02


def test_the_factor_from_below_undoes_the_one_from_above(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.0, -0.2, 0.0), up=(0, 0, -1), fov_deg=150)
    share, seen = shown(renderer, "uv", camera=camera, size_m=20.0, refraction="approximate", factor=N - 1.0)
    _, d = rays(camera)
    # i - k n passes as long as cos > -k
    passes = d[..., 1] > -float(opposite_factor(N - 1.0))
    window = seen & passes & (d[..., 1] > np.sqrt(1 - 1 / N**2))
    np.testing.assert_allclose(share[..., 2][window], fresnel_dielectric(d[..., 1], N, 1.0)[window], atol=1e-4)
    np.testing.assert_allclose(share[..., 2][seen & ~passes], 1.0)


def test_meshes_cut_the_sheet_and_are_seen_through_it(renderer: pl.Renderer) -> None:
    ball = pl.Mesh.sphere(0.25, emission=(5.0, 0.0, 0.0), base_color=(0, 0, 0), specular=0.0)
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    look: dict[str, Any] = {"picture": GREY, "depth_m": 0.6, "size_m": 2.0, "medium": N, "reflection": "none"}
    seen = {}
    for y, through in ((0.0, True), (-0.4, True), (-0.4, False), (-0.9, True)):
        scene = pl.Scene(
            above, ONE, objects=[pl.RefractiveSheet(**look, meshes=through), ball.replace(position=(0.0, y, 0.0))]
        )
        frame = renderer.render(scene, (32, 32))
        seen[y, through] = frame.radiance[16, 16, 0], frame.depth[16, 16]
    np.testing.assert_allclose(seen[0.0, True], (5.0, 2.75), atol=0.01)  # stands out of the sheet
    np.testing.assert_allclose(seen[-0.4, True], (5.0, 3.0), atol=0.01)
    np.testing.assert_allclose(seen[-0.4, False], (0.5, 3.0), atol=0.01)
    np.testing.assert_allclose(seen[-0.9, True], (0.5, 3.0), atol=0.01)  # below the picture


@pytest.mark.parametrize("albedo", [1.0, 0.5])
def test_a_lit_white_picture_under_a_level_sheet_vanishes(renderer: pl.Renderer, albedo: float) -> None:
    frame = drawn(renderer, picture=np.full((2, 2, 3), albedo), lit=True)
    seen = np.isfinite(frame.depth)
    if albedo == 1.0:
        np.testing.assert_allclose(frame.radiance[seen], 1.0, atol=1e-3)
    else:
        assert (frame.radiance[seen] < 0.6).all() and (frame.radiance[seen] > 0.2).all()


def test_a_lit_picture_has_the_light_of_a_lamp_through_the_sheet(renderer: pl.Renderer) -> None:
    lamp = pl.DirectionalLight((1.0, -1.0, 0.0), irradiance=2.0)
    sheet = pl.RefractiveSheet(np.full((2, 2, 3), 0.4), 0.5, 2.0, medium=N, lit=True, absorption=(0, 1, 2))
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=1.0)
    dark = pl.Environment.constant(0.0)
    found = renderer.render(pl.Scene(above, dark, [lamp], [sheet]), (16, 16)).radiance[8, 8]
    c, a = np.sqrt(0.5), np.array([0.0, 1.0, 2.0])
    inside = np.sqrt(1.0 - 0.5 / N**2)
    e = 2.0 * c * (1.0 - fresnel_dielectric(c, 1.0, N)) * np.exp(-a * 0.5 / inside)
    from pellucid.surroundings.diffuse import diffuse_shares

    back = diffuse_shares(N, np.exp(-a * 0.5))[1]
    leaves = (1.0 - fresnel_dielectric(1.0, N, 1.0)) / N**2 * np.exp(-a * 0.5)
    np.testing.assert_allclose(found, 0.4 * e / np.pi / (1.0 - 0.4 * back) * leaves, rtol=2e-3)


# ---- geometry and motion ---------------------------------------------------------------------------------------


def test_a_sheet_may_be_turned_and_enlarged(renderer: pl.Renderer) -> None:
    plain = drawn(renderer, waves=waves(), show="uv")
    # Turned by 90 degrees about y, x goes to -z and z to x.
    eye, target = (2.0 * np.array([v[2], v[1], -v[0]]) + (0, 5, 0) for v in (CAMERA.position, CAMERA.target))
    placed = {"rotation": (0, 90, 0), "scale": 2.0, "position": (0, 5, 0)}
    turned = drawn(renderer, pl.Camera(tuple(eye), tuple(target), fov_deg=38), waves=waves(), show="uv", **placed)
    np.testing.assert_allclose(turned.radiance, plain.radiance, atol=2e-5)
    np.testing.assert_allclose(turned.depth, 2.0 * plain.depth, rtol=1e-5)


def test_a_grid_faces_up_and_has_the_slopes_of_its_waves() -> None:
    x = (np.arange(128) + 0.5) / 128 * 2.0 - 1.0
    sheet = pl.RefractiveSheet(GREY, size_m=2.0, waves=np.broadcast_to(0.05 * np.sin(3 * x), (96, 128)), segments=32)
    vertices, faces = vertices_of(sheet, 0.0), faces_of(sheet)
    assert len(vertices) == 33 * 33 and faces.max() == len(vertices) - 1
    p = vertices["position"].astype(float)
    corner = p[faces]
    assert (np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 1] > 0.0).all()
    inner = np.abs(p[:, 0]) < 0.99
    np.testing.assert_allclose(p[inner, 1], 0.05 * np.sin(3 * p[inner, 0]), atol=5e-5)
    slope = -vertices["normal"][:, 0] / vertices["normal"][:, 1]
    np.testing.assert_allclose(slope[inner], 0.15 * np.cos(3 * p[inner, 0]), atol=2e-3)


def test_a_mesh_of_the_same_shape_is_the_same_sheet(renderer: pl.Renderer) -> None:
    grid = pl.RefractiveSheet(GREY, size_m=2.0, waves=waves(), segments=40)
    vertices = vertices_of(grid, 0.0)
    mesh = pl.Mesh(vertices["position"], faces_of(grid).astype(np.int32), vertices["normal"])
    first = drawn(renderer, waves=waves(), segments=40, show="uv")
    second = drawn(renderer, mesh=mesh, size_m=1.0, show="uv")
    np.testing.assert_allclose(second.radiance, first.radiance, atol=1e-6)


def test_levels_of_a_picture_keep_its_mean() -> None:
    picture = RNG.uniform(size=(12, 7, 3)).astype(np.float32)
    levels = picture_levels(picture)
    assert [level.shape for level in levels] == [(12, 7, 4), (6, 3, 4), (3, 1, 4), (1, 1, 4)]
    np.testing.assert_allclose(levels[-1][0, 0, :3], picture.mean(axis=(0, 1)), rtol=1e-5)


def test_waves_move_with_time_and_again_after_a_drop(renderer: pl.Renderer) -> None:
    water = Ripples((48, 48), 2.0 / 48, 0.4)
    camera = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    scene = pl.Scene(camera, ONE, objects=[pl.RefractiveSheet(GREY, 0.4, 2.0, water, show="uv")])
    calm = renderer.render(scene, (32, 32)).radiance
    water.drop(0.0, 0.0, 0.15, 0.03)
    dent, first, second, again = (renderer.render(scene, (32, 32), time=t).radiance for t in (0.0, 0.2, 0.6, 0.2))
    assert min(np.abs(a - b).max() for a, b in ((calm, dent), (dent, first), (first, second))) > 1e-3
    np.testing.assert_array_equal(first, again)


def test_heights_that_fail_in_motion_are_named(renderer: pl.Renderer) -> None:
    class Broken:
        shape, tile_m, limits_m = (4, 4), (1.0, 1.0), (0.0, 0.1)

        def advance(self, time_s: float) -> np.ndarray:
            return np.full((4, 4), np.nan if time_s > 1.0 else -0.5 if time_s > 0.5 else 0.0, np.float32)

    scene = pl.Scene(CAMERA, ONE, objects=[pl.RefractiveSheet(GREY, 0.4, waves=Broken())])
    renderer.render(scene, (8, 8))
    with pytest.raises(pl.SceneError, match="not finite"):
        renderer.render(scene, (8, 8), time=2.0)
    with pytest.raises(pl.SceneError, match="picture lies"):
        renderer.render(scene, (8, 8), time=0.7)


def test_what_moves_compiles_nothing(renderer: pl.Renderer) -> None:
    drawn(renderer, refraction="approximate")
    technique = renderer._techniques[pl.RefractiveSheet]
    before = len(technique.pipelines)
    looks: list[dict[str, Any]] = [
        {"factor": 0.7},
        {"medium": 1.5},
        {"blend": 0.2},
        {"depth_m": 1.0},
        {"borders": "shrink"},
    ]
    looks += [{"waves": waves()}, {"absorption": (1, 1, 1)}, {"rotation": (0, 30, 0)}, {"picture": GREY + 0.1}]
    for look in looks:
        drawn(renderer, refraction="approximate", **look)
    assert len(technique.pipelines) == before > 0
    assert renderer.nbytes > technique.nbytes > 0


def test_several_sheets_stand_in_one_scene(renderer: pl.Renderer) -> None:
    reds = np.array((1.0, 0.0, 0.0), np.float32) * np.ones((2, 2, 3), np.float32)
    sheets = [
        pl.RefractiveSheet(reds[..., order], medium=N, reflection="none", position=(x, 0.0, 0.0))
        for x, order in ((-0.6, (0, 1, 2)), (0.6, (2, 1, 0)))
    ]
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    renderer.render(pl.Scene(above, ONE, objects=[sheets[0], sheets[0]]), (32, 24))
    renderer.render(pl.Scene(above, ONE, objects=[sheets[1], sheets[0], sheets[0]]), (32, 24))
    found = renderer.render(pl.Scene(above, ONE, objects=sheets), (32, 24)).radiance
    np.testing.assert_allclose(found[12, 8], (1.0, 0.0, 0.0), atol=1e-3)
    np.testing.assert_allclose(found[12, 24], (0.0, 0.0, 1.0), atol=1e-3)


def test_the_sheet_of_the_article(renderer: pl.Renderer) -> None:
    sky = sphere_map(pl.Environment.sky(40.0), 64, "linear")
    sheet = pl.RefractiveSheet.article(GREY, sphere_map=sky, sphere_rule="linear", waves=waves(), size_m=2.0)
    assert (sheet.refraction, sheet.per, sheet.borders) == ("approximate", "vertex", "clamp")
    assert (sheet.reflection, sheet.blend) == ("sphere_map", 0.3)
    assert pl.RefractiveSheet.article(GREY).reflection == "none"
    frame = renderer.render(pl.Scene(CAMERA, ONE, objects=[sheet]), SIZE)
    assert np.isfinite(frame.radiance).all() and frame.radiance[np.isfinite(frame.depth)].std() > 0.001


def test_a_scene_file_renders_from_the_command_line(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from pellucid.cli.app import app

    write_image(tmp_path / "floor.png", RNG.integers(0, 255, (8, 8, 3)).astype(np.uint8))
    np.savez(tmp_path / "pond.npz", waves=waves())
    text = """
        [camera]
        position = [0.5, 1.1, 1.3]
        [[objects]]
        type = "refractive_sheet"
        picture = "floor.png"
        depth_m = 0.3
        size_m = [2, 1.5]
        arrays = "pond.npz"
        refraction = "approximate"
    """
    assert tomllib.loads(text)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    out = tmp_path / "scene.png"
    run = CliRunner().invoke(app, ["render", str(tmp_path / "scene.toml"), "-o", str(out), "--size", "48x36"])
    assert run.exit_code == 0, run.output
    assert out.stat().st_size > 500
