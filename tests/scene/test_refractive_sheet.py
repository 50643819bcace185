"""Sheets as a user describes them: what is refused, what is read from files, what scene files keep, sphere maps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import Ripples
from pellucid.fields.waves import Sine
from pellucid.io.images import write_image
from pellucid.scene.sphere_maps import sphere_map, sphere_map_direction, sphere_map_uv

PICTURE = np.linspace(0.0, 1.0, 6 * 8 * 3, dtype=np.float32).reshape(6, 8, 3)
MESH = pl.Mesh.plane((2.0, 1.0))
UP_AND_DOWN = np.stack([np.add(MESH.vertices, (0.0, h, 0.0)) for h in (0.0, 0.1, 0.0)])


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("picture", {"picture": None}),
        ("picture", {"picture": np.zeros((4, 4))}),
        ("picture", {"picture": np.zeros((4, 4, 2))}),
        ("picture", {"picture": np.zeros((4, 4, 4))}),
        ("picture", {"picture": np.full((4, 4, 3), np.nan)}),
        ("picture", {"picture": -np.ones((4, 4, 3))}),
        ("picture", {"picture": np.zeros((1, 9000, 3), np.float32)}),
        ("depth_m", {"depth_m": 0.0}),
        ("depth_m", {"depth_m": -0.2}),
        ("size_m", {"size_m": 0.0}),
        ("size_m", {"size_m": (1.0, 0.0)}),
        ("size_m", {"size_m": (1.0, 2.0, 3.0)}),
        ("segments", {"segments": 0}),
        ("segments", {"segments": 5000}),
        ("waves", {"waves": np.array([[0.0, np.nan], [0.0, 0.0]])}),
        ("waves", {"waves": np.zeros((4, 4, 4))}),
        ("waves", {"waves": np.zeros((1, 4))}),
        ("waves", {"waves": np.full((4, 4), -0.3), "depth_m": 0.3}),
        ("waves", {"waves": Ripples((8, 8), 0.1, limit_m=0.5), "depth_m": 0.3}),
        ("waves", {"waves": np.zeros((4, 4)), "mesh": MESH}),
        ("motion", {"motion": UP_AND_DOWN}),
        ("motion", {"motion": UP_AND_DOWN[:, :3], "mesh": MESH}),
        ("motion", {"motion": UP_AND_DOWN - (0.0, 1.0, 0.0), "mesh": MESH}),
        ("mesh", {"mesh": "sheet.obj"}),
        ("mesh", {"mesh": pl.Mesh(MESH.vertices * (1.0, 1.0, 0.0), MESH.faces)}),
        ("mesh", {"mesh": pl.Mesh(MESH.vertices - (0.0, 1.0, 0.0), MESH.faces)}),
        ("medium", {"medium": "waterr"}),
        ("medium", {"medium": 0.0}),
        ("medium", {"medium": -1.3}),
        ("ambient_n", {"ambient_n": 0.0}),
        ("refraction", {"refraction": "snell"}),
        ("factor", {"factor": -0.1}),
        ("factor", {"factor": np.nan}),
        ("fit_angle_deg", {"fit_angle_deg": 91.0}),
        ("per", {"per": "pixel"}),
        ("borders", {"borders": "repeat"}),
        ("deviation_m", {"deviation_m": -1.0}),
        ("reflection", {"reflection": "mirror"}),
        ("sphere_map", {"reflection": "sphere_map"}),
        ("sphere_rule", {"sphere_rule": "cube"}),
        ("blend", {"blend": 1.5}),
        ("absorption", {"absorption": (1.0, -1.0, 0.0)}),
        ("show", {"show": "errors"}),
        ("error_scale", {"error_scale": 0.0}),
        ("lit", {"lit": 1}),
        ("scale", {"scale": 0.0}),
    ],
)
def test_a_sheet_that_cannot_be_is_refused(field: str, given: dict[str, Any]) -> None:
    with pytest.raises(pl.SceneError) as caught:
        pl.RefractiveSheet(**({"picture": PICTURE} | given))
    assert field in caught.value.field


def test_a_mesh_may_not_be_huge(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pellucid.scene.refractive_sheet.MOST_VERTICES", 3)
    with pytest.raises(pl.SceneError, match="simplify"):
        pl.RefractiveSheet(PICTURE, mesh=MESH)


def test_pictures_come_from_files(tmp_path: Path) -> None:
    with pytest.raises(pl.AssetError, match=r"floor\.png"):
        pl.RefractiveSheet(tmp_path / "floor.png")
    (tmp_path / "damaged.png").write_bytes(b"not a picture")
    with pytest.raises(pl.AssetError, match="damaged"):
        pl.RefractiveSheet(tmp_path / "damaged.png")
    write_image(tmp_path / "grey.png", np.full((4, 5), 188, np.uint8))
    grey = pl.RefractiveSheet(str(tmp_path / "grey.png")).picture
    assert grey.shape == (4, 5, 3)
    np.testing.assert_allclose(grey, 0.5, atol=0.005)  # sRGB becomes linear
    write_image(tmp_path / "dark.exr", np.full((4, 5, 3), -1.0, np.float32))
    with pytest.raises(pl.AssetError, match="negative"):
        pl.RefractiveSheet(tmp_path / "dark.exr")


def test_a_mesh_moves_between_its_frames_and_stays_at_the_last() -> None:
    sheet = pl.RefractiveSheet(PICTURE, mesh=MESH, motion=UP_AND_DOWN, motion_fps=10.0)
    heights = [float(sheet.vertices_at(t)[0, 1]) for t in (-1.0, 0.0, 0.05, 0.1, 0.175, 9.0)]
    np.testing.assert_allclose(heights, [0.0, 0.0, 0.05, 0.1, 0.025, 0.0], atol=1e-7)
    wild = pl.RefractiveSheet(PICTURE, mesh=MESH, motion=lambda t: np.zeros((2, 3)))
    with pytest.raises(pl.SceneError, match="motion"):
        wild.vertices_at(0.0)
    deep = pl.RefractiveSheet(PICTURE, mesh=MESH, motion=lambda t: MESH.vertices - (0.0, t, 0.0))
    with pytest.raises(pl.SceneError, match="picture lies"):
        deep.vertices_at(1.0)


def everything(tmp_path: Path) -> list[pl.RefractiveSheet]:
    write_image(tmp_path / "floor.png", np.full((4, 4, 3), 100, np.uint8))
    sky = sphere_map(pl.Environment.sky(30.0), 16, "linear")
    waves = 0.01 * np.cos(np.arange(48.0)).reshape(6, 8)
    return [
        pl.RefractiveSheet(tmp_path / "floor.png", 0.4, (1.0, 2.0), waves, segments=12, medium=1.5, factor=0.2,
                           refraction="approximate", per="vertex", borders="shrink", deviation_m=0.1,
                           fit_angle_deg=40.0, reflection="sphere_map", sphere_map=sky, sphere_rule="linear",
                           blend=0.25, absorption=(1.0, 0.5, 0.2), rotation=(10, 20, 30), scale=2.0),
        pl.RefractiveSheet(PICTURE, mesh=MESH, motion=UP_AND_DOWN, motion_fps=10.0, lit=True, meshes=False,
                           ambient_n=1.1, reflection="environment", show="error_uv", error_scale=0.2),
        pl.RefractiveSheet(PICTURE, mesh=pl.Mesh(MESH.vertices, MESH.faces, shading="flat")),
    ]  # fmt: skip


@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_a_scene_file_keeps_sheets(tmp_path: Path, suffix: str) -> None:
    sheets = everything(tmp_path)
    scene = pl.Scene(pl.Camera((0, 1, 1)), objects=sheets)
    pl.save_scene(scene, tmp_path / f"pond{suffix}")
    for before, after in zip(sheets, pl.load_scene(tmp_path / f"pond{suffix}").objects, strict=True):
        assert isinstance(after, pl.RefractiveSheet)
        for name in before.__dataclass_fields__:
            old, new = getattr(before, name), getattr(after, name)
            if name in ("files", "medium"):
                continue
            if isinstance(old, pl.Mesh):
                np.testing.assert_array_equal(old.vertices, new.vertices)
                np.testing.assert_array_equal(old.normals, new.normals)
            elif isinstance(old, np.ndarray):
                np.testing.assert_array_equal(old, new, err_msg=name)
            else:
                assert old == new, name
        assert before.matter.n_d == after.matter.n_d
        assert before.files.keys() <= after.files.keys()


def test_a_scene_file_keeps_waves_that_move(tmp_path: Path) -> None:
    ripples = Ripples((8, 8), 0.1)
    ripples.drop(0.0, 0.0, 0.1, 0.02)
    sine = Sine(0.5, 0.02, tile_m=1.0, shape=(16, 16))
    scene = pl.Scene(pl.Camera((0, 1, 1)), objects=[pl.RefractiveSheet(PICTURE, waves=w) for w in (ripples, sine)])
    pl.save_scene(scene, tmp_path / "pond.toml")
    for before, after in zip(scene.objects, pl.load_scene(tmp_path / "pond.toml").objects, strict=True):
        np.testing.assert_allclose(after.waves.advance(0.3), before.waves.advance(0.3), atol=1e-7)


def test_a_formula_of_the_user_is_in_no_scene_file(tmp_path: Path) -> None:
    class Own:
        shape, tile_m, limits_m = (4, 4), (1.0, 1.0), (0.0, 0.1)

        def advance(self, time_s: float) -> np.ndarray:
            return np.zeros((4, 4), np.float32)

    for what, sheet in (
        ("waves", pl.RefractiveSheet(PICTURE, waves=Own())),
        ("motion", pl.RefractiveSheet(PICTURE, mesh=MESH, motion=lambda t: MESH.vertices)),
    ):
        with pytest.raises(pl.SceneError, match=what):
            pl.save_scene(pl.Scene(pl.Camera((0, 1, 1)), objects=[sheet]), tmp_path / "pond.toml")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ('picture = "missing.png"', r"missing\.png"),
        ('picture = "floor.png"\ndepth_m = -1', r"objects\[0\]\.depth_m"),
        ('picture = "floor.png"\nfacter = 1', "facter"),
        ('picture = "floor.png"\narrays = "other.npz"', "neither waves nor motion"),
        ('picture = "floor.png"\nwaves = { kind = "sine", wavelenth_m = 0.3 }', r"objects\[0\]\.waves\.wavelenth_m"),
        ('picture = "floor.png"\nwaves = { kind = "cosine" }', r"objects\[0\]\.waves\.kind"),
        ("depth_m = 1", "refractive_sheet"),
    ],
)
def test_faults_of_a_scene_file_are_named(tmp_path: Path, line: str, reason: str) -> None:
    write_image(tmp_path / "floor.png", np.full((4, 4, 3), 100, np.uint8))
    np.savez(tmp_path / "other.npz", heights=np.zeros((2, 2)))
    text = f'[camera]\nposition = [0, 1, 1]\n[[objects]]\ntype = "refractive_sheet"\n{line}\n'
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    with pytest.raises(pl.PellucidError, match=reason):
        pl.load_scene(tmp_path / "scene.toml")


def test_sphere_maps_show_known_directions() -> None:
    h = 0.5 / np.sqrt(2.0)
    directions = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1], [-1, 0, 0], [0, 0, 1]], float)
    ball = [[0.5, 0.5], [0.5 + h, 0.5], [0.5, 0.5 - h], [0.5 - h, 0.5], [0.5, 0.5 + h]]
    linear = [[0.5, 0.5], [1.0, 0.5], [0.5, 0.0], [0.0, 0.5], [0.5, 1.0]]
    np.testing.assert_allclose(sphere_map_uv(directions), ball, atol=1e-12)
    np.testing.assert_allclose(sphere_map_uv(directions, "linear"), linear, atol=1e-12)
    nearly_down = np.array([np.sin(3.14), np.cos(3.14), 0.0])
    np.testing.assert_allclose(sphere_map_uv(nearly_down), [1.0, 0.5], atol=1e-3)
    assert np.isfinite(sphere_map_uv([0.0, -1.0, 0.0])).all()


@pytest.mark.parametrize("rule", ["ball", "linear"])
def test_a_sphere_map_is_looked_up_where_it_was_painted(rule: str) -> None:
    directions = np.random.default_rng(2).normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if rule == "linear":
        directions[:, 1] = np.abs(directions[:, 1])
    there = sphere_map_direction(sphere_map_uv(directions, rule), rule)
    np.testing.assert_allclose(there, directions, atol=1e-6)


def test_the_sphere_map_of_an_environment_holds_its_radiance() -> None:
    sky = pl.Environment.constant((0.2, 0.3, 0.4)).replace(intensity=2.0)
    np.testing.assert_allclose(sphere_map(sky, 8), np.broadcast_to((0.4, 0.6, 0.8), (8, 8, 3)), rtol=1e-6)
    pixels = np.zeros((32, 64, 3), np.float32)
    pixels[:, 44:52] = 1.0  # towards +X
    turned = pl.Environment(pixels, rotation_deg=90.0)  # +X comes to lie along -Z, the top of the picture
    found = sphere_map(turned, 33, "linear")[..., 0]
    assert found[4, 16] > 0.9 and found[16, 28] < 0.01 and found[28, 16] < 0.01
