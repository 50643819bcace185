"""`pellucid render`: pictures that are right, and bad input that is told at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cli.cubes import cube_text

QUICK = ("--size", "48x32", "--samples", "1", "--resolution", "16")


def pixels(path: Path) -> np.ndarray:
    from pellucid.io.images import read_image

    return read_image(path)


def render_cube(pellucid, folder: Path, text: str) -> np.ndarray:
    mesh = folder / f"mesh{len(list(folder.iterdir()))}.obj"
    mesh.write_text(text)
    out = mesh.with_suffix(".exr")
    said = pellucid("render", mesh, "-o", out, *QUICK)
    assert said.code == 0, said.err
    return pixels(out)


def test_a_mesh_becomes_a_picture_and_the_output_says_what_and_how_long(pellucid, cube, tmp_path):
    out = tmp_path / "cube.png"
    said = pellucid("render", cube, "-o", out, *QUICK, "--medium", "diamond")
    assert said.code == 0, said.err
    image = pixels(out)
    assert image.shape == (32, 48, 3) and image.std() > 0.02
    for words in ("cube.png", "diamond", "12 triangles", "48x32", "drawn in"):
        assert words in said.out


def test_millimetres_are_asked_about_where_they_matter(pellucid, tmp_path):
    mesh = tmp_path / "big.obj"
    mesh.write_text("".join(f"{line.replace(' 1', ' 30') if line[:2] == 'v ' else line}\n"
                            for line in cube_text().splitlines()))  # fmt: skip
    said = pellucid("render", mesh, "-o", tmp_path / "a.exr", *QUICK, "--medium", "amber")
    assert said.code == 0 and "--scale 0.001" in said.err
    said = pellucid("render", mesh, "-o", tmp_path / "b.exr", *QUICK, "--medium", "amber", "--scale", "0.001")
    assert said.code == 0 and "--scale" not in said.err
    black, clear = (pixels(tmp_path / f"{name}.exr")[16, 24] for name in "ab")
    assert clear[0] > 2.0 * black[0]


def test_turned_normals_change_nothing(pellucid, tmp_path):
    right, inverted = (render_cube(pellucid, tmp_path, cube_text(inverted=i)) for i in (False, True))
    assert np.abs(right - inverted).max() < 1e-3


def test_an_open_mesh_is_closed(pellucid, tmp_path):
    closed, opened = render_cube(pellucid, tmp_path, cube_text()), render_cube(pellucid, tmp_path, cube_text(faces=5))
    none = pellucid("render", tmp_path / "mesh0.obj", "-o", tmp_path / "air.exr", *QUICK, "--medium", "1.0")
    assert none.code == 0
    air = pixels(tmp_path / "air.exr")
    assert np.abs(opened - closed).mean() < 0.5 * np.abs(closed - air).mean(), "still a body, not an empty picture"


def test_a_scene_file(pellucid, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text('tone_mapping = "linear"\n[camera]\nposition = [0, 0, 2]\n'
                     '[environment]\nkind = "constant"\nrgb = [0.5, 0.25, 0.125]\n')  # fmt: skip
    said = pellucid("render", scene, "-o", tmp_path / "a.exr", "--size", "8x8", "--samples", "1")
    assert said.code == 0, said.err
    assert np.allclose(pixels(tmp_path / "a.exr"), [0.5, 0.25, 0.125], rtol=1e-3)
    said = pellucid("render", scene, "-o", tmp_path / "b.exr", "--size", "8x8", "--environment", "studio")
    assert said.code == 0 and pixels(tmp_path / "b.exr").std() > 0.01


MESH_FLAGS = [
    ("--medium", "F2"), ("--boundary", "smooth"), ("--resolution", "64"), ("--floor", "none"), ("--up", "z"),
    ("--scale", "0.001"), ("--dispersion",),
]  # fmt: skip


@pytest.mark.parametrize("flag", MESH_FLAGS)
def test_a_flag_for_meshes_is_refused_for_a_scene(pellucid, tmp_path, flag):
    scene = tmp_path / "scene.json"
    scene.write_text("{}")
    said = pellucid("render", scene, "-o", tmp_path / "a.png", *flag)
    assert said.code == 2 and flag[0] in said.err


def test_the_camera_frames_any_object():
    """Every vertex is inside the picture, wherever and however large the object is."""
    from pellucid.cli.default_scene import View, framed_camera

    rng = np.random.default_rng(2)
    for scale, place, size in ((1e-3, 0.0, (800, 600)), (1.0, 5.0, (300, 900)), (250.0, -1e3, (1920, 400))):
        points = rng.uniform(-1.0, 1.0, (200, 3)) * (1.0, 0.2, 0.6) * scale + place
        camera = framed_camera(points, size, View())
        clip = np.c_[points, np.ones(200)] @ (camera.projection_matrix(size) @ camera.view_matrix()).T
        flat = np.abs(clip[:, :2] / clip[:, 3:])
        assert flat.max() < 0.9 and flat.max() > 0.6


def test_z_up_stands_the_object_upright(tmp_path):
    from pellucid.cli.default_scene import turned_up
    from pellucid.scene.placement import rotation_matrix

    points = np.random.default_rng(1).normal(size=(5, 3))
    turned, rotation = turned_up(points, "z")
    assert np.allclose(turned, points @ rotation_matrix(rotation).T)
    assert np.allclose(turned[:, 1], points[:, 2])


BAD_SIZES = ["0x100", "100x0", "100000x100", "800", "axb", "800x600x3", "-5x5", "1e3x5", ""]


@pytest.mark.parametrize("size", BAD_SIZES)
def test_a_size_that_is_none(pellucid, cube, tmp_path, size):
    said = pellucid("render", cube, "-o", tmp_path / "a.png", "--size", size)
    assert said.code == 2 and "--size" in said.err
    assert not (tmp_path / "a.png").exists()


def test_a_size_beyond_the_device(pellucid, cube, tmp_path):
    said = pellucid("render", cube, "-o", tmp_path / "a.png", "--size", "32768x1")
    assert said.code == 1 and "32768x1" in said.err.splitlines()[-1]


def empty(folder: Path) -> Path:
    (folder / "empty.obj").touch()
    return folder / "empty.obj"


def text(name: str, content: str):
    def make(folder: Path) -> Path:
        (folder / name).write_text(content)
        return folder / name

    return make


SOURCES = {
    "missing": (lambda folder: folder / "no.obj", "does not exist"),
    "folder": (lambda folder: folder, "folder"),
    "empty": (empty, "empty"),
    "no faces": (text("points.obj", "v 0 0 0\nv 1 0 0\n"), "faces"),
    "not a mesh": (text("words.ply", "once upon a time"), "PLY"),
    "no extent": (text("dot.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), "extent"),
    "flat": (text("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n"), "flat.obj: encloses"),
    "a line": (text("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "line.obj: has no face with an area"),
    "astronomic": (text("far.obj", cube_text().replace("v 1", "v 1e30")), "far.obj: is 1e+30 m long"),
    "atomic": (text("near.obj", cube_text().replace(" 1", " 1e-20").replace("f 1e-20", "f 1")), "--scale"),
    "another kind": (text("story.txt", "once upon a time"), ".json"),
    "broken scene": (text("scene.json", "{"), "JSON"),
    "wrong field": (text("scene.toml", "[camera]\nposition = [0, 0, 1]\nfov = 3\n"), "fov_deg"),
}


@pytest.mark.parametrize("case", SOURCES)
def test_a_source_that_cannot_be_drawn(pellucid, tmp_path, case):
    make, words = SOURCES[case]
    source = make(tmp_path)
    quick = ("--size", "8x8") if source.suffix in (".json", ".toml") else QUICK
    said = pellucid("render", source, "-o", tmp_path / "a.png", *quick)
    last = said.err.splitlines()[-1]
    assert said.code == 1 and last.startswith("error: ") and words in last, said.err
    assert "Traceback" not in said.err and not (tmp_path / "a.png").exists()


OUTPUTS = {
    "no suffix": ("picture", "suffix"),
    "unknown suffix": ("picture.gif", ".png"),
    "no folder": ("there/is/none.png", "folder"),
    "a folder": ("folder.png", "folder"),
    "below a file": ("cube.obj/a.png", "folder"),
    "unwritable": ("/proc/a.png", "/proc"),
}


@pytest.mark.parametrize("case", OUTPUTS)
def test_an_output_that_cannot_be_written_is_told_before_anything_is_loaded(
    pellucid, cube, tmp_path, case, monkeypatch
):
    def refuse(*_):
        raise AssertionError("the mesh was read first")

    monkeypatch.setattr("pellucid.io.meshes.read_mesh", refuse)
    (tmp_path / "folder.png").mkdir()
    name, words = OUTPUTS[case]
    said = pellucid("render", cube, "-o", tmp_path / name, *QUICK)
    assert said.code == 1 and said.err.startswith("error: ") and words in said.err
    assert len(said.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("flags", "code", "words"),
    [
        (("--medium", "N-BK8"), 1, "did you mean N-BK7"),
        (("--medium", "0"), 1, "refractive index"),
        (("--medium", "nan"), 1, "refractive index"),
        (("--environment", "no.hdr"), 1, "no.hdr"),
        (("--environment", "park"), 1, "studio"),
        (("--camera", "1,2"), 2, "x,y,z"),
        (("--camera", "1,2,inf"), 2, "x,y,z"),
        (("--fov", "0"), 2, "above 0"),
        (("--fov", "200"), 1, "fov_deg"),
        (("--exposure", "-1"), 2, "above 0"),
        (("--tone-mapping", "hollywood"), 2, "agx"),
        (("--samples", "0"), 2, "--samples"),
        (("--resolution", "4"), 2, "--resolution"),
        (("--resolution", "100000"), 2, "--resolution"),
    ],
)
def test_a_value_out_of_range(pellucid, cube, tmp_path, flags, code, words):
    said = pellucid("render", cube, "-o", tmp_path / "a.png", *QUICK, *flags)
    assert said.code == code and words in said.err, said.err
    assert "Traceback" not in said.err and not (tmp_path / "a.png").exists()
