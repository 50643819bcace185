"""Reliefs as a user describes them: what is refused, what is read from files, what scene files keep."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.io.images import write_image
from pellucid.scene.relief_quality import STEPS, TECHNIQUES, quality_of

FLAT = pl.ReliefLayer(0.0)
PLANE = pl.Mesh.plane(1.0)


def wavy(size: int = 8) -> np.ndarray:
    rows, columns = np.mgrid[0:size, 0:size] / size
    return 0.5 + 0.5 * np.sin(2 * np.pi * columns) * np.cos(2 * np.pi * rows)


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("heights", {"heights": np.array([[0.0, np.nan]])}),
        ("heights", {"heights": np.zeros((2, 2, 2))}),
        ("heights", {"heights": np.zeros((0, 3))}),
        ("heights", {"heights": "high"}),
        ("height_m", {"heights": wavy(), "height_m": -0.1}),
        ("height_m", {"heights": wavy(), "height_m": 0.0}),
        ("base_m", {"heights": 0.0, "base_m": np.inf}),
        ("normals", {"heights": 0.0, "normals": np.zeros((2, 2, 3))}),
        ("normals", {"heights": 0.0, "normals": np.zeros((2, 2))}),
        ("colors", {"heights": 0.0, "colors": (0.5, 0.5, 1.5)}),
        ("colors", {"heights": 0.0, "colors": -np.ones((2, 2, 3))}),
        ("roughness", {"heights": 0.0, "roughness": 2.0}),
        ("normal_convention", {"heights": 0.0, "normal_convention": "metal"}),
    ],
)
def test_a_layer_that_cannot_be_is_refused(field: str, given: dict[str, Any]) -> None:
    with pytest.raises(pl.PellucidError) as caught:
        pl.ReliefLayer(**given)
    assert field in str(caught.value) or isinstance(caught.value, pl.AssetError)


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("mesh", {"mesh": "plane.obj"}),
        ("mesh.uvs", {"mesh": pl.Mesh(PLANE.vertices, PLANE.faces)}),
        ("solid", {"solid": 0.1}),
        ("translucent", {"translucent": 0.1}),
        ("quality", {"quality": pl.Quality()}),
        ("scale", {"scale": 0.0}),
        ("tile_m", {"tile_m": -0.1}),
        ("tiles", {"tiles": (1.0, 2.0, 3.0)}),
        ("tiles", {"tiles": (2.0, 2.0), "tile_m": 0.1}),
        ("technique", {"technique": "bump"}),
        ("medium", {"medium": "watr"}),
        ("ambient_n", {"ambient_n": 0.0}),
        ("absorption", {"absorption": (1.0, -1.0, 0.0)}),
        ("scattering", {"scattering": -1.0}),
        ("specular_factor", {"specular_factor": 0.0}),
        ("edges", {"edges": "fade"}),
    ],
)
def test_a_surface_that_cannot_be_is_refused(field: str, given: dict[str, Any]) -> None:
    with pytest.raises(pl.SceneError) as caught:
        pl.ReliefSurface(**({"mesh": PLANE, "solid": FLAT} | given))
    assert caught.value.field.startswith(f"relief_surface.{field}")


@pytest.mark.parametrize(
    "given",
    [
        {"search": "best"},
        {"linear_steps": 0},
        {"refraction_steps": 8},
        {"shadow_steps": 2.5},
        {"refraction_pieces": 17},
        {"hue": 1},
    ],
)
def test_a_quality_that_cannot_be_is_refused(given: dict[str, Any]) -> None:
    with pytest.raises(pl.SceneError, match=next(iter(given))):
        pl.ReliefQuality(**given)


@pytest.mark.parametrize("suffix", ["8.png", "16.png", "f.exr"])
def test_heights_come_from_pictures(tmp_path: Path, suffix: str) -> None:
    heights, path = wavy(), tmp_path / f"h{suffix}"
    stored: dict[str, tuple[Any, float]] = {"8.png": (np.uint8, 255.0), "16.png": (np.uint16, 65535.0)}
    kind, most = stored.get(suffix, (np.float32, 1.0))
    pixels = heights.astype(kind) if most == 1.0 else np.round(heights * most).astype(kind)
    write_image(path, pixels)
    layer = pl.ReliefLayer(path, height_m=0.02, base_m=-0.01)
    np.testing.assert_allclose(layer.heights_m, 0.02 * heights - 0.01, atol=0.02 * (0.51 / most if most > 1 else 1e-6))
    with pytest.raises(pl.SceneError, match="height_m"):
        pl.ReliefLayer(path)


def test_a_picture_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(pl.AssetError, match=r"nowhere\.png"):
        pl.ReliefLayer(tmp_path / "nowhere.png", height_m=0.1)


def test_normal_maps_of_both_conventions_give_the_slopes_of_the_heights(tmp_path: Path) -> None:
    heights, cell = 0.1 * wavy(32), (1 / 32, 1 / 32)
    wanted = pl.ReliefLayer(heights).slopes(cell, True)
    normals = np.concatenate([-wanted, np.ones((32, 32, 1))], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    for convention, up in (("opengl", 1.0), ("directx", -1.0)):
        path = tmp_path / f"{convention}.png"
        write_image(path, np.round((0.5 + 0.5 * normals * (1.0, up, 1.0)) * 65535).astype(np.uint16))
        found = pl.ReliefLayer(heights, normals=path, normal_convention=convention).slopes(cell, True)
        np.testing.assert_allclose(found, wanted, atol=1e-3)


def test_a_changed_layer_keeps_its_other_maps() -> None:
    layer = pl.ReliefLayer(wavy(), height_m=0.02, colors=np.ones((4, 4, 3)))
    changed = layer.replace(roughness=0.3)
    assert changed.heights is layer.heights and changed.colors is layer.colors
    np.testing.assert_array_equal(changed.heights_m, layer.heights_m)


def test_every_technique_has_a_quality() -> None:
    found = {name: quality_of(name, pl.ReliefQuality()) for name in TECHNIQUES}
    assert all(found[step].shadows == found[step].occlusion == "none" for step in STEPS[:5])
    assert found["occlusion"].occlusion == "texture" and found["occlusion_thesis"].occlusion == "fragment"
    assert not found["occlusion"].hue and found["occlusion_hue"].hue
    assert found["best"] == pl.ReliefQuality()
    assert found["relief_thesis"].search == "linear" and found["best_thesis"].reflection == "plane"


@pytest.mark.parametrize("suffix", [".json", ".toml"])
def test_a_surface_comes_back_from_a_scene_file(tmp_path: Path, suffix: str) -> None:
    write_image(tmp_path / "bumps.png", np.round(wavy() * 65535).astype(np.uint16))
    solid = pl.ReliefLayer(tmp_path / "bumps.png", height_m=0.01, colors=np.full((2, 2, 3), 0.25), roughness=0.3)
    items = [
        pl.ReliefSurface.torus(0.2, 0.05, solid, pl.ReliefLayer(0.012), medium="N-BK7", absorption=(1.0, 2.0, 3.0)),
        pl.ReliefSurface(
            pl.Mesh(PLANE.vertices, PLANE.faces, uvs=PLANE.uvs),
            pl.ReliefLayer(0.01 * wavy(), colors=(0.1, 0.2, 0.3)),
            technique="relief_thesis",
            quality=pl.ReliefQuality(reflection="plane", refraction_steps=(4, 2)),
            tile_m=(0.2, 0.3),
            specular_factor=10.0,
            position=(0, 1, 0),
        ),
    ]
    path = tmp_path / f"scene{suffix}"
    pl.save_scene(pl.Scene(pl.Camera(position=(0, 1, 1)), objects=items), path)
    for before, after in zip(items, pl.load_scene(path).objects, strict=True):
        assert isinstance(after, pl.ReliefSurface)
        same = ("technique", "quality", "tile_m", "tiles", "absorption", "specular_factor", "position", "ambient_n")
        assert [getattr(after, name) for name in same] == [getattr(before, name) for name in same]
        assert after.matter == before.matter
        np.testing.assert_array_equal(after.mesh.vertices, before.mesh.vertices)
        np.testing.assert_allclose(after.solid.heights_m, before.solid.heights_m, atol=1e-9)
        np.testing.assert_allclose(after.solid.colors, before.solid.colors)
        assert after.solid.roughness == before.solid.roughness
        assert (after.translucent is None) == (before.translucent is None)


def test_a_fault_in_a_scene_file_is_located(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    start = '[camera]\nposition = [0, 1, 1]\n[[objects]]\ntype = "relief_surface"\n'
    path.write_text(f'{start}mesh = {{ kind = "plane" }}\nsolid = {{ colors = [1, 1, 1] }}\n', encoding="utf-8")
    with pytest.raises(pl.SceneError, match=r"objects\[0\]\.solid\.heights"):
        pl.load_scene(path)
    path.write_text(f'{start}mesh = {{ kind = "cube" }}\nsolid = {{ heights = 0.0 }}\n', encoding="utf-8")
    with pytest.raises(pl.SceneError, match=r"objects\[0\]\.mesh"):
        pl.load_scene(path)
