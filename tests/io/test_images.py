"""Pictures: exact round trips, linear light, and errors that name the file."""

from __future__ import annotations

import errno
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError
from pellucid.io.images import read_image, srgb_to_linear, write_image

RNG = np.random.default_rng(7)
RADIANCE = (RNG.random((16, 32, 3)) * 20.0).astype(np.float32)
BYTES = RNG.integers(0, 256, (16, 32, 3), dtype=np.uint8)


def test_float_exr_comes_back_bit_by_bit(tmp_path: Path) -> None:
    write_image(tmp_path / "a.exr", RADIANCE)
    assert np.array_equal(read_image(tmp_path / "a.exr"), RADIANCE)


@pytest.mark.parametrize(("kind", "top"), [(np.uint8, 255), (np.uint16, 65535)])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_png_keeps_depth_channels_and_alpha(tmp_path: Path, kind: type, top: int, channels: int) -> None:
    pixels = RNG.integers(0, top + 1, (5, 9, channels)).astype(kind)
    write_image(tmp_path / "a.png", pixels)
    stored = read_image(tmp_path / "a.png", linear=True)
    assert np.array_equal(np.round(stored * top).astype(kind), pixels)


def test_hdr_keeps_the_precision_of_a_shared_exponent(tmp_path: Path) -> None:
    write_image(tmp_path / "a.hdr", RADIANCE)
    error = np.abs(read_image(tmp_path / "a.hdr") - RADIANCE)
    assert (error <= RADIANCE.max(axis=2, keepdims=True) / 128.0).all()  # 8 bits, the leading one may be the lowest


def test_half_exr_is_half_precision(tmp_path: Path) -> None:
    write_image(tmp_path / "a.exr", RADIANCE, half=True)
    assert np.array_equal(read_image(tmp_path / "a.exr"), RADIANCE.astype(np.float16).astype(np.float32))


def test_exr_holds_infinite_depth(tmp_path: Path) -> None:
    depth = np.array([[1.0, np.inf]], np.float32)
    write_image(tmp_path / "depth.exr", depth)
    assert np.array_equal(read_image(tmp_path / "depth.exr")[..., 0], depth)


def test_row_zero_is_the_top_in_every_format(tmp_path: Path) -> None:
    picture = np.zeros((4, 6, 3), np.float32)
    picture[0] = 1.0
    for name, pixels in (("a.exr", picture), ("a.hdr", picture), ("a.png", (picture * 255).astype(np.uint8))):
        write_image(tmp_path / name, pixels)
        assert read_image(tmp_path / name)[:, 0, 0].tolist() == [1.0, 0.0, 0.0, 0.0]


