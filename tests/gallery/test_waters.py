"""Scenes with natural water: what stands in them, and what light does there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pellucid.gallery import lake, waters
from pellucid.gpu import Device
from pellucid.renderer import Renderer
from pellucid.scene import Camera, Mesh, load_scene, save_scene


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    return Renderer(device)


def test_no_sun_comes_through_the_wall_of_a_pool(renderer: Renderer) -> None:
    """The sun, 52 degrees high, lights what lies beyond 1.5 m tan(27.5 deg) = 0.78 m from the wall towards it."""
    above = Camera((0.0, 30.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), orthographic_height_m=4.0)
    scene = waters.pool_scene(above, sun=(52.0, 0.0), waves=0)
    scene = scene.replace(objects=[thing for thing in scene.objects if thing not in scene.objects[2:4]])
    light = renderer.render(scene, (48, 32), samples=1).radiance.mean(axis=(1, 2))
    z = (np.arange(32) + 0.5) / 8.0 - 2.0  # the sun stands over -z
    lit, dark = light[z > -1.0].mean(), light[(z > -1.8) & (z < -1.4)].mean()
    assert dark < 0.45 * lit


def test_the_lake_is_about_as_large_as_that_of_the_thesis_and_its_files_hold_it(tmp_path: Path) -> None:
    meshes = lake.lake_meshes(tmp_path)
    faces, vertices = (sum(len(getattr(mesh, name)) for mesh in meshes) for name in ("faces", "vertices"))
    # 131 437 vertices and 85 409 faces [mihalik2008]; ours share more vertices.
    assert 80_000 < faces < 130_000 and 50_000 < vertices < 140_000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["lake.mtl", "lake.obj", "lake_ground.png"]
    ground = meshes[0]
    assert ground.base_color_map is not None and ground.base_color_map.shape == (1024, 1024, 3)
    assert len({mesh.base_color for mesh in meshes}) == 5


def test_a_smaller_lake_has_the_same_trees(tmp_path: Path) -> None:
    few = lake.lake_meshes(tmp_path, corners=33, texels=32, trees=10)
    assert len(few[0].faces) == 2 * 32**2 and len(few) == 5
    # Trees stand on the ground, not in the water and not in the air.
    trunks = few[2]
    assert isinstance(trunks, Mesh) and trunks.vertices[:, 1].min() > 0.5


def test_a_pool_in_a_file_moves(renderer: Renderer, tmp_path: Path) -> None:
    save_scene(waters.pool_scene(), tmp_path / "pool.json")
    scene = load_scene(tmp_path / "pool.json")
    first, again, later = (renderer.render(scene, (32, 24), time=t).radiance for t in (1.0, 1.0, 1.5))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - later).mean() > 1e-3


def test_paving_repeats_the_picture_every_tile() -> None:
    image = np.zeros((4, 4, 3), np.float32)
    wall = waters.paved([[(0, 0, 1), (2, 0, 1), (0, 3, 1)]], 0.5, image)
    assert wall.uvs is not None and wall.uvs.max(axis=0).tolist() == [4.0, 6.0]
    assert wall.normals is not None
    np.testing.assert_allclose(wall.normals, np.tile((0.0, 0.0, 1.0), (4, 1)), atol=1e-6)
