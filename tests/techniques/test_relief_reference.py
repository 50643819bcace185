"""The oracle of reliefs against surfaces and layers that have formulas."""

from __future__ import annotations

import numpy as np

from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.techniques.relief.reference import (
    NONE,
    SOLID,
    TRANSLUCENT,
    HeightField,
    ReliefRays,
    first_below,
    relief_first,
    relief_leave,
    through_layer,
)

TILE = (0.4, 0.2)


def unit(*d: float) -> np.ndarray:
    v = np.array([d], dtype=float)
    return v / np.linalg.norm(v)


def lattice(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """u and v of the texel centres."""
    u, v = np.meshgrid((np.arange(columns) + 0.5) / columns, 1.0 - (np.arange(rows) + 0.5) / rows)
    return u, v


def test_a_tilted_plane_is_met_where_its_equation_says() -> None:
    u, v = lattice(16, 32)
    field = HeightField(0.03 * u - 0.02 * v, tiling=False)
    rng = np.random.default_rng(0)
    d = rng.uniform(-0.4, 0.4, size=(200, 3))
    d[:, 2] = -0.5 - rng.random(200)
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    start = 0.35 + 0.3 * rng.random((200, 2))
    rays = ReliefRays.of(start, 0.04, d, TILE)
    slope = rays.dh - 0.03 * rays.duv[:, 0] + 0.02 * rays.duv[:, 1]
    expected = -(0.04 - 0.03 * start[:, 0] + 0.02 * start[:, 1]) / slope
    np.testing.assert_allclose(first_below(field, rays, 10.0), expected, rtol=1e-9)


def test_a_saddle_is_met_at_the_root_of_its_quadratic() -> None:
    # One cell, A + D x y: along the diagonal from (0, 1) to (1, 0) the surface is A + D s (1 - s).
    field = HeightField(np.array([[0.0, 0.0], [0.0, 0.01]]), tiling=False)
    assert field.height([[0.5, 0.5]])[0] == 0.0025
    start = np.array([[0.25, 0.25]])
    rays = ReliefRays(start, np.array([0.002]), np.array([[0.5, 0.5]]), np.zeros(1), np.zeros(1))
    # In cell coordinates x = s, y = 1 - s: 0.01 s (1 - s) = 0.002.
    s = (1 - np.sqrt(1 - 0.8)) / 2
    np.testing.assert_allclose(first_below(field, rays, 10.0), [s], rtol=1e-12)


def test_the_first_of_several_meetings_counts_whatever_the_height_of_the_walls() -> None:
    rng = np.random.default_rng(4)
    field = HeightField(0.05 * rng.random((9, 12)))
    d = rng.normal(size=(300, 3)) * (1, 1, 0.2)
    d[:, 2] = -0.02 - np.abs(d[:, 2])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    rays = ReliefRays.of(rng.random((300, 2)) * 3 - 1, 0.05, d, TILE)
    t = first_below(field, rays, 5.0)
    assert np.isfinite(t).all()
    np.testing.assert_allclose(rays.height_at(t), field.height(rays.uv_at(t)), atol=1e-12)
    for share in np.linspace(0.0, 0.999, 400):
        before = t * share
        assert (rays.height_at(before) >= field.height(rays.uv_at(before)) - 1e-12).all()


def test_a_bent_ray_leaves_over_the_horizon() -> None:
    field = HeightField(np.zeros((4, 4)))
    ray = ReliefRays(np.zeros((1, 2)), np.array([0.01]), np.array([[2.0, 0.0]]), np.array([-0.02]), np.array([0.011]))
    assert np.isinf(first_below(field, ray, 10.0))
    met = ReliefRays(ray.uv, ray.h, ray.duv, ray.dh, np.array([0.009]))
    expected = (0.02 - np.sqrt(0.02**2 - 4 * 0.009 * 0.01)) / (2 * 0.009)
    np.testing.assert_allclose(first_below(field, met, 10.0), [expected], rtol=1e-9)


def test_a_ray_that_starts_in_matter_is_there() -> None:
    rays = ReliefRays.of((0.3, 0.3), -0.01, unit(0, 0, -1), TILE)
    assert first_below(HeightField(np.zeros((4, 4))), rays, 1.0).tolist() == [0.0]


def test_the_solid_layer_wins_ties() -> None:
    solid = HeightField(np.full((4, 4), 0.01))
    rays = ReliefRays.of((0.2, 0.7), 0.05, unit(0.1, 0.2, -1), TILE)
    for upper, expected in ((0.02, TRANSLUCENT), (0.01, SOLID), (0.0, SOLID)):
        _, layer = relief_first(solid, HeightField(np.full((4, 4), upper)), rays, 1.0)
        assert layer.tolist() == [expected]
    assert relief_first(solid, None, rays, 0.01)[1].tolist() == [NONE]


def test_from_inside_a_layer_is_left_at_its_surface_or_its_ground() -> None:
    solid, upper = HeightField(np.zeros((4, 4))), HeightField(np.full((4, 4), 0.02))
    rising = ReliefRays.of((0.2, 0.7), 0.01, unit(1, 0, 1), TILE)
    t, layer = relief_leave(solid, upper, rising, 1.0)
    assert layer.tolist() == [TRANSLUCENT]
    np.testing.assert_allclose(t, 0.01 * np.sqrt(2), rtol=1e-12)
    falling = ReliefRays.of((0.2, 0.7), 0.01, unit(1, 0, -1), TILE)
    t, layer = relief_leave(solid, upper, falling, 1.0)
    assert layer.tolist() == [SOLID]
    np.testing.assert_allclose(t, 0.01 * np.sqrt(2), rtol=1e-12)


def test_a_slab_bends_reflects_and_absorbs_as_its_formulas_say() -> None:
    solid, upper = HeightField(np.zeros((4, 4))), HeightField(np.full((4, 4), 0.02))
    angle, n = np.radians(50.0), 1.5
    rays = ReliefRays.of((0.1, 0.3), 0.05, unit(np.sin(angle), 0, -np.cos(angle)), TILE)
    seen = through_layer(solid, upper, TILE, rays, (1.0, n), (3.0, 0.0, 20.0), reach=1.0)
    inner = np.arcsin(np.sin(angle) / n)
    path = 0.02 / np.cos(inner)
    np.testing.assert_allclose(seen.path, [path], rtol=1e-6)
    np.testing.assert_allclose(seen.reflectance, fresnel_dielectric(np.cos(angle), 1.0, n), rtol=1e-12)
    np.testing.assert_allclose(seen.transmittance, np.exp(-path * np.array([[3.0, 0.0, 20.0]])), rtol=1e-6)
    across = 0.03 * np.tan(angle) + 0.02 * np.tan(inner)
    np.testing.assert_allclose(seen.uv, [[0.1 + across / TILE[0], 0.3]], rtol=1e-6)
    assert seen.layer.tolist() == [SOLID]
