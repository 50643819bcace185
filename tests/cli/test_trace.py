"""`pellucid trace`: rays in, rays out, on the screen and in files."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from pellucid.cli.rays import COLUMNS

AHEAD = ("--origin", "0.01,0.02,1", "--direction", "0,0,-2")


def test_a_ray_straight_through_a_slab(pellucid, slab):
    said = pellucid("trace", slab, "--extent", "0.2", *AHEAD, "--ambient-n", "1.5")
    assert said.code == 0, said.err
    assert "left" in said.out and "-1.000000" in said.out


def test_a_mesh_bends_by_snells_law(pellucid, cube, tmp_path):
    """A ray that meets a plane-parallel cube at 45 degrees goes on in its direction, moved sideways."""
    out = tmp_path / "rays.json"
    said = pellucid("trace", cube, "--medium", "1.5", "--resolution", "48", "-o", out,
                    "--origin=0.1,0.5,1.2", "--direction", "1,0,-1")  # fmt: skip
    assert said.code == 0, said.err
    ray = {name: column[0] for name, column in json.loads(out.read_text()).items()}
    assert ray["status"] == "left"
    inside = np.arcsin(np.sin(np.pi / 4) / 1.5)
    moved = ray["x"] - 0.1 - (1.2 - ray["z"])  # against the straight ray, along x
    assert moved == pytest.approx(np.tan(inside) - 1.0, abs=0.02)
    assert [ray["dx"], ray["dy"], ray["dz"]] == pytest.approx([0.5**0.5, 0.0, -(0.5**0.5)], abs=0.01)


@pytest.mark.parametrize("suffix", ["csv", "npy", "json"])
def test_files_of_rays_come_back_with_names(pellucid, slab, tmp_path, suffix):
    rows = np.array([[0.0, 0.0, 1.0, 0.0, 0.0, -1.0], [5.0, 5.0, 5.0, 0.0, 1.0, 0.0]])
    np.save(tmp_path / "in.npy", rows)
    (tmp_path / "in.csv").write_text("x,y,z,dx,dy,dz\n" + "".join(",".join(map(str, r)) + "\n" for r in rows))
    for source in ("in.npy", "in.csv"):
        out = tmp_path / f"out.{suffix}"
        said = pellucid("trace", slab, "--extent", "0.2,0.2,0.2", "--rays", tmp_path / source, "-o", out)
        assert said.code == 0 and "2 rays" in said.out, said.err
        if suffix == "csv":
            table = list(csv.DictReader(out.open()))
            statuses, columns = [row["status"] for row in table], tuple(table[0])
        elif suffix == "npy":
            array = np.load(out)
            statuses, columns = array["status"].tolist(), array.dtype.names
        else:
            data = json.loads(out.read_text())
            statuses, columns = data["status"], tuple(data)
        assert statuses == ["left", "missed"] and columns == COLUMNS


BAD_RAYS = {
    "empty.csv": ("", "empty"),
    "names.csv": ("x,y,z,dx,dy,dz\n", "no rays"),
    "five.csv": ("1,2,3,4,5\n", "line 1"),
    "words.csv": ("1,2,3,4,5,6\na,b,c,d,e,f\n", "line 2"),
    "nan.csv": ("nan,0,1,0,0,-1\n", "NaN"),
    "still.csv": ("0,0,1,0,0,0\n", "length zero"),
    "damaged.npy": ("not numpy", "damaged"),
    "rays.txt": ("1,2,3,4,5,6\n", ".csv"),
}


@pytest.mark.parametrize("name", BAD_RAYS)
def test_rays_that_are_none(pellucid, slab, tmp_path, name):
    content, words = BAD_RAYS[name]
    (tmp_path / name).write_text(content)
    said = pellucid("trace", slab, "--extent", "0.2", "--rays", tmp_path / name, "-o", tmp_path / "out.csv")
    assert said.code == 1 and words in said.err.splitlines()[-1], said.err
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([name, "slab.npy"])


def test_a_volume_with_nan(pellucid, tmp_path):
    np.save(tmp_path / "nan.npy", np.full((4, 4, 4), np.nan))
    said = pellucid("trace", tmp_path / "nan.npy", "--extent", "1", *AHEAD)
    assert said.code == 1 and "nan.npy: has 64 values that are not finite" in said.err


def test_a_volume_of_the_wrong_shape(pellucid, tmp_path):
    np.save(tmp_path / "flat.npy", np.ones((4, 4)))
    said = pellucid("trace", tmp_path / "flat.npy", "--extent", "1", *AHEAD)
    assert said.code == 1 and "(4, 4)" in said.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--extent"),
        (("--extent", "0"), "lengths"),
        (("--extent", "1,2"), "lengths"),
        (("--extent", "1"), "--origin"),
        (("--extent", "1", "--origin", "0,0,0"), "--direction"),
        (("--extent", "1", *AHEAD, "--rays", "x.csv"), "not both"),
        (("--extent", "1", *AHEAD, "--medium", "F2"), "--medium"),
        (("--extent", "1", *AHEAD, "--ambient-n", "0"), "above 0"),
    ],
)
def test_a_call_that_is_incomplete_or_contradicts_itself(pellucid, slab, arguments, words):
    said = pellucid("trace", slab, *arguments)
    assert said.code == 2 and words in said.err, said.err


def test_an_output_of_unknown_kind_is_told_first(pellucid, slab, tmp_path):
    said = pellucid("trace", slab, "--extent", "1", *AHEAD, "-o", tmp_path / "out.xlsx")
    assert said.code == 1 and ".csv" in said.err and len(said.err.splitlines()) == 1
