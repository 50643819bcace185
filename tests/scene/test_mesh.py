"""Triangles: closed shapes, outward faces, true normals, and maps the right way up."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError, SceneError
from pellucid.scene import Mesh
from pellucid.scene.shapes import face_normals

TRIANGLE = (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))


def enclosed_volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def normals_of(mesh: Mesh) -> np.ndarray:
    assert mesh.normals is not None
    return mesh.normals


def test_a_box_has_its_volume_sharp_edges_and_whole_maps() -> None:
    box = Mesh.box((1.0, 2.0, 3.0))
    assert enclosed_volume(box) == pytest.approx(6.0)
    assert np.ptp(box.vertices, axis=0) == pytest.approx([1, 2, 3])
    face = face_normals(box.vertices, box.faces)
    assert normals_of(box)[box.faces] == pytest.approx(np.repeat(face[:, None], 3, axis=1))
    assert box.uvs is not None and {tuple(uv) for uv in box.uvs} == {(0, 0), (1, 0), (1, 1), (0, 1)}


def test_maps_on_the_upright_sides_of_a_box_stand_upright() -> None:
    box = Mesh.box()
    assert box.uvs is not None
    for side in range(6):
        corners, uvs = box.vertices[4 * side : 4 * side + 4], box.uvs[4 * side : 4 * side + 4]
        along_u, along_v = corners[1] - corners[0], corners[3] - corners[0]
        assert uvs[1] - uvs[0] == pytest.approx([1, 0]) and uvs[3] - uvs[0] == pytest.approx([0, 1])
        assert np.cross(along_u, along_v) == pytest.approx(normals_of(box)[4 * side])  # seen unmirrored
        if normals_of(box)[4 * side, 1] == 0:
            assert along_v == pytest.approx([0, 1, 0])


def test_a_sphere_is_closed_round_and_smooth() -> None:
    sphere = Mesh.sphere(2.0, segments=96)
    assert np.linalg.norm(sphere.vertices, axis=1) == pytest.approx(np.full(len(sphere.vertices), 2.0))
    assert normals_of(sphere) == pytest.approx(sphere.vertices / 2.0, abs=1e-6)
    assert enclosed_volume(sphere) == pytest.approx(4 / 3 * np.pi * 8.0, rel=3e-3)
    assert (np.linalg.norm(face_normals(sphere.vertices, sphere.faces), axis=1) > 0.5).all()  # none without area
    _, place = np.unique(sphere.vertices + 0.0, axis=0, return_inverse=True)
    edges = np.sort(place.reshape(-1)[sphere.faces][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_worked_out_normals_match_the_sphere_and_hide_its_seam() -> None:
    sphere = Mesh.sphere(1.0, segments=64)
    again = Mesh(sphere.vertices, sphere.faces)
    cosine = np.einsum("ij,ij->i", normals_of(again), sphere.vertices)
    assert cosine.min() > 1.0 - 1e-5


def test_angle_weights_make_a_corner_of_a_cube_point_along_its_diagonal() -> None:
    box = Mesh.box()  # two triangles on some sides of a corner, one on others: only angles weigh them fairly
    smooth = Mesh(box.vertices, box.faces)
    assert normals_of(smooth) == pytest.approx(np.sign(box.vertices) / np.sqrt(3.0), abs=1e-6)


def test_flat_shading_gives_each_face_its_normal() -> None:
    flat = Mesh.sphere(1.0, segments=16, shading="flat")
    assert len(flat.vertices) == 3 * len(flat.faces)
    face = face_normals(flat.vertices, flat.faces)
    assert normals_of(flat)[flat.faces] == pytest.approx(np.repeat(face[:, None], 3, axis=1), abs=1e-6)
    assert flat.uvs is not None and len(flat.uvs) == len(flat.vertices)


def test_the_plane_faces_up_and_its_maps_top_lies_far() -> None:
    plane = Mesh.plane((4.0, 2.0))
    assert face_normals(plane.vertices, plane.faces) == pytest.approx(np.array([[0, 1, 0], [0, 1, 0]]))
    assert plane.uvs is not None
    far_left = plane.vertices[(plane.uvs == [0, 1]).all(axis=1)][0]
    assert far_left == pytest.approx([-2, 0, -1])


def test_a_checkerboard_alternates_with_enough_texels() -> None:
    board = Mesh.checkerboard(2.0, squares=4, colors=((1, 1, 1), (0, 0, 0))).base_color_map
    assert board is not None and board.shape[0] >= 512
    centres = board[board.shape[0] // 8 :: board.shape[0] // 4, board.shape[1] // 8 :: board.shape[1] // 4, 0]
    assert np.array_equal(centres, 1.0 - np.add.outer(range(4), range(4)) % 2)


def test_placement_scales_then_turns_about_fixed_axes_then_moves() -> None:
    mesh = Mesh.plane(position=(10, 0, 0), rotation=(90, 90, 0), scale=2.0)
    # +Y after a quarter turn about x points along +Z, then about y along +X
    assert mesh.object_to_world() @ [0, 1, 0, 1] == pytest.approx([12, 0, 0, 1])
    assert mesh.object_to_world() @ [0, 0, 0, 1] == pytest.approx([10, 0, 0, 1])
    assert Mesh.plane(rotation=(0, 0, 90)).object_to_world() @ [1, 0, 0, 1] == pytest.approx([0, 1, 0, 1])


def test_meshes_are_values() -> None:
    vertices = TRIANGLE[0].astype(np.float32)
    mesh = Mesh(vertices, TRIANGLE[1])
    vertices[0] = 99.0
    assert mesh.vertices[0].tolist() == [0, 0, 0] and not mesh.vertices.flags.writeable
    moved = mesh.replace(position=(1, 0, 0))
    assert moved.vertices is mesh.vertices and moved.normals is mesh.normals and moved.faces is mesh.faces


def test_a_file_brings_its_colour_and_the_caller_wins(tmp_path: Path) -> None:
    (tmp_path / "red.mtl").write_text("newmtl red\nKd 0.5 0.25 0.125\n")
    (tmp_path / "a.obj").write_text(
        "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n"
    )
    assert Mesh.load(tmp_path / "a.obj").base_color == pytest.approx((0.5, 0.25, 0.125))
    assert Mesh.load(tmp_path / "a.obj", base_color=(0, 0, 1), roughness=0.1).base_color == (0, 0, 1)
    with pytest.raises(AssetError, match="does not exist"):
        Mesh.load(tmp_path / "b.obj")


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"vertices": np.full((3, 3), np.nan)}, "mesh.vertices"),
        ({"vertices": np.zeros((0, 3))}, "mesh.vertices"),
        ({"vertices": np.zeros((3, 2))}, "mesh.vertices"),
        ({"vertices": "bunny"}, "mesh.vertices"),
        ({"faces": [[0, 1, 3]]}, "mesh.faces"),
        ({"faces": [[0, 1, -1]]}, "mesh.faces"),
        ({"faces": [[0.0, 1.0, 2.0]]}, "mesh.faces"),
        ({"normals": np.zeros((3, 3))}, "mesh.normals"),
        ({"normals": np.zeros((2, 3))}, "mesh.normals"),
        ({"uvs": np.zeros((2, 2))}, "mesh.uvs"),
        ({"base_color": (2, 0, 0)}, "mesh.base_color[0]"),
        ({"base_color_map": np.zeros((2, 2, 3))}, "mesh.uvs"),
        ({"base_color_map": np.zeros((2, 2))}, "mesh.base_color_map"),
        ({"base_color_map": -np.ones((2, 2, 3)), "uvs": np.zeros((3, 2))}, "mesh.base_color_map"),
        ({"roughness": 1.5}, "mesh.roughness"),
        ({"specular": -0.1}, "mesh.specular"),
        ({"emission": (0, -1, 0)}, "mesh.emission[1]"),
        ({"scale": 0}, "mesh.scale"),
        ({"scale": (1, 1, 2)}, "mesh.scale"),
        ({"rotation": (0, 0, float("nan"))}, "mesh.rotation[2]"),
        ({"double_sided": 1}, "mesh.double_sided"),
        ({"shading": "gouraud"}, "mesh.shading"),
    ],
)
def test_each_fault_names_its_field(changes: dict, field: str) -> None:
    given = {"vertices": TRIANGLE[0], "faces": TRIANGLE[1], **changes}
    with pytest.raises(SceneError) as caught:
        Mesh(**given)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Mesh.plane(0), "mesh.size_m"),
        (lambda: Mesh.plane((1, 2, 3)), "mesh.size_m"),
        (lambda: Mesh.box((1, 2)), "mesh.size_m"),
        (lambda: Mesh.sphere(-1), "mesh.radius_m"),
        (lambda: Mesh.sphere(1, segments=2), "mesh.segments"),
        (lambda: Mesh.checkerboard(squares=0), "mesh.squares"),
        (lambda: Mesh.checkerboard(colors=((1, 1, 1),)), "mesh.colors"),
    ],
)
def test_primitives_check_their_sizes(make, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        make()
    assert caught.value.field == field
