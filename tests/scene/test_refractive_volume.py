"""Refractive volumes: every way to make one, where it stands, and slips that show before long work."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from pellucid import media
from pellucid.errors import AssetError, SceneError
from pellucid.fields.volume import Volume
from pellucid.scene import Mesh, Quality, RefractiveVolume

GRADED = 1.0 + 0.2 * np.random.default_rng(5).random((4, 5, 6)).astype(np.float32)
EXTENT = (0.6, 0.5, 0.4)


def ball(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    return np.sqrt(x * x + y * y + z * z) - 0.3


def world(thing: RefractiveVolume, point: tuple[float, float, float]) -> np.ndarray:
    return (thing.object_to_world() @ [*point, 1.0])[:3]


def test_a_mesh_off_centre_stays_where_its_file_says() -> None:
    box = Mesh.box(0.4)
    thing = RefractiveVolume.from_mesh((box.vertices + np.array([3.0, 1.0, -2.0]), box.faces), 1.5, resolution=16)
    assert thing.center_m == pytest.approx((3.0, 1.0, -2.0), abs=1e-6)
    assert world(thing, (0, 0, 0)) == pytest.approx((3.0, 1.0, -2.0), abs=1e-6)


def test_a_mesh_is_placed_about_the_origin_of_its_file() -> None:
    box = Mesh.box(0.4)
    thing = RefractiveVolume.from_mesh(
        (box.vertices + np.array([3.0, 0.0, 0.0]), box.faces),
        1.5,
        16,
        position=(0, 5, 0),
        rotation=(0, 0, 90),
        scale=2.0,
    )
    # T R S x_mesh: (3, 0, 0) -> (6, 0, 0) -> (0, 6, 0) -> (0, 11, 0)
    assert world(thing, (0, 0, 0)) == pytest.approx((0.0, 11.0, 0.0), abs=1e-5)
    # and its surface with it: the mesh's (3.2, 0, 0) lies 0.2 along x of the box
    assert world(thing, (0.2, 0, 0)) == pytest.approx((0.0, 11.4, 0.0), abs=1e-5)


def test_the_same_mesh_by_path_trimesh_arrays_and_object(tmp_path: Path) -> None:
    import trimesh

    solid = trimesh.creation.box((0.4, 0.3, 0.2))
    solid.export(tmp_path / "a.ply")
    pair = np.asarray(solid.vertices), np.asarray(solid.faces)
    sources = [tmp_path / "a.ply", str(tmp_path / "a.ply"), solid, pair, Mesh(*pair, position=(9, 9, 9))]
    things = [RefractiveVolume.from_mesh(source, "N-BK7", 12) for source in sources]
    for thing in things:
        assert thing.volume.regions[0].sdf == pytest.approx(things[0].volume.regions[0].sdf, abs=1e-6)
        assert thing.volume.regions[0].medium == media.get("N-BK7")
        assert thing.center_m == pytest.approx((0, 0, 0), abs=1e-7)


def test_the_other_ways_give_what_volume_gives() -> None:
    graded = RefractiveVolume.from_array(GRADED, EXTENT, ambient_n=1.05, boundary="smooth", scale=3.0)
    assert graded.volume.delta_n == pytest.approx(GRADED - 1.05, abs=1e-6) and graded.boundary == "smooth"
    field = RefractiveVolume.from_function(lambda x, y, z: 1.0 + x * x, 8, EXTENT)
    assert field.volume.shape == (5, 7, 8) or field.volume.shape[2] == 8
    solid = RefractiveVolume.from_sdf(ball, "water", 16, (0.8, 0.8, 0.8), position=(0, 1, 0))
    layered = RefractiveVolume.from_regions([(ball, 1.3), (lambda x, y, z: ball(x, y, z) - 0.05, 1.5)], 16, (0.8,) * 3)
    assert [len(t.volume.regions) for t in (solid, layered)] == [1, 2]
    assert RefractiveVolume.from_volume(solid.volume, scale=2.0).volume is solid.volume
    assert world(solid, (0, 0, 0)) == pytest.approx((0, 1, 0))


def test_volumes_are_values() -> None:
    thing = RefractiveVolume.from_array(GRADED, EXTENT)
    moved = thing.replace(position=(1, 2, 3), quality=thing.quality.replace(bounces=2))
    assert moved.volume is thing.volume and moved.quality.bounces == 2 and thing.quality == Quality()


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"boundary": "soft"}, "refractive_volume.boundary"),
        ({"scale": -1}, "refractive_volume.scale"),
        ({"position": (0, 0, np.nan)}, "refractive_volume.position[2]"),
        ({"rotation": 90}, "refractive_volume.rotation"),
        ({"dispersion": "on"}, "refractive_volume.dispersion"),
        ({"smoothing_voxels": -1}, "refractive_volume.smoothing_voxels"),
        ({"gradient": "prewitt"}, "refractive_volume.gradient"),
        ({"surroundings": "mirror"}, "refractive_volume.surroundings"),
        ({"quality": "high"}, "refractive_volume.quality"),
        ({"center_m": (0, 0)}, "refractive_volume.center_m"),
        ({"brdf": "ggx"}, "refractive_volume.brdf"),
        ({"gloss": 2.0}, "refractive_volume.gloss"),
        ({"proxy": "cylinder"}, "refractive_volume.proxy"),
        ({"proxy": 3}, "refractive_volume.proxy"),
    ],
)
def test_each_fault_names_its_field(changes: dict, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        RefractiveVolume.from_array(GRADED, EXTENT, **changes)
    assert caught.value.field == field
    with pytest.raises(SceneError) as caught:
        RefractiveVolume.from_array(GRADED, EXTENT).replace(**changes)
    assert caught.value.field == field


def test_a_slip_shows_before_the_mesh_is_voxelised(shared_data: Path) -> None:
    start = time.perf_counter()
    with pytest.raises(SceneError, match="boundary"):
        RefractiveVolume.from_mesh(shared_data / "bunny.ply", "N-BK7", 256, boundary="soft")
    with pytest.raises(SceneError, match="N-BK7"):
        RefractiveVolume.from_mesh(shared_data / "bunny.ply", "NBK-77", 256)
    with pytest.raises(SceneError, match="posiition: is not a field"):
        RefractiveVolume.from_mesh(shared_data / "bunny.ply", "N-BK7", 256, posiition=(0, 0, 0))
    assert time.perf_counter() - start < 1.0  # neither read nor voxelised


def test_what_is_no_mesh_or_no_volume_says_so(tmp_path: Path) -> None:
    with pytest.raises(AssetError, match="does not exist"):
        RefractiveVolume.from_mesh(tmp_path / "a.ply", "N-BK7")
    for wrong in (3, (np.zeros((3, 3)),), [[1, 2], [3, 4]], (np.zeros((3, 3)), [[0, 1, 9]])):
        with pytest.raises(SceneError, match=r"refractive_volume\.mesh"):
            RefractiveVolume.from_mesh(wrong, "N-BK7")
    with pytest.raises(SceneError, match=r"refractive_volume.volume: cannot be 'ndarray'"):
        RefractiveVolume(GRADED)  # type: ignore[arg-type]
    with pytest.raises(SceneError):
        RefractiveVolume.from_array(GRADED * np.nan, EXTENT)
    assert isinstance(RefractiveVolume.from_array(GRADED, EXTENT).volume, Volume)
