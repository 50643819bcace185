"""Reliefs in a picture: frames of meshes, depth, silhouettes, borders, and what moves without being made again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.scene.shapes import sphere, torus
from pellucid.techniques.relief.frames import hull_of, open_borders, tangents

SKY = pl.Environment.constant(1.0)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def from_above(height_m: float = 1.2, **more: Any) -> pl.Camera:
    return pl.Camera(position=(0, 2, 0), up=(0, 0, -1), orthographic_height_m=height_m, far_m=5.0, **more)


def test_tangents_are_the_derivatives_by_the_texture_also_where_it_is_mirrored() -> None:
    plane = pl.Mesh.plane((2.0, 3.0))
    uvs = np.asarray(plane.uvs, float)
    for flipped in (uvs, uvs * (-1.0, 1.0)):
        along, across = tangents(plane.vertices.astype(float), plane.faces, plane.normals, flipped)  # type: ignore[arg-type]
        sign = np.sign(flipped[:, 0].sum())
        np.testing.assert_allclose(along, np.tile([sign * 2.0, 0.0, 0.0], (4, 1)), atol=1e-12)
        np.testing.assert_allclose(across, np.tile([0.0, 0.0, -3.0], (4, 1)), atol=1e-12)


def test_a_sphere_and_a_torus_are_closed_and_bend_as_they_should() -> None:
    ball, ring = sphere(0.5, 128), torus(1.0, 0.25, 128)
    for shape in (ball, ring):
        assert len(open_borders(shape.vertices, shape.faces, shape.normals)) == 0
        middle = shape.vertices[shape.faces].mean(axis=1)
        face = np.cross(*(shape.vertices[shape.faces[:, k]] - shape.vertices[shape.faces[:, 0]] for k in (1, 2)))
        outward = np.einsum("fi,fi->f", face, shape.normals[shape.faces].sum(axis=1))
        assert (outward > 0.0).all() and np.isfinite(middle).all()
    hull = hull_of(*ball)
    top = hull.vertices[np.abs(hull.vertices["v"] - 0.5) < 0.2]
    length_2 = (top["tangent"] ** 2).sum(axis=1)
    np.testing.assert_allclose(top["curvature"][:, 0], length_2 / 0.5, rtol=0.03)
    np.testing.assert_allclose(top["curvature"][:, 2], (np.pi * 0.5) ** 2 / 0.5, rtol=0.01)
    np.testing.assert_allclose(np.sqrt(length_2), np.pi * np.cos(np.pi * (top["v"] - 0.5)), rtol=0.015)
    assert hull.clip_low[0] < -1e6 and hull.clip_high[1] > 1e6


def test_a_mesh_with_sharp_edges_has_walls_along_them() -> None:
    box = pl.Mesh.box(1.0)
    assert len(open_borders(box.vertices, box.faces, box.normals)) == 24  # type: ignore[arg-type]
    hull = hull_of(box.vertices, box.faces, box.normals, box.uvs)  # type: ignore[arg-type]
    assert hull.clip_low == (0.0, 0.0) and hull.clip_high == (1.0, 1.0)
    np.testing.assert_allclose(hull.tile_m, 1.0)


def test_depth_is_that_of_the_relief_and_other_things_cut_it(renderer: pl.Renderer) -> None:
    heights = np.where(np.arange(64)[None, :] < 32, 0.0, 0.2) * np.ones((64, 1))
    item = pl.ReliefSurface.plane(1.0, pl.ReliefLayer(heights), tiling=False)
    slab = pl.Mesh.plane((2.0, 0.3), position=(0, 0.1, 0), base_color=(0, 0, 0))
    frame = renderer.render(pl.Scene(from_above(), SKY, objects=[item, slab]), size=(48, 48))
    left, right = frame.depth[:, 6:20], frame.depth[:, 27:42]
    np.testing.assert_allclose(left[8:14], 2.0, atol=1e-5)
    np.testing.assert_allclose(right[8:14], 1.8, atol=1e-5)
    np.testing.assert_allclose(left[22:26], 1.9, atol=1e-5)  # the slab is above the low half
    np.testing.assert_allclose(right[22:26], 1.8, atol=1e-5)  # and below the high one


def test_a_plane_ends_where_its_mesh_does_unless_it_is_extended(renderer: pl.Renderer) -> None:
    solid = pl.ReliefLayer(np.where(np.arange(16) == 2, 0.0, -0.3) * np.ones((4, 1)))  # a ridge, far below it a floor
    camera = pl.Camera(position=(0, 2, 2), orthographic_height_m=2.0, far_m=9.0)
    cut, on = (
        renderer.render(pl.Scene(camera, SKY, objects=[pl.ReliefSurface.plane(1.0, solid, edges=edges)]), size=(40, 40))
        for edges in ("clip", "extend")
    )
    seen = np.isfinite(cut.depth)
    points = _points(cut.depth, camera, (40, 40))[seen]
    assert (np.abs(points[:, [0, 2]]) < 0.5 + 1e-4).all() and (points[:, 1] > -0.3 - 1e-3).all()
    assert 50 < seen.sum() < np.isfinite(on.depth).sum()


def test_a_raised_sphere_has_the_silhouette_and_the_depth_of_a_larger_one(renderer: pl.Renderer) -> None:
    item = pl.ReliefSurface.sphere(0.5, pl.ReliefLayer(np.full((4, 4), 0.03)), segments=128)
    # a ridge on the far side makes the hull larger than the surface
    ridge = np.where(np.abs(np.arange(64) - 32) < 2, 0.06, 0.03) * np.ones((8, 1))
    tall = item.replace(solid=pl.ReliefLayer(ridge), tiles=(1, 1))
    camera = pl.Camera(position=(0, 0, 3), orthographic_height_m=1.3, far_m=9.0)
    x = (np.arange(64) + 0.5) / 64 * 1.3 - 0.65
    radius_2 = x[None, :] ** 2 + x[:, None] ** 2
    for thing in (item, tall):
        depth = renderer.render(pl.Scene(camera, SKY, objects=[thing]), size=(64, 64)).depth
        outline = np.isfinite(depth)
        assert outline[radius_2 < (0.53 - 0.015) ** 2].all()
        assert not outline[radius_2 > (0.53 + 0.015) ** 2].any()
        inner = radius_2 < 0.4**2
        np.testing.assert_allclose(depth[inner], (3.0 - np.sqrt(np.maximum(0.53**2 - radius_2, 0)))[inner], atol=2e-3)


def test_flat_and_offset_mapping_stay_on_the_polygon(renderer: pl.Renderer) -> None:
    rows = np.linspace(0.0, 1.0, 32)[None, :] * np.ones((4, 1))
    solid = pl.ReliefLayer(0.1 * rows, colors=np.repeat(rows[..., None], 3, axis=2), specular=0.0)
    camera = pl.Camera(position=(2, 2, 0), orthographic_height_m=0.5, far_m=9.0)
    found = {}
    for technique in ("color", "normal", "offset", "relief"):
        item = pl.ReliefSurface.plane(1.0, solid, technique=technique, tiling=False)
        found[technique] = renderer.render(pl.Scene(camera, SKY, objects=[item]), size=(16, 16))
    flat = found["color"].depth
    np.testing.assert_allclose(found["normal"].depth, flat)
    np.testing.assert_allclose(found["offset"].depth, flat)
    assert (found["relief"].depth < flat - 0.01).all()
    # the view comes from +x: what is raised hides what lies before it, so colours come from further along +x
    middle = {name: frame.radiance[8, 8, 0] for name, frame in found.items()}
    assert middle["color"] + 0.01 < middle["offset"] and middle["color"] + 0.01 < middle["relief"]
    # offset 0.05 x sin 45 against the true 0.05 / (1 - 0.1 tan 45), in lengths of the map
    assert middle["offset"] - middle["color"] == pytest.approx(0.05 * np.sqrt(0.5), abs=0.01)
    assert middle["relief"] - middle["color"] == pytest.approx(0.05 / 0.9, abs=0.01)


def test_moving_light_camera_and_index_makes_nothing_anew(device: pl.Device, monkeypatch: pytest.MonkeyPatch) -> None:
    renderer = pl.Renderer(device)
    solid, cover = pl.ReliefLayer(0.01 * np.eye(8)), pl.ReliefLayer(0.012)
    item = pl.ReliefSurface.plane(1.0, solid, cover, medium=1.4)
    lamp = pl.DirectionalLight(direction=(0, -1, 0.2))
    scene = pl.Scene(from_above(), SKY, [lamp], [item])
    first = renderer.render(scene, size=(16, 16))
    from pellucid.gpu import kernel

    made: list[str] = []
    compile_pipeline = kernel._Pipeline.create

    def counted(self: Any, *rest: Any, **options: Any) -> Any:
        made.append(self.label)
        return compile_pipeline(self, *rest, **options)

    uploads: list[int] = []
    write = pl.Device.write_texture

    def watched(self: Any, texture: Any, array: np.ndarray, *rest: Any, **options: Any) -> None:
        uploads.append(array.nbytes)
        write(self, texture, array, *rest, **options)

    monkeypatch.setattr(kernel._Pipeline, "create", counted)
    monkeypatch.setattr(pl.Device, "write_texture", watched)
    for change in (
        {"camera": pl.Camera(position=(0.3, 1, 0.2))},
        {"lights": [lamp.replace(direction=(0.5, -1, 0))]},
        {"objects": [item.replace(medium=1.6)]},
        {"objects": [item.replace(position=(0.1, 0.05, 0), absorption=(9.0, 0, 0), scattering=2.0)]},
    ):
        frame = renderer.render(scene.replace(**change), size=(16, 16))
        assert np.abs(frame.radiance - first.radiance).max() > 1e-4
    assert made == [] and uploads == []


def test_several_surfaces_hide_one_another(renderer: pl.Renderer) -> None:
    low = pl.ReliefSurface.plane(1.0, pl.ReliefLayer(0.0, colors=(0.9, 0.1, 0.1)))
    high = pl.ReliefSurface.plane(0.5, pl.ReliefLayer(0.1, colors=(0.1, 0.1, 0.9)))
    for objects in ([low, high], [high, low]):
        frame = renderer.render(pl.Scene(from_above(), SKY, objects=objects), size=(24, 24))
        assert frame.radiance[12, 12, 2] > frame.radiance[12, 12, 0]
        assert frame.radiance[12, 4, 0] > frame.radiance[12, 4, 2]
        np.testing.assert_allclose(frame.depth[12, [12, 4]], [1.9, 2.0], atol=1e-5)


def _points(depth: np.ndarray, camera: pl.Camera, size: tuple[int, int]) -> np.ndarray:
    origins, directions = camera.pixel_rays(size)
    return np.asarray(origins + np.where(np.isfinite(depth), depth, 0.0)[..., None] * directions)


def test_heights_that_move_are_drawn_as_they_are_at_a_time(renderer: pl.Renderer) -> None:
    class Tide:
        shape, tile_m, limits_m = (4, 4), (1.0, 1.0), (0.0, 0.2)

        def advance(self, time_s: float) -> np.ndarray:
            return np.full((4, 4), 0.1 * time_s, np.float32)

    for layer in (pl.ReliefLayer(Tide(), base_m=0.05), pl.ReliefLayer(0.0)):
        cover = None if layer.is_dynamic else pl.ReliefLayer(Tide(), base_m=0.05)
        item = pl.ReliefSurface.plane(1.0, layer, cover)
        for time_s in (1.0, 0.5, 2.0):
            frame = renderer.render(pl.Scene(from_above(), SKY, objects=[item]), size=(8, 8), time=time_s)
            np.testing.assert_allclose(frame.depth[4, 4], 1.95 - 0.1 * time_s, atol=1e-5)


def test_without_silhouettes_a_sphere_keeps_the_outline_of_its_hull(renderer: pl.Renderer) -> None:
    low = np.where(np.abs(np.arange(64) - 32) < 2, 0.06, -0.05) * np.ones((8, 1))
    item = pl.ReliefSurface.sphere(0.5, pl.ReliefLayer(low), tiles=(1, 1))
    camera = pl.Camera(position=(0, 0, 3), orthographic_height_m=1.3, far_m=9.0)
    covered = [
        np.isfinite(renderer.render(pl.Scene(camera, SKY, objects=[o]), size=(48, 48)).depth).sum()
        for o in (item, item.replace(quality=pl.ReliefQuality(silhouettes=False)))
    ]
    pixel = (1.3 / 48) ** 2
    assert covered[0] * pixel == pytest.approx(np.pi * 0.45**2, rel=0.03)
    assert covered[1] * pixel == pytest.approx(np.pi * 0.56**2, rel=0.03)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (0.5, 0.3, 0.0), (0.0, 0.4, 1.4), (5.0, 0.0, 0.0)])
def test_pixels_beside_a_surface_are_left_out_and_no_others(
    renderer: pl.Renderer, monkeypatch: pytest.MonkeyPatch, place: tuple[float, float, float]
) -> None:
    layer = pl.ReliefLayer(0.05 * np.random.default_rng(3).random((16, 16)))
    item = pl.ReliefSurface.sphere(0.25, layer, position=place)
    for camera in (pl.Camera(position=(0, 0.4, 1.5)), pl.Camera(position=(0, 0.4, 1.5), orthographic_height_m=1.0)):
        scene = pl.Scene(camera, SKY, objects=[item])
        frame = renderer.render(scene, size=(40, 30))
        with monkeypatch.context() as full:
            full.setattr("pellucid.techniques.relief.passes.rectangle", lambda *given: (0, 0, 40, 30))
            whole = renderer.render(scene, size=(40, 30))
        np.testing.assert_array_equal(frame.radiance, whole.radiance)
        np.testing.assert_array_equal(frame.depth, whole.depth)
