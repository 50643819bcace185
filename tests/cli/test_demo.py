"""`pellucid demo`, with a gallery of two small pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

import pellucid as pl


@dataclass(frozen=True)
class Still:
    name: str
    title: str
    build: Any
    you_should_see: str = "a grey ball"
    samples: int = 1
    time_s: float = 0.0


def scene() -> pl.Scene:
    return pl.Scene(pl.Camera((0, 0, 2)), objects=[pl.Mesh.sphere(0.4, 16)])


@pytest.fixture
def gallery(monkeypatch):
    def use(*pictures: Still) -> None:
        import pellucid.gallery

        monkeypatch.setattr(pellucid.gallery, "PICTURES", pictures)

    use(Still("first", "A first ball", scene), Still("second-ball", "A second ball", scene))
    return use


def names(folder) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_pictures_times_and_a_contact_sheet(pellucid, gallery, tmp_path):
    from pellucid.io.images import read_image

    out = tmp_path / "new" / "demo"
    said = pellucid("demo", "--output", out, "--size", "40x30")
    assert said.code == 0, said.err
    assert names(out) == ["01_first.png", "02_second-ball.png", "contact_sheet.png"]
    assert said.out.count("drawn in") == 3 and "A second ball" in said.out
    sheet = read_image(out / "contact_sheet.png")
    assert sheet.shape[1] > 800 and sheet.std() > 0.01


def test_only_one(pellucid, gallery, tmp_path):
    said = pellucid("demo", "-o", tmp_path, "--size", "8x8", "--only", "second-ball", "--samples", "2")
    assert said.code == 0 and names(tmp_path) == ["02_second-ball.png"]


def test_an_unknown_picture_suggests_one(pellucid, gallery, tmp_path):
    said = pellucid("demo", "-o", tmp_path, "--only", "second-bal")
    assert said.code == 1 and "did you mean second-ball" in said.err and names(tmp_path) == []


def test_ctrl_c_keeps_what_is_finished_and_says_what_is_not(pellucid, gallery, tmp_path):
    def interrupt() -> pl.Scene:
        raise KeyboardInterrupt

    gallery(Still("first", "A", scene), Still("second", "B", interrupt), Still("third", "C", scene))
    said = pellucid("demo", "-o", tmp_path, "--size", "8x8")
    assert said.code == 1 and names(tmp_path) == ["01_first.png"]
    last = said.err.splitlines()[-1]
    assert "1 of 3" in last and "second, third" in last


@pytest.mark.parametrize("folder", ["file", "/proc/pellucid"])
def test_a_folder_that_cannot_be_made(pellucid, gallery, tmp_path, folder):
    (tmp_path / "file").touch()
    said = pellucid("demo", "-o", tmp_path / folder, "--size", "8x8")
    assert said.code == 1 and said.err.startswith("error: ") and len(said.err.splitlines()) == 1


@pytest.mark.parametrize("size", ["0x0", "100000x100000", "big"])
def test_a_size_that_is_none(pellucid, gallery, tmp_path, size):
    said = pellucid("demo", "-o", tmp_path, "--size", size)
    assert said.code == 2 and names(tmp_path) == []
