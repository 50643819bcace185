"""Meshes: the same ball through every format, and files that cannot be used."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError
from pellucid.io import meshes
from pellucid.io.meshes import read_mesh


@pytest.fixture(scope="module")
def balls(tmp_path_factory: pytest.TempPathFactory) -> Path:
    import trimesh

    folder = tmp_path_factory.mktemp("balls")
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    for suffix in ("obj", "ply", "stl", "glb"):
        ball.export(folder / f"ball.{suffix}")
    files = trimesh.exchange.gltf.export_gltf(trimesh.Scene(ball))
    for name, content in files.items():
        (folder / ("ball.gltf" if name == "model.gltf" else name)).write_bytes(content)
    return folder


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "glb", "gltf"])
def test_a_ball_is_closed_and_has_its_volume_in_every_format(balls: Path, suffix: str) -> None:
    mesh = read_mesh(balls / f"ball.{suffix}")
    assert mesh.faces.shape == (320, 3) and mesh.vertices.shape == (162, 3) and mesh.name == "ball"
    edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    assert 0.95 < volume / (4.0 / 3.0 * np.pi * 0.125) < 1.0  # outward faces, inscribed in the sphere


@pytest.mark.parametrize("suffix", ["ply", "stl", "glb", "gltf", "obj"])
@pytest.mark.parametrize("keep", [0, 10, 0.5])
def test_a_cut_mesh_is_an_error_that_names_it(balls: Path, tmp_path: Path, suffix: str, keep: float) -> None:
    content = (balls / f"ball.{suffix}").read_bytes()
    cut = tmp_path / f"cut.{suffix}"
    cut.write_bytes(content[: int(keep if keep >= 1 or keep == 0 else keep * len(content))])
    with pytest.raises(AssetError, match=r"empty|truncated|no faces") as caught:
        read_mesh(cut)
    assert caught.value.path == str(cut) and caught.value.remedy


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.obj", "hello, this is a letter\n", "no faces|not a OBJ|not an"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"),
        ("a.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("a.obj", "v 0 0 0\nv 1 0 inf\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("a.obj", "v 2 2 2\nv 2 2 2\nv 2 2 2\nf 1 2 3\n", "no extent"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "truncated|does not hold"),
        ("a.ply", "nothing of the kind", "does not begin with 'ply'"),
        ("a.stl", "nothing of the kind", "truncated"),
        ("a.glb", "nothing of the kind", "truncated or not"),
        ("a.gltf", "{]", "truncated or not"),
        ("a.txt", "x", "suffix"),
    ],
)
def test_what_is_not_a_mesh_says_why(tmp_path: Path, name: str, content: str, words: str) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(AssetError, match=words) as caught:
        read_mesh(tmp_path / name)
    assert caught.value.path.endswith(name)


def test_an_obj_with_umlauts_in_latin_1_is_read_with_its_colours(tmp_path: Path) -> None:
    (tmp_path / "größe.mtl").write_bytes("# für Glas\nnewmtl grün\nKd 0.1 0.6 0.2\n".encode("latin-1"))
    text = "# Würfel\nmtllib größe.mtl\nusemtl grün\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
    (tmp_path / "a.obj").write_bytes(text.encode("latin-1"))
    mesh = read_mesh(tmp_path / "a.obj")
    assert mesh.faces.shape == (1, 3) and mesh.base_color == pytest.approx((0.1, 0.6, 0.2))


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
@pytest.mark.parametrize("suffix", ["ply", "stl"])
def test_remarks_in_latin_1_do_not_stop_other_formats(tmp_path: Path, suffix: str, encoding: str) -> None:
    texts = {
        "ply": "ply\nformat ascii 1.0\ncomment Größe\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "stl": "solid Größe\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid Größe\n",
    }
    (tmp_path / f"a.{suffix}").write_bytes(texts[suffix].encode(encoding))
    assert read_mesh(tmp_path / f"a.{suffix}").faces.shape == (1, 3)


@pytest.mark.parametrize(
    ("name", "words"), [("a.obj", "no text"), ("a.glb", "begin with 'glTF'"), ("a.gltf", "begin with '{'")]
)
def test_bytes_without_meaning_are_told_apart_from_a_cut_file(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / name).write_bytes(np.random.default_rng(0).bytes(4000))
    with pytest.raises(AssetError, match=words):
        read_mesh(tmp_path / name)


def test_an_absurd_number_of_faces_is_refused_by_the_header(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ply = tmp_path / "a.ply"
    ply.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\nelement face 30000000\nend_header\n")
    with pytest.raises(AssetError, match="30,000,000 faces"):
        read_mesh(ply)
    monkeypatch.setattr(meshes, "MAX_FACES", 1)
    stl = tmp_path / "a.stl"
    stl.write_bytes(b"\0" * 80 + struct.pack("<I", 2) + b"\0" * 100)
    with pytest.raises(AssetError, match="2 faces"):
        read_mesh(stl)


def test_normals_and_uvs_come_from_the_file_or_not_at_all(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.25 1\nvn 0 0.6 0.8\nf 1/1/1 2/2/1 3/3/1\n"
    )
    (tmp_path / "b.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    full, bare = read_mesh(tmp_path / "a.obj"), read_mesh(tmp_path / "b.obj")
    assert full.normals is not None and full.uvs is not None
    assert full.normals == pytest.approx(np.tile([0.0, 0.6, 0.8], (3, 1)))
    assert full.uvs[full.faces[0]] == pytest.approx(np.array([[0, 0], [1, 0], [0.25, 1]]))
    assert bare.normals is None and bare.uvs is None and bare.base_color is None


def test_normals_of_a_ply_are_kept(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\n"
        + "".join(f"property float {p}\n" for p in ("x", "y", "z", "nx", "ny", "nz"))
        + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        + "0 0 0 0 0.6 0.8\n1 0 0 0 0.6 0.8\n0 1 0 0 0.6 0.8\n3 0 1 2\n"
    )
    normals = read_mesh(tmp_path / "a.ply").normals
    assert normals == pytest.approx(np.tile([0.0, 0.6, 0.8], (3, 1)))


def test_several_geometries_are_placed_and_merged(tmp_path: Path) -> None:
    import trimesh

    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=trimesh.transformations.translation_matrix((5, 0, 0)))
    scene.add_geometry(trimesh.creation.box((1, 1, 1)))
    scene.export(tmp_path / "two.glb")
    mesh = read_mesh(tmp_path / "two.glb")
    assert len(mesh.faces) == 24
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx([6, 1, 1])


def test_a_material_gives_the_base_colour(tmp_path: Path) -> None:
    (tmp_path / "red.mtl").write_text("newmtl red\nKd 0.5 0.25 0.125\n")
    (tmp_path / "a.obj").write_text(
        "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n"
    )
    assert read_mesh(tmp_path / "a.obj").base_color == pytest.approx((0.5, 0.25, 0.125))


def test_the_bunny_is_read(shared_data: Path) -> None:
    bunny = read_mesh(shared_data / "bunny.ply")
    assert len(bunny.faces) > 1000 and bunny.name == "bunny"


def test_a_map_is_linear_with_its_top_row_first(tmp_path: Path) -> None:
    from PIL import Image

    Image.fromarray(np.array([[[188, 0, 0]], [[0, 188, 0]]], np.uint8)).save(tmp_path / "map.png")
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd map.png\n")
    (tmp_path / "a.obj").write_text(
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"
    )
    base_color_map = read_mesh(tmp_path / "a.obj").base_color_map
    assert base_color_map is not None
    assert base_color_map[0, 0] == pytest.approx([0.5029, 0.0, 0.0], abs=2e-4)
    assert base_color_map[1, 0] == pytest.approx([0.0, 0.5029, 0.0], abs=2e-4)


def test_a_mirrored_placement_keeps_faces_outward(tmp_path: Path) -> None:
    import trimesh

    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=np.diag([-1.0, 1.0, 1.0, 1.0]))
    scene.export(tmp_path / "mirrored.glb")
    mesh = read_mesh(tmp_path / "mirrored.glb")
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(1.0)
