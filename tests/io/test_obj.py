"""OBJ with materials: several in one file, what is missing told, and written so that it comes back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError, AssetWarning
from pellucid.io.meshes import MeshData, read_mesh, read_meshes
from pellucid.io.obj import write_obj
from pellucid.scene import Mesh, Scene, load_scene, save_scene
from pellucid.scene.camera import Camera

GEOMETRY = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
TWO = GEOMETRY + "usemtl red\nf 1/1 2/2 3/3\nusemtl blue\nf 1/1 2/2 4/3\nusemtl red\nf 2/1 3/2 4/3\n"


def square(name: str, x: float, map_: np.ndarray | None = None) -> MeshData:
    vertices = np.array([[x, 0, 0], [x, 0, 1], [x + 1, 0, 1], [x + 1, 0, 0]], float)
    uvs = np.array([[0, 1], [0, 0], [1, 0], [1, 1]], np.float32)
    normals = np.tile(np.float32([0, 1, 0]), (4, 1))
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return MeshData(vertices, faces, normals, uvs, (0.25, 0.5, 0.125), map_, name)


def test_each_material_is_a_mesh_of_its_own_in_the_order_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "a.mtl").write_text("newmtl blue\nKd 0 0 1\nnewmtl red\nKd 1 0 0\n")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\n" + TWO)
    red, blue = read_meshes(tmp_path / "a.obj")
    assert (red.name, red.base_color, len(red.faces)) == ("red", (1.0, 0.0, 0.0), 2)
    assert (blue.name, blue.base_color, len(blue.faces)) == ("blue", (0.0, 0.0, 1.0), 1)
    assert red.missing == blue.missing == ()
    merged = read_mesh(tmp_path / "a.obj")
    assert len(merged.faces) == 3 and merged.base_color == pytest.approx((2 / 3, 0.0, 1 / 3))


def test_meshes_of_several_materials_come_with_their_maps(tmp_path: Path) -> None:
    board = np.zeros((2, 2, 3), np.float32)
    board[0, 0] = 1.0
    write_obj(tmp_path / "a.obj", [square("board", 0.0, board), square("plain", 2.0)])
    first, second = Mesh.load_all(tmp_path / "a.obj", roughness=0.25)
    assert first.base_color_map is not None and second.base_color_map is None
    np.testing.assert_allclose(first.base_color_map, board, atol=1e-6)
    assert first.base_color == pytest.approx((0.25, 0.5, 0.125)) and first.roughness == second.roughness == 0.25
    assert second.vertices[:, 0].min() == 2.0


def test_what_is_written_comes_back(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    vertices = rng.normal(0.0, 30.0, (200, 3))
    faces = rng.permutation(198).reshape(-1, 3).astype(np.int32)
    normals = rng.normal(size=(200, 3)).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    uvs = rng.random((200, 2)).astype(np.float32)
    given = [
        MeshData(vertices, faces, normals, uvs, (0.5, 0.5, 0.5), None, "all"),
        MeshData(vertices, faces, normals, None, (0.5, 0.5, 0.5), None, "no-uvs"),
        MeshData(vertices, faces, None, None, None, None, "bare"),
    ]
    write_obj(tmp_path / "a.obj", given)
    for before, after in zip(given, read_meshes(tmp_path / "a.obj"), strict=True):
        assert before.name == after.name
        np.testing.assert_allclose(after.vertices[after.faces], before.vertices[before.faces], rtol=1e-6, atol=1e-6)
        if before.normals is not None:
            assert after.normals is not None
            np.testing.assert_allclose(after.normals[after.faces], before.normals[before.faces], atol=1e-6)


@pytest.mark.parametrize(
    ("materials", "words"),
    [
        (None, "'a.mtl' is not there"),
        ("newmtl red\nmap_Kd none.png\nnewmtl blue\nKd 0 0 1\n", "'none.png' is not there"),
        ("newmtl red\nmap_Kd bad.png\nnewmtl blue\nKd 0 0 1\n", "'bad.png' is no picture"),
        ("newmtl red\nKd 1 0 0\n", "material 'blue' is in none"),
    ],
)
def test_what_is_missing_is_told_and_grey_stands_for_it(tmp_path: Path, materials: str | None, words: str) -> None:
    if materials:
        (tmp_path / "a.mtl").write_text(materials)
    (tmp_path / "bad.png").write_text("no picture")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\n" + TWO)
    with pytest.warns(AssetWarning, match=words) as caught:
        meshes = Mesh.load_all(tmp_path / "a.obj")
    assert "a.obj" in str(caught[0].message) and len(caught) == 1
    assert (0.8, 0.8, 0.8) in [mesh.base_color for mesh in meshes]
    assert all(mesh.base_color_map is None for mesh in meshes)


def test_a_mesh_without_materials_is_grey_and_says_nothing(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    (tmp_path / "a.obj").write_text(GEOMETRY + "f 1 2 3\nf 1 2 4\n")
    (mesh,) = Mesh.load_all(tmp_path / "a.obj")
    assert mesh.base_color == (0.8, 0.8, 0.8) and len(mesh.faces) == 2
    assert not [w for w in recwarn if issubclass(w.category, AssetWarning)]


def test_names_of_pictures_as_windows_writes_them_and_with_options(tmp_path: Path) -> None:
    from PIL import Image

    (tmp_path / "maps").mkdir()
    Image.fromarray(np.full((2, 2, 3), 255, np.uint8)).save(tmp_path / "maps" / "white.png")
    for name in ("maps\\white.png", "-s 2 2 1 maps/white.png"):
        (tmp_path / "a.mtl").write_text(f"newmtl red\nmap_Kd {name}\nnewmtl blue\nKd 0 0 1\n")
        (tmp_path / "a.obj").write_text("mtllib a.mtl\n" + TWO)
        red, _ = Mesh.load_all(tmp_path / "a.obj")
        assert red.base_color_map is not None and red.base_color == (1.0, 1.0, 1.0)


def test_a_scene_file_names_the_part(tmp_path: Path) -> None:
    write_obj(tmp_path / "a.obj", [square("first", 0.0), square("second", 2.0)])
    meshes = Mesh.load_all(tmp_path / "a.obj")
    save_scene(Scene(Camera((0, 1, 5), (0, 0, 0)), objects=meshes), tmp_path / "scene.json")
    text = (tmp_path / "scene.json").read_text()
    assert '"part"' in text and not list(tmp_path.glob("*.npz"))
    again = load_scene(tmp_path / "scene.json")
    for before, after in zip(meshes, again.objects, strict=True):
        assert isinstance(after, Mesh)
        np.testing.assert_array_equal(before.vertices, after.vertices)


@pytest.mark.parametrize(
    ("name", "parts", "words"),
    [
        ("a.ply", ["x"], "suffix"),
        ("a.obj", [], "names that differ"),
        ("a.obj", ["x", "x"], "names that differ"),
        ("a.obj", ["a b"], "'a b'"),
        ("none/a.obj", ["x"], "does not exist"),
    ],
)
def test_what_cannot_be_written_says_why(tmp_path: Path, name: str, parts: list[str], words: str) -> None:
    with pytest.raises(AssetError, match=words):
        write_obj(tmp_path / name, [square(part, 0.0) for part in parts])
