"""Any camera sees what rays see: mirrored, clipped, widened; and what is left out could not have been seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.gpu import Device
from pellucid.scene import Camera, DirectionalLight, Environment, Mesh, Scene
from pellucid.surroundings import Query, Surroundings
from pellucid.surroundings.camera import View, view_of
from pellucid.surroundings.culling import clusters, visible_ranges
from pellucid.surroundings.views import EVERYTHING, SceneView, Shown, above, below

SIZE = (72, 54)
CAMERA = Camera((1.2, 1.4, 3.0), (0.0, 0.1, 0.0), fov_deg=50.0)


def still_life() -> Scene:
    objects = [
        Mesh.sphere(0.6, position=(-0.4, 0.0, 0.0), base_color=(0.8, 0.2, 0.1)),
        Mesh.box(0.6, position=(0.7, 0.1, 0.4), rotation=(0, 30, 0), double_sided=False),
        Mesh.plane(4.0, position=(0, -0.7, 0)),
    ]
    lights = [DirectionalLight((-1, -2, -1))]
    return Scene(camera=CAMERA, environment=Environment.studio(), lights=lights, objects=objects)


@pytest.fixture(scope="module")
def around(device: Device) -> Surroundings:
    out = Surroundings(device)
    out.prepare(still_life(), SIZE)
    return out


def drawn(around: Surroundings, view: View, shown: Shown = EVERYTHING) -> tuple[np.ndarray, np.ndarray]:
    """Radiance (H, W, 3) and depth (H, W), with the sky; shadow maps are left empty, for rays too."""
    device = around.device
    color = device.texture(size=SIZE, format="rgba32float", usage=("render",))
    depth = device.texture(size=SIZE, format="depth32float", usage=("render",))
    encoder = device.wgpu.create_command_encoder()
    targets = color.create_view(), depth.create_view()
    SceneView(device).draw(encoder, *targets, around, shown, view=view, size=SIZE, sky=True)
    device.wgpu.queue.submit([encoder.finish()])
    return device.read_texture(color)[..., :3], device.read_texture(depth)[..., 0]


def rays(view: View) -> tuple[np.ndarray, np.ndarray]:
    """World rays of the pixel centres, by the matrices alone: (P, 3) each."""
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    ndc = np.stack([2 * columns / SIZE[0] - 1, 1 - 2 * rows / SIZE[1]], -1).reshape(-1, 2)
    ways = np.concatenate([ndc * view.half_extent, np.ones((len(ndc), 1))], axis=1) @ view.axes
    return np.broadcast_to(view.position, ways.shape), ways / np.linalg.norm(ways, axis=1, keepdims=True)


def mirrored(view: View) -> View:
    flip = np.diag([1.0, -1.0, 1.0, 1.0])
    return View(view.view_from_world @ flip, view.projection, view.near_m, view.far_m)


def test_a_mirrored_view_sees_what_mirrored_rays_see(around: Surroundings) -> None:
    """Its picture is left-handed, yet a single-sided box shows its fronts."""
    view = mirrored(view_of(CAMERA.replace(position=(1.2, 0.5, 3.0)), SIZE))
    assert view.position[1] == pytest.approx(-0.5)
    radiance, depth = drawn(around, view)
    query = Query(around)
    origins, ways = rays(view)
    seen = query.radiance(origins, ways).reshape(radiance.shape)
    different = ~np.isclose(radiance, seen, rtol=5e-3, atol=1e-3).all(axis=-1)
    assert different.mean() < 0.004 and (depth > 0).mean() > 0.3


def test_a_clip_plane_cuts_exactly_there(around: Surroundings) -> None:
    """Every pixel shows the first surface of the kept side, to where a ray meets the plane."""
    view = view_of(CAMERA, SIZE)
    origins, ways = rays(view)
    for shown, keeps in ((Shown(below(0.1)), -1.0), (Shown(above(0.1)), 1.0)):
        _, depth = drawn(around, view, shown)
        axis = ways @ view.axes[2]
        metres = np.divide(view.near_m, depth.ravel(), out=np.full(depth.size, np.inf), where=depth.ravel() > 0)
        heights = (origins + ways * (metres / axis)[:, None])[:, 1][np.isfinite(metres)]
        assert len(heights) > 300 and (keeps * (heights - 0.1)).min() > -1e-4
        assert np.abs(heights - 0.1).min() < 0.05


def test_backs_are_left_out_before_clipping(around: Surroundings) -> None:
    """A ball cut open shows its inside, or nothing of it: then the floor beneath."""
    view = view_of(Camera((-0.4, 2.0, 0.01), (-0.4, 0.0, 0.0), fov_deg=20.0), SIZE)
    middle = SIZE[1] // 2, SIZE[0] // 2
    _, open_ball = drawn(around, view, Shown(below(0.0)))
    _, no_backs = drawn(around, view, Shown(below(0.0), cull_back_faces=True))
    assert view.near_m / open_ball[middle] == pytest.approx(2.6, abs=0.03)
    assert view.near_m / no_backs[middle] == pytest.approx(2.7, abs=0.03)


def test_clusters_are_one_cut_through_the_hierarchy(around: Surroundings) -> None:
    parts = clusters(around.geometry)
    assert parts.first[0] == 0 and parts.last[-1] == around.triangle_count
    assert (parts.first[1:] == parts.last[:-1]).all() and len(parts.first) > 10
    triangles = around.geometry.triangles[: around.triangle_count]
    corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1)
    for low, high, first, last in zip(parts.lower, parts.upper, parts.first, parts.last, strict=True):
        inside = corners[first:last]
        assert (inside >= low).all() and (inside <= high).all()


def test_no_triangle_that_shows_is_left_out(around: Surroundings) -> None:
    """Of each triangle left out, all corners are on the far side of some plane."""
    parts = clusters(around.geometry)
    rng = np.random.default_rng(5)
    triangles = around.geometry.triangles[: around.triangle_count]
    corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1).astype(np.float64)
    plane = np.array(below(0.2))
    shares = []
    for _ in range(40):
        view = view_of(Camera(rng.normal(size=3) * 2, rng.normal(size=3), fov_deg=35.0), SIZE)
        clip = view.projection @ view.view_from_world
        kept = np.zeros(len(corners), bool)
        for first, count in visible_ranges(parts, clip, plane):
            kept[first : first + count] = True
        points = np.concatenate([corners, np.ones((*corners.shape[:2], 1))], axis=-1)
        x, y, _, w = np.moveaxis(points @ clip.T, -1, 0)
        out = np.stack([x < -w, x > w, y < -w, y > w, w < view.near_m, points @ plane < 0])
        assert (kept | out.all(axis=-1).any(axis=0)).all()
        shares.append(kept.mean())
    assert 0.05 < np.mean(shares) < 0.7


def test_an_empty_scene_is_sky(device: Device) -> None:
    around: Any = Surroundings(device)
    around.prepare(Scene(camera=CAMERA, environment=Environment.constant(0.25)), SIZE)
    radiance, depth = drawn(around, view_of(CAMERA, SIZE))
    assert np.allclose(radiance, 0.25) and not depth.any()
