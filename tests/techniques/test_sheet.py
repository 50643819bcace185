"""Sheets in a picture: laws, where rays land, places in the picture and its borders."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.gpu.probe import probe
from pellucid.optics import exact_factor
from pellucid.scene.sphere_maps import sphere_map_uv
from pellucid.techniques.sheet import reference
from sheet_scenes import CAMERA, SIZE, N, level_hits, rays, shown, waves

RNG = np.random.default_rng(5)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


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