def test_integers_are_srgb_and_alpha_is_not(tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", np.full((2, 2, 4), 188, np.uint8))
    pixel = read_image(tmp_path / "a.png")[0, 0]
    # 188/255 decodes to 0.5029 (IEC 61966-2-1, the usual "half grey")
    assert pixel[:3] == pytest.approx(0.5029, abs=2e-4)
    assert pixel[3] == pytest.approx(188 / 255)


def test_the_decoding_curve_is_continuous_at_its_joint() -> None:
    below, above = srgb_to_linear(np.array([0.04045, np.nextafter(0.04045, 1.0)]))
    assert above - below == pytest.approx(0.0, abs=1e-7)
    assert srgb_to_linear(np.array([0.0, 1.0])).tolist() == [0.0, 1.0]


@pytest.mark.parametrize("suffix", [".png", ".exr", ".hdr", ".jpg", ".tiff"])
@pytest.mark.parametrize("keep", [0, 10, 0.5])
def test_a_cut_file_is_an_error_that_names_it(tmp_path: Path, suffix: str, keep: float) -> None:
    whole, cut = _whole(tmp_path, suffix).read_bytes(), tmp_path / f"cut{suffix}"
    cut.write_bytes(whole[: int(keep if keep >= 1 or keep == 0 else keep * len(whole))])
    with pytest.raises(AssetError, match=r"empty|truncated|not a picture") as caught:
        read_image(cut)
    assert caught.value.path == str(cut) and caught.value.remedy


def _whole(folder: Path, suffix: str) -> Path:
    """A picture in any format OpenImageIO writes, ours or not."""
    import OpenImageIO

    path = folder / f"whole{suffix}"
    spec = OpenImageIO.ImageSpec(32, 16, 3, "float" if suffix in (".exr", ".hdr") else "uint8")
    sink = OpenImageIO.ImageOutput.create(str(path))
    assert sink.open(str(path), spec) and sink.write_image(RADIANCE if suffix in (".exr", ".hdr") else BYTES)
    sink.close()
    return path


def test_missing_folder_text_and_odd_suffix(tmp_path: Path) -> None:
    (tmp_path / "sunset.png").write_text("not a picture")
    with pytest.raises(AssetError, match=r"did you mean 'sunset.png'"):
        read_image(tmp_path / "sunsett.png")
    with pytest.raises(AssetError, match="not a picture"):
        read_image(tmp_path / "sunset.png")
    with pytest.raises(AssetError, match="is a folder"):
        read_image(tmp_path)
    (tmp_path / "a.gltf").write_text("x")
    with pytest.raises(AssetError, match="suffix"):
        read_image(tmp_path / "a.gltf")


def test_five_channels_are_refused(tmp_path: Path) -> None:
    import OpenImageIO

    path = str(tmp_path / "a.exr")
    sink = OpenImageIO.ImageOutput.create(path)
    assert sink.open(path, OpenImageIO.ImageSpec(2, 2, 5, "float"))
    sink.write_image(np.zeros((2, 2, 5), np.float32))
    sink.close()
    with pytest.raises(AssetError, match="5 channels"):
        read_image(path)


@pytest.mark.parametrize(
    ("name", "array", "words"),
    [
        ("a.gif", BYTES, "suffix"),
        ("a", BYTES, "no suffix"),
        ("a.png", RADIANCE, "PNG cannot hold float32"),
        ("a.exr", BYTES, "linear floats"),
        ("a.hdr", RADIANCE[..., :2], "three finite"),
        ("a.hdr", -RADIANCE, "three finite"),
        ("a.hdr", RADIANCE * np.nan, "three finite"),
        ("a.exr", np.zeros((0, 3, 3), np.float32), "not a picture"),
        ("a.exr", np.zeros((2, 3, 5), np.float32), "not a picture"),
        ("a.exr", np.zeros(3, np.float32), "not a picture"),
        ("no/such/folder/a.exr", RADIANCE, "folder"),
    ],
)
def test_what_cannot_be_written_leaves_nothing(tmp_path: Path, name: str, array: np.ndarray, words: str) -> None:
    with pytest.raises(AssetError, match=words):
        write_image(tmp_path / name, array)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".png", ".exr", ".hdr"])
def test_a_full_disk_keeps_the_old_file_and_leaves_no_half(tmp_path: Path, suffix: str) -> None:
    target = tmp_path / f"a{suffix}"
    target.write_bytes(b"old")
    code = f"""
import resource, numpy as np
from pellucid.errors import AssetError
from pellucid.io.images import write_image
import OpenImageIO
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
pixels = np.random.default_rng(0).random((256, 256, 3)).astype(np.float32)
try:
    write_image({str(target)!r}, (pixels * 255).astype(np.uint8) if {suffix!r} == ".png" else pixels)
except AssetError as error:
    assert {str(target)!r} in str(error)
    print("refused")
"""
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] != 20000
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.stdout.strip() == "refused", run.stderr
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_read_only_file_system_is_an_error_in_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: Path, missing_ok: bool = False) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    def nothing(*_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "unlink", refuse)
    monkeypatch.setattr("pellucid.io.images._encode", nothing)
    with pytest.raises(AssetError, match="Read-only file system"):
        write_image(tmp_path / "a.png", np.zeros((2, 2, 3), np.uint8))
