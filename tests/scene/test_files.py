"""Scene files: what is saved comes back the same, and faults are told by file and field."""

from __future__ import annotations

import dataclasses
import errno
import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pellucid import media
from pellucid.errors import AssetError, SceneError
from pellucid.fields.volume import Region, Volume
from pellucid.io.images import write_image
from pellucid.scene import (
    GGX,
    AreaLight,
    Camera,
    DirectionalLight,
    Environment,
    Mesh,
    PointLight,
    Quality,
    RefractiveVolume,
    Scene,
    TabulatedBRDF,
    load_scene,
    save_scene,
)
from pellucid.scene.files import _toml_value
from pellucid.scene.placement import Origin

CAMERA = {"position": [0, 0.2, 1]}
RNG = np.random.default_rng(11)
INDEX = 1.0 + 0.3 * RNG.random((4, 5, 6)).astype(np.float32)


def same(a: Any, b: Any) -> bool:
    """Equal in every number, whatever the recipe says."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return bool(np.array_equal(a, b)) and a.dtype == b.dtype
    if isinstance(a, Origin):
        return True
    if dataclasses.is_dataclass(a) and type(a) is type(b):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(a) if f.name != "origin")
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)


def ball(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    return np.sqrt(x * x + y * y + z * z) - 0.3


@pytest.fixture
def inputs(tmp_path: Path) -> Path:
    """A folder with a mesh, a map, an environment and an array, as a user would have."""
    import trimesh

    folder = tmp_path / "inputs"
    folder.mkdir()
    trimesh.creation.box((0.4, 0.3, 0.2)).export(folder / "box.ply")
    write_image(folder / "room.exr", RNG.random((8, 16, 3)).astype(np.float32))
    np.save(folder / "n.npy", INDEX)
    np.save(folder / "absorption.npy", RNG.random((4, 5, 6, 3)).astype(np.float32))
    return folder


def everything(inputs: Path) -> Scene:
    body = Region(RNG.normal(size=(4, 5, 6)), 1.5, "opal", (1, 0, 0), scattering=(1, 2, 3), anisotropy=-0.25)
    murky = Volume((0.6, 0.5, 0.4), regions=(body,), scattering=RNG.random((4, 5, 6, 3)), anisotropy=0.5 * INDEX - 0.5)
    ruby = media.get("water").with_absorption((1.0, 20.0, 30.0), name="wine")
    return Scene(
        Camera((1, 2, 3), up=(0, 0, 1), fov_deg=33.3, orthographic_height_m=2.0),
        Environment.load(inputs / "room.exr", intensity=0.5, rotation_deg=30),
        [
            DirectionalLight((0, -1, 0), irradiance=2.5),
            PointLight((0, 1, 0), color=(1, 0.5, 0.25), cast_shadow=False),
            AreaLight((0, 2, 0), (1, 0, 0), (0, 0, 1), radiance=4.0),
        ],
        [
            Mesh.plane((2, 3), base_color=(0.1, 0.2, 0.3), position=(0, -1, 0)),
            Mesh.box((1, 2, 3), rotation=(10, 20, 30), scale=0.5),
            Mesh.sphere(0.25, segments=16, shading="flat", roughness=0.2),
            Mesh.checkerboard(3.0, squares=4, colors=((0.9, 0.1, 0.1), (0.1, 0.1, 0.1)), emission=(0, 0, 1)),
            Mesh.load(inputs / "box.ply", base_color=(0.8, 0.8, 0.8), double_sided=False),
            Mesh(RNG.random((3, 3)), [[0, 1, 2]], uvs=RNG.random((3, 2)), base_color_map=RNG.random((4, 4, 3))),
            RefractiveVolume.from_mesh(
                inputs / "box.ply", "N-BK7", 12, 1.33, boundary="smooth", quality=Quality(bounces=3, adaptive=False)
            ),
            RefractiveVolume.from_mesh(
                inputs / "box.ply",
                ruby,
                12,
                position=(1, 0, 0),
                dispersion=False,
                gloss=0.2,
                proxy=Mesh.load(inputs / "box.ply"),
            ),
            RefractiveVolume.from_array(
                INDEX,
                (0.6, 0.5, 0.4),
                1.1,
                emission=RNG.random((4, 5, 6, 3)),
                reflection=RNG.random((4, 5, 6, 4)),
                brdf=TabulatedBRDF(0.3 * RNG.random((5, 4, 3))),
                proxy=Mesh.box(0.3),
            ),
            RefractiveVolume.from_regions(
                [(ball, 1.7), (ball, "diamond")], 8, 0.8, 1.2, center_m=(0, 1, 0), brdf=GGX(0.5), proxy="sphere"
            ),
            RefractiveVolume.from_volume(murky),
        ],
        exposure=1.5,
        tone_mapping="linear",
    )


@pytest.mark.parametrize("suffix", [".json", ".toml"])
def test_everything_comes_back_as_it_was(inputs: Path, tmp_path: Path, suffix: str) -> None:
    scene = everything(inputs)
    save_scene(scene, tmp_path / f"scene{suffix}")
    again = load_scene(tmp_path / f"scene{suffix}")
    for a, b in zip(scene.objects, again.objects, strict=True):
        assert same(a, b), f"{a} became {b}"
    assert same(scene, again)


def test_saving_what_was_loaded_changes_nothing(inputs: Path, tmp_path: Path) -> None:
    save_scene(everything(inputs), tmp_path / "a.json")
    first = load_scene(tmp_path / "a.json")
    text, names = (tmp_path / "a.json").read_text(), sorted(tmp_path.iterdir())
    save_scene(first, tmp_path / "a.json")
    assert (tmp_path / "a.json").read_text() == text and sorted(tmp_path.iterdir()) == names
    assert same(load_scene(tmp_path / "a.json"), first)


def test_things_may_change_places_before_they_are_saved_again(inputs: Path, tmp_path: Path) -> None:
    save_scene(everything(inputs), tmp_path / "a.json")
    turned = load_scene(tmp_path / "a.json")
    turned = turned.replace(objects=turned.objects[::-1])
    save_scene(turned, tmp_path / "a.json")
    assert same(load_scene(tmp_path / "a.json"), turned)


def test_recipes_stay_recipes(inputs: Path, tmp_path: Path) -> None:
    scene = Scene(
        Camera((0, 0, 1)),
        Environment.sky(20.0, 10.0, 4.0),
        objects=[Mesh.plane(2.0), RefractiveVolume.from_mesh(inputs / "box.ply", "N-BK7", 12)],
    )
    save_scene(scene, tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text()) == {
        "camera": {"position": [0.0, 0.0, 1.0]},
        "environment": {
            "kind": "sky",
            "sun_elevation_deg": 20.0,
            "sun_azimuth_deg": 10.0,
            "turbidity": 4.0,
            "sun_disc": True,
            "sun_diameter_deg": 2.0,
            "ground_albedo": [0.19, 0.17, 0.14],
        },
        "lights": [],
        "objects": [
            {"type": "mesh", "kind": "plane", "size_m": [2.0, 2.0], "base_color": [0.8, 0.8, 0.8]},
            {
                "type": "refractive_volume",
                "mesh": "inputs/box.ply",
                "medium": "N-BK7",
                "resolution": 12,
                "ambient_n": 1.0,
            },
        ],
    }
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.json", "inputs"]  # nothing beside it


def test_changed_geometry_is_no_longer_its_recipe(tmp_path: Path) -> None:
    plane = Mesh.plane()
    bent = plane.replace(vertices=plane.vertices + np.float32(0.5))
    save_scene(Scene(Camera((0, 0, 1)), objects=[bent]), tmp_path / "a.json")
    assert (tmp_path / "a.object-0.npz").is_file()
    assert same(load_scene(tmp_path / "a.json").objects[0], bent)


def test_a_map_that_was_taken_away_stays_away(tmp_path: Path) -> None:
    bare = Mesh.checkerboard().replace(base_color_map=None)
    save_scene(Scene(Camera((0, 0, 1)), objects=[bare]), tmp_path / "a.toml")
    assert same(load_scene(tmp_path / "a.toml").objects[0], bare)


def test_a_file_written_by_hand(inputs: Path) -> None:
    (inputs / "scene.toml").write_text("""
