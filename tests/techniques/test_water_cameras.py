"""Cameras of water: the pivot and the angle of the source, mirror images, and pictures that hold what rays need."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics.snell import reflect, refract
from pellucid.scene import Camera
from pellucid.surroundings.camera import View, view_of
from pellucid.techniques.water.cameras import (
    Basin,
    fitted,
    pictures,
    ray_of,
    reflection_camera,
    refraction_camera,
    visible_surface,
    widened,
)

SIZE = (64, 48)
LEVEL = 0.5
BASIN = Basin(LEVEL, (-20.0, -20.0), (20.0, 20.0), 0.0, 1.333, 1.0, -2.5)
VIEW = view_of(Camera((0.5, 2.5, 8.0), (0.0, 0.0, 0.0), fov_deg=50.0), SIZE)
N = np.array([0.0, 1.0, 0.0])


def inside(view: View, points: np.ndarray) -> np.ndarray:
    clip = np.c_[points, np.ones(len(points))] @ (view.projection @ view.view_from_world).T
    return (clip[:, 3] > 0) & (np.abs(clip[:, :2]) <= 1.0001 * clip[:, 3:]).all(axis=1)


def test_the_lower_border_looks_along_the_refracted_ray() -> None:
    """Equations 1 and 2: from the new place, the same point of the picture shows O, seen along R."""
    origin, incident = ray_of(VIEW, (0.0, -1.0))
    pivot = origin + incident * (LEVEL - origin[1]) / incident[1]
    bent = refract(incident, N, 1.0, 1.333).direction
    turned = refraction_camera(VIEW, LEVEL, 1.0, 1.333)
    position, way = ray_of(turned, (0.0, -1.0))
    assert np.allclose(way, bent, atol=1e-12)
    assert np.allclose(position + way * np.linalg.norm(pivot - origin), pivot, atol=1e-12)
    assert np.allclose(turned.half_extent, VIEW.half_extent)


def test_equal_indices_leave_the_camera_alone_and_so_does_a_look_upwards() -> None:
    assert np.allclose(refraction_camera(VIEW, LEVEL, 1.3, 1.3).view_from_world, VIEW.view_from_world)
    upwards = view_of(Camera((0, 2, 0), (0, 9, -3)), SIZE)
    assert refraction_camera(upwards, LEVEL, 1.0, 1.333) is upwards


def test_a_mirrored_camera_sees_along_mirrored_rays() -> None:
    mirror = reflection_camera(VIEW, LEVEL)
    for ndc in ((0.3, -0.4), (-0.8, -1.0)):
        origin, way = ray_of(VIEW, ndc)
        place, mirrored = ray_of(mirror, ndc)
        met = origin + way * (LEVEL - origin[1]) / way[1]
        assert np.allclose(mirrored, reflect(way, N), atol=1e-12)
        assert np.allclose(np.cross(met - place, mirrored), 0.0, atol=1e-9)


@pytest.mark.parametrize("factor", [1.2, 1.5])
def test_a_wider_field_shows_what_lay_outside(factor: float) -> None:
    origin, way = ray_of(VIEW, (factor, 0.0))
    wide_origin, wide_way = ray_of(widened(VIEW, factor), (1.0, 0.0))
    assert np.allclose(way, wide_way) and np.allclose(origin, wide_origin)


@pytest.mark.parametrize("height", [2.5, -1.0])
@pytest.mark.parametrize("orthographic", [None, 6.0])
def test_fitted_pictures_hold_all_rays_of_level_water(height: float, orthographic: float | None) -> None:
    camera = Camera((0.5, height, 8.0), (0.0, LEVEL - 0.4 * np.sign(LEVEL - height), 0.0), fov_deg=50.0)
    view = view_of(camera.replace(orthographic_height_m=orthographic), SIZE)
    below, above = pictures(view, BASIN, "fitted", 4.0)
    points, ways = visible_surface(view, BASIN)
    within = height < LEVEL
    normal = -N if within else N
    mirrored = reflect(ways, normal)
    bent = refract(ways, np.broadcast_to(normal, ways.shape), *((1.333, 1.0) if within else (1.0, 1.333)))
    down = mirrored if within else bent.direction
    ends = points + down * ((LEVEL + 2.5) / np.maximum(-down[:, 1], 0.05))[:, None]
    assert below is not None and inside(below, points).all() and inside(below, ends).mean() > 0.99
    up, start = (bent.direction[bent.valid], points[bent.valid]) if within else (mirrored, points)
    if len(up) and not orthographic:
        assert above is not None and inside(above, start + 1e4 * up).mean() > 0.99


def test_a_wider_field_restores_what_refraction_turned_out_of_the_picture() -> None:
    points, ways = visible_surface(VIEW, BASIN)
    bent = refract(ways, np.broadcast_to(N, ways.shape), 1.0, 1.333).direction
    ends = points + bent * (-3.0 / bent[:, 1])[:, None]
    shares = []
    for mode, field_of_view in (("mihalik", 1.0), ("mihalik", 1.5), ("fitted", 2.0)):
        below, _ = pictures(VIEW, BASIN, mode, field_of_view)
        assert below is not None
        shares.append(inside(below, ends).mean())
    assert shares[0] < 0.95 and shares[1] > 0.99 and shares[2] > 0.999


def test_water_out_of_sight_has_no_pictures() -> None:
    away = view_of(Camera((0, 2, 0), (0, 9, -3)), SIZE)
    assert pictures(away, BASIN, "fitted", 1.5) == (None, None)


def test_a_pond_between_the_rays_is_found() -> None:
    pond = Basin(LEVEL, (-0.05, -0.05), (0.05, 0.05), 0.0, 1.333, 1.0, 0.0)
    points, _ = visible_surface(VIEW, pond)
    assert len(points) > 50


def test_fitting_keeps_the_place_and_the_sense_of_rotation() -> None:
    mirror = reflection_camera(VIEW, LEVEL)
    points, _ = visible_surface(VIEW, BASIN)
    fit = fitted(mirror, points, 2.0)
    assert np.allclose(fit.position, mirror.position)
    assert np.linalg.det(fit.view_from_world[:3, :3]) == pytest.approx(-1.0)
    assert inside(fit, points).all()
