"""`pellucid animate`: frames that go on where they stopped, and films of them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import pellucid as pl

SCENE = """
[camera]
position = [0, 0.3, 2]
[environment]
kind = "constant"
rgb = 0.05
[[lights]]
type = "directional"
direction = [0, -1, -1]
[[objects]]
type = "mesh"
kind = "box"
size_m = [0.8, 0.3, 0.1]
"""
QUICK = ("--size", "24x16", "--samples", "1")


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "box.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def animate(pellucid, scene, tmp_path):
    def run(*more, folder="out", frames=3, source=None):
        return pellucid("animate", source or scene, "-o", tmp_path / folder, "--frames", frames, *QUICK, *more)

    return run


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def pixels(path: Path) -> np.ndarray:
    from pellucid.io.images import read_image

    return read_image(path)


def interrupted_at(monkeypatch, number: int) -> list[int]:
    """Press ctrl-C while picture `number` is drawn; the list counts pictures."""
    real, drawn = pl.Renderer.render, []

    def render(self, *arguments, **options):
        drawn.append(len(drawn))
        if len(drawn) == number:
            raise KeyboardInterrupt
        return real(self, *arguments, **options)

    monkeypatch.setattr(pl.Renderer, "render", render)
    return drawn


def test_frames_are_numbered_and_say_what_they_were_made_with(animate, tmp_path):
    said = animate("--orbit", "90")
    assert said.code == 0, said.err
    out = tmp_path / "out"
    assert names(out) == ["animation.json", "frame_0000.png", "frame_0001.png", "frame_0002.png"]
    first, second, third = (pixels(out / f"frame_000{i}.png") for i in range(3))
    assert first.shape == (16, 24, 3) and first.std() > 0.02
    assert np.abs(first - second).max() > 0.05 and np.abs(second - third).max() > 0.05
    written = json.loads((out / "animation.json").read_text())
    assert written["size"] == [24, 16] and written["orbit_deg"] == 90.0 and written["scene"] == "box.toml"
    assert "3 frames in" in said.out


def test_the_first_frame_is_the_scene_as_it_stands_and_a_full_turn_closes(pellucid, animate, scene, tmp_path):
    animate("--orbit", "360", "--light-orbit", "-360", frames=2)
    pellucid("render", scene, "-o", tmp_path / "still.png", *QUICK)
    still = pixels(tmp_path / "still.png")
    np.testing.assert_array_equal(pixels(tmp_path / "out" / "frame_0000.png"), still)
    half = pixels(tmp_path / "out" / "frame_0001.png")
    # Box and light turned by half a turn under the camera: its back, from the front of which light comes.
    np.testing.assert_allclose(half, still, atol=2.5 / 255)


def test_the_light_moves_and_the_camera_does_not(animate, tmp_path):
    assert animate("--light-orbit", "180", frames=2).code == 0
    lit, dark = (pixels(tmp_path / "out" / f"frame_000{i}.png") for i in range(2))
    assert lit.max() > dark.max() + 0.05
    outline = [image.mean(axis=-1) > 0.3 for image in (lit, dark)]
    np.testing.assert_array_equal(lit[0], dark[0])
    assert outline[0].sum() >= outline[1].sum()


def test_ctrl_c_keeps_frames_and_the_same_command_goes_on(animate, monkeypatch, tmp_path):
    with monkeypatch.context() as patch:
        interrupted_at(patch, 3)
        said = animate("--orbit", "90", frames=4)
    assert said.code == 1 and "2 of 4 frames" in said.err and "the same command goes on" in said.err
    assert names(tmp_path / "out") == ["animation.json", "frame_0000.png", "frame_0001.png"]
    before = (tmp_path / "out" / "frame_0000.png").stat().st_mtime_ns
    drawn = interrupted_at(monkeypatch, 99)
    said = animate("--orbit", "90", frames=4)
    assert said.code == 0 and "2 of them from before" in said.out and len(drawn) == 2
    assert (tmp_path / "out" / "frame_0000.png").stat().st_mtime_ns == before


def test_frames_of_other_settings_are_neither_mixed_nor_lost(animate, scene, tmp_path):
    assert animate().code == 0
    said = animate("--orbit", "10")
    assert said.code == 1 and "orbit_deg 0.0 instead of 10.0" in said.err and "overwrite" in said.err
    scene.write_text(SCENE.replace("0.05", "0.06"))
    assert "scene_sha256" in animate().err
    said = animate("--orbit", "10", "--overwrite", frames=2)
    assert said.code == 0
    assert names(tmp_path / "out") == ["animation.json", "frame_0000.png", "frame_0001.png"]


def test_a_folder_with_frames_of_who_knows_what(animate, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "frame_0000.png").write_bytes(b"mine")
    said = animate()
    assert said.code == 1 and "no animation.json" in said.err
    assert (tmp_path / "out" / "frame_0000.png").read_bytes() == b"mine"


def test_a_manifest_that_is_broken(animate, tmp_path):
    assert animate().code == 0
    (tmp_path / "out" / "animation.json").write_text("{")
    said = animate()
    assert said.code == 1 and "animation.json" in said.err
    assert animate("--overwrite").code == 0


def test_part_of_the_frames(animate, tmp_path):
    assert animate("--only", "2:", frames=4).code == 0
    assert names(tmp_path / "out") == ["animation.json", "frame_0002.png", "frame_0003.png"]
    assert animate("--only", ":1", frames=4).code == 0
    said = animate(frames=4)
    assert said.code == 0 and "3 of them from before" in said.out


def test_overwrite_draws_again(animate, monkeypatch):
    assert animate().code == 0
    drawn = interrupted_at(monkeypatch, 99)
    assert animate("--overwrite").code == 0 and len(drawn) == 3


def test_a_picture_of_the_gallery(pellucid, monkeypatch, tmp_path):
    from pellucid.gallery import Picture

    def build() -> pl.Scene:
        lamp = pl.PointLight((0, 1, 1))
        return pl.Scene(pl.Camera((0, 0, 2)), lights=[lamp], objects=[pl.Mesh.sphere(0.4, 16)])

    picture = Picture("ball", "A ball", "a ball", build, samples=2)
    monkeypatch.setattr("pellucid.gallery.PICTURES", (picture,))
    said = pellucid("animate", "ball", "--light-orbit", "90", "--frames", "2", "--size", "8x8", "-o", tmp_path / "out")
    assert said.code == 0, said.err
    assert json.loads((tmp_path / "out" / "animation.json").read_text())["samples"] == 2
    said = pellucid("animate", "bal", "-o", tmp_path / "out")
    assert said.code == 1 and "did you mean ball" in said.err


@pytest.mark.parametrize(
    "wrong",
    [
        ("--frames", "0"),
        ("--frames", "-3"),
        ("--fps", "0"),
        ("--fps", "nan"),
        ("--size", "100000x10"),
        ("--orbit", "nan"),
        ("--light-orbit", "inf"),
        ("--light-orbit", "left"),
        ("--only", "3"),
        ("--only", "a:b"),
        ("--samples", "0"),
    ],
)
def test_what_is_not_understood(pellucid, scene, tmp_path, wrong):
    said = pellucid("animate", scene, "-o", tmp_path / "out", *wrong)
    assert said.code == 2 and not (tmp_path / "out").exists(), said.err


@pytest.mark.parametrize("span", ["2:1", "0:9", "3:", "1:1"])
def test_frames_that_are_not_there(animate, span):
    said = animate("--only", span)
    assert said.code == 1 and "--only" in said.err and "0 to 2" in said.err


def test_a_folder_that_is_a_file_and_a_scene_that_is_none(animate, cube, tmp_path):
    (tmp_path / "file").write_text("x")
    for said in (
        animate(folder="file"),
        animate(source=tmp_path / "missing.toml"),
        animate(source=cube),
        animate("--video", tmp_path / "film.avi"),
        animate("--video", tmp_path / "nowhere" / "film.mp4"),
    ):
        assert said.code == 1 and said.err.startswith("error: ") and len(said.err.splitlines()) == 1


def test_a_light_that_is_not_there_cannot_move(animate, scene):
    scene.write_text(SCENE[: SCENE.index("[[lights]]")])
    said = animate("--light-orbit", "90")
    assert said.code == 1 and "--light-orbit" in said.err and "no lamp" in said.err


def test_a_full_disk_is_said_and_leaves_no_half_frame(animate, monkeypatch, tmp_path):
    import errno
    import os

    real = os.replace

    def full(source, target):
        if str(target).endswith("frame_0001.png"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(source, target)

    monkeypatch.setattr("os.replace", full)
    said = animate()
    assert said.code == 1 and "No space left" in said.err and "Traceback" not in said.err
    assert names(tmp_path / "out") == ["animation.json", "frame_0000.png"]


def test_a_film_of_the_frames(animate, tmp_path):
    av = pytest.importorskip("av")
    film = tmp_path / "film.mp4"
    said = animate("--orbit", "90", "--fps", "12.5", "--video", film)
    assert said.code == 0 and "film.mp4" in said.out, said.err
    with av.open(str(film)) as container:
        stream = container.streams.video[0]
        assert float(stream.average_rate) == 12.5
        shown = [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)]
    assert len(shown) == 3 and shown[0].shape == (16, 24, 3)
    encoded = pl.optics.srgb_encode(pixels(tmp_path / "out" / "frame_0000.png"))
    assert np.abs(shown[0] / 255.0 - encoded).mean() < 0.02


def test_a_film_wants_all_frames(animate, tmp_path):
    pytest.importorskip("av")
    said = animate("--only", "0:1", "--video", tmp_path / "film.mp4")
    assert said.code == 1 and "2 are missing: frame_0001.png, frame_0002.png" in said.err
    assert not (tmp_path / "film.mp4").exists()


def test_a_film_without_its_package_says_what_to_install(animate, monkeypatch, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    said = animate("--video", tmp_path / "film.mp4")
    assert said.code == 1 and "pip install 'pellucid[video]'" in said.err
    assert not (tmp_path / "out").exists(), "said before any work"


def test_from_python(tmp_path):
    def swinging(time: float) -> pl.Scene:
        ball = pl.Mesh.sphere(0.3, 16, position=(0.5 * math.sin(time), 0.0, 0.0))
        return pl.Scene(pl.Camera((0, 0, 2)), objects=[ball])

    told: list[tuple[int, float]] = []
    settings = {"frames": 4, "fps": 2.0, "size": (16, 12), "samples": 1}
    paths = pl.animate(swinging, tmp_path / "swing", **settings, only=(1, 3), progress=lambda *p: told.append(p))
    assert [p.name for p in paths] == ["frame_0001.png", "frame_0002.png"] and all(p.exists() for p in paths)
    assert told[0] == (1, 0.0) and told[-1] == (2, 1.0)
    assert np.abs(pixels(paths[0]) - pixels(paths[1])).max() > 0.1
    with pytest.raises(pl.AssetError, match=r"samples 1 instead of 2"):
        pl.animate(swinging, tmp_path / "swing", **settings | {"samples": 2})


@pytest.mark.parametrize(
    "wrong",
    [{"frames": 0}, {"frames": 2.5}, {"fps": float("nan")}, {"only": (2, 1)}, {"only": (0, 9)}, {"size": (100000, 8)}],
)
def test_wrong_numbers_from_python(tmp_path, wrong):
    given = {"frames": 3, "size": (8, 8)} | wrong
    with pytest.raises(pl.SceneError):
        pl.animate(lambda time: pl.Scene(pl.Camera((0, 0, 2))), tmp_path / "out", **given)


def test_water_in_a_file_moves_from_where_it_is_told_to_start(pellucid, animate, tmp_path):
    waves = '[objects.waves]\nkind = "sine"\nwavelength_m = 1.0\namplitude_m = 0.05\ntile_m = 2.0\nshape = [16, 16]\n'
    pond = tmp_path / "pond.toml"
    pond.write_text(SCENE + '[[objects]]\ntype = "water"\nextent_m = 2.0\n' + waves)
    assert animate("--fps", "4", "--start", "0.5", source=pond, folder="late").code == 0
    first, second, third = (pixels(tmp_path / "late" / f"frame_000{i}.png") for i in range(3))
    assert not np.array_equal(first, second) and not np.array_equal(second, third)
    still = pellucid("render", pond, "-o", tmp_path / "still.png", *QUICK, "--time", "0.75")
    assert still.code == 0
    np.testing.assert_array_equal(pixels(tmp_path / "still.png"), second)