exposure = 2
[camera]
position = [0, 0.2, 1]
fov_deg = 30
[environment]
file = "room.exr"
rotation_deg = 90
[[lights]]
type = "directional"
direction = [-1, -2, -1]
[[objects]]
type = "mesh"
kind = "checkerboard"
squares = 4
[[objects]]
type = "refractive_volume"
array = "n.npy"
absorption = "absorption.npy"
extent_m = [0.6, 0.5, 0.4]
position = [0, 0.1, 0]
quality = { step_voxels = 0.5 }
[[objects]]
type = "refractive_volume"
mesh = "box.ply"
medium = { base = 1.5, absorption_rgb_per_m = [1, 2, 3] }
resolution = 10
""")
    scene = load_scene(inputs / "scene.toml")
    graded, glass = scene.objects[1], scene.objects[2]
    assert isinstance(graded, RefractiveVolume) and isinstance(glass, RefractiveVolume)
    assert scene.exposure == 2.0 and scene.camera.fov_deg == 30.0 and scene.environment.rotation_deg == 90.0
    assert graded.volume.delta_n == pytest.approx(INDEX - 1.0, abs=1e-6) and graded.quality.step_voxels == 0.5
    assert glass.volume.regions[0].medium.absorption_rgb_per_m == pytest.approx([1, 2, 3])
    save_scene(scene, inputs.parent / "moved.json")
    assert same(load_scene(inputs.parent / "moved.json"), scene)  # paths follow the file


@pytest.mark.parametrize(
    ("scene", "where", "words"),
    [
        ({}, "camera", "is missing"),
        ({"camera": {}}, "camera.position", "is missing"),
        ({"camera": {"position": [0, 0]}}, "camera.position[2]", "is missing"),
        ({"camera": {"position": [0, 0, "x"]}}, "camera.position[2]", "valid number"),
        ({"camera": {"position": [0, 0, True]}}, "camera.position[2]", "valid number"),
        ({"camera": {"position": [0, 0, float("nan")]}}, "camera.position[2]", "finite"),
        ({"camera": {**CAMERA, "fov": 40}}, "camera.fov", r"belongs here \(did you mean 'fov_deg'\?\)"),
        ({"camera": {**CAMERA, "fov_deg": "40"}}, "camera.fov_deg", "valid number, got '40'"),
        ({"camera": {**CAMERA, "fov_deg": 200}}, "camera.fov_deg", "between 0 and 180 degrees, got 200"),
        ({"camera": {"position": [0, 0, 0]}}, "camera.target", "lies at the camera's position"),
        ({"camera": CAMERA, "environment": {"kind": "disco"}}, "environment", "needs"),
        ({"camera": CAMERA, "environment": {"kind": "sky", "turbidity": 1}}, "environment.turbidity", "2 and 10"),
        ({"camera": CAMERA, "environment": {"kind": "studio", "rgb": 1}}, "environment.rgb", "belongs here"),
        ({"camera": CAMERA, "environment": {"kind": "constant", "rgb": "red"}}, "environment.rgb", "valid number"),
        ({"camera": CAMERA, "lights": [{"type": "spot"}]}, "lights[0]", "directional"),
        ({"camera": CAMERA, "lights": {"type": "point"}}, "lights", "list"),
        (
            {"camera": CAMERA, "lights": [{"type": "directional", "direction": [0, 0, 0]}]},
            "lights[0].direction",
            "zero vector",
        ),
        ({"camera": CAMERA, "objects": [{"kind": "plane"}]}, "objects[0]", 'needs "type"'),
        ({"camera": CAMERA, "objects": [3]}, "objects[0]", 'needs "type"'),
        (
            {"camera": CAMERA, "objects": [{"type": "mesh", "kind": "plane", "radius_m": 1}]},
            "objects[0].radius_m",
            "belongs here",
        ),
        (
            {
                "camera": CAMERA,
                "objects": [{"type": "mesh", "kind": "plane"}, {"type": "mesh", "kind": "box", "scale": 0}],
            },
            "objects[1].scale",
            "greater than 0",
        ),
        (
            {"camera": CAMERA, "objects": [{"type": "refractive_volume", "mesh": "box.ply"}]},
            "objects[0].medium",
            "is missing",
        ),
        (
            {"camera": CAMERA, "objects": [{"type": "refractive_volume", "mesh": "box.ply", "medium": "N-BK77"}]},
            "objects[0].medium",
            "N-BK7",
        ),
        (
            {
                "camera": CAMERA,
                "objects": [
                    {"type": "refractive_volume", "mesh": "box.ply", "medium": 1.5, "quality": {"bounces": -1}}
                ],
            },
            "objects[0].quality.bounces",
            "between 0 and 64",
        ),
        (
            {
                "camera": CAMERA,
                "objects": [{"type": "refractive_volume", "mesh": "box.ply", "medium": {"base": "N-BK7"}}],
            },
            "objects[0].medium.absorption_rgb_per_m",
            "is missing",
        ),
        ({"camera": CAMERA, "exposure": -1}, "exposure", "greater than 0"),
        ({"camera": CAMERA, "tone_mapping": "film"}, "tone_mapping", "agx"),
        ([], "the scene", "table of named fields"),
    ],
)
def test_each_fault_names_file_and_field(inputs: Path, scene: Any, where: str, words: str) -> None:
    file = inputs / "scene.json"
    file.write_text(json.dumps(scene))
    with pytest.raises(SceneError, match=words) as caught:
        load_scene(file)
    assert caught.value.field == f"{file}: {where}"


def test_several_faults_are_named_at_once(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps({"camera": {"fov": 3}, "exposure": "x"}))
    with pytest.raises(SceneError, match=r"camera\.position: is missing; also wrong: camera\.fov, exposure"):
        load_scene(tmp_path / "a.json")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.json", '{"camera": {"fov_deg": 1, "fov_deg": 2}}', "'fov_deg' stands twice"),
        ("a.json", "[" * 100_000, "nested too deeply"),
        ("a.json", "{", "not valid JSON.*line 1"),
        ("a.toml", "x = ", "not valid TOML: Invalid value"),
        ("a.json", "", "empty"),
        ("a.yaml", "x", "suffix"),
        ("a.json", json.dumps({"camera": CAMERA, "environment": {"file": "gone.exr"}}), "gone.exr: does not exist"),
        (
            "a.json",
            json.dumps({"camera": CAMERA, "objects": [{"type": "mesh", "file": "gone.obj"}]}),
            "gone.obj: does not exist",
        ),
    ],
)
def test_files_that_cannot_be_used(tmp_path: Path, name: str, content: str, words: str) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(AssetError, match=words):
        load_scene(tmp_path / name)


def test_a_byte_order_mark_is_no_fault(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_bytes(b'\xef\xbb\xbf{"camera": {"position": [0, 0, 1]}}')
    assert load_scene(tmp_path / "a.json").camera.position == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("values", "more", "blamed", "words"),
    [
        (np.full((2, 2, 2), np.nan), {}, "n.npy", "8 values that are not finite"),
        (-np.ones((2, 2, 2)), {}, "n.npy", "index is above 0"),
        (np.ones((2, 2, 2)), {"absorption": "a.npy"}, "a.npy", "as absorption of a volume: has -1"),
    ],
)
def test_an_array_of_a_scene_is_named_by_its_file(
    tmp_path: Path, values: np.ndarray, more: dict[str, str], blamed: str, words: str
) -> None:
    np.save(tmp_path / "n.npy", values)
    np.save(tmp_path / "a.npy", -np.ones((2, 2, 2, 3)))
    volume = {"type": "refractive_volume", "array": "n.npy", "extent_m": 0.1, **more}
    (tmp_path / "a.json").write_text(json.dumps({"camera": {"position": [0, 0, 1]}, "objects": [volume]}))
    with pytest.raises(AssetError, match=words) as caught:
        load_scene(tmp_path / "a.json")
    assert caught.value.path == str(tmp_path / blamed)


def test_a_flat_mesh_of_a_scene_is_named_by_its_file(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    volume = {"type": "refractive_volume", "mesh": "a.obj", "medium": "water", "resolution": 16}
    (tmp_path / "a.json").write_text(json.dumps({"camera": {"position": [0, 0, 1]}, "objects": [volume]}))
    with pytest.raises(AssetError, match="encloses no voxel centre") as caught:
        load_scene(tmp_path / "a.json")
    assert caught.value.path == str(tmp_path / "a.obj")


def test_bytes_that_are_not_text(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(AssetError, match="UTF-8"):
        load_scene(tmp_path / "a.json")


def test_a_scene_that_cannot_be_stated_leaves_nothing_behind(tmp_path: Path) -> None:
    own = dataclasses.replace(media.get("N-BK7"), name="mine", formula=lambda um: 1.5 + 0.0 * um)  # type: ignore[arg-type]
    things = [
        RefractiveVolume.from_array(INDEX, (0.6, 0.5, 0.4)),
        RefractiveVolume.from_sdf(ball, own, 8, 0.8),
    ]
    with pytest.raises(SceneError, match=r"objects\[1\].medium: 'mine' has a formula of its own"):
        save_scene(Scene(Camera((0, 0, 1)), objects=things), tmp_path / "a.json")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(AssetError, match="folder"):
        save_scene(Scene(Camera((0, 0, 1))), tmp_path / "no" / "a.json")
    with pytest.raises(AssetError, match="suffix"):
        save_scene(Scene(Camera((0, 0, 1))), tmp_path / "a.yaml")


def test_a_read_only_file_system_is_an_error_in_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "unlink", refuse)
    monkeypatch.setattr(np, "savez", refuse)
    volume = RefractiveVolume.from_array(INDEX, (0.6, 0.5, 0.4))
    with pytest.raises(AssetError, match="Read-only file system"):
        save_scene(Scene(Camera((0, 0, 1)), objects=[volume]), tmp_path / "a.json")


@pytest.mark.parametrize(
    "value", [1e-07, -0.0, 3, True, 'a "b" \\ c\n\t\x7f é 😀', [[1.5, 2.0], [3.0]], {"a": {"b": [1]}}]
)
def test_toml_that_is_written_is_read_the_same(value: Any) -> None:
    assert tomllib.loads(f"x = {_toml_value(value)}") == {"x": value}


def test_crystals_come_back_with_their_axes(inputs: Path, tmp_path: Path) -> None:
    from pellucid.fields.volume import Region, Volume

    sdf = np.full((4, 5, 6), -1.0, np.float32)
    coloured = media.get("quartz").with_absorption((1.0, 2.0, 3.0), "tinted", (4.0, 5.0, 6.0))
    substances = (media.get("calcite"), coloured, media.uniaxial(1.7, 1.5, (1.0, 0.0, 0.0), name="two"))
    regions = tuple(Region(sdf, medium, optic_axis=(0.0, 0.6, 0.8)) for medium in substances)  # type: ignore[arg-type]
    axis = np.broadcast_to(np.float32([0.0, 0.0, 1.0]), (4, 5, 6, 3))
    volume = Volume((0.6, 0.5, 0.4), regions=regions, optic_axis=axis, delta_n_e=sdf + 1.4)  # type: ignore[arg-type]
    mesh = RefractiveVolume.from_mesh(inputs / "box.ply", "calcite", 16, optic_axis=(0, 2, 0))
    scene = Scene(camera=Camera(position=(0.0, 0.2, 1.0)), objects=[RefractiveVolume(volume), mesh])
    save_scene(scene, tmp_path / "crystals.json")
    again = load_scene(tmp_path / "crystals.json")
    assert same(again, scene)
    assert again.objects[1].volume.regions[0].optic_axis == (0.0, 1.0, 0.0)  # type: ignore[union-attr]
