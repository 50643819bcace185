"""Arrays of voxels: what comes in is what was saved, and what cannot be used says why."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest

from pellucid.errors import AssetError
from pellucid.io.volumes import read_arrays, read_volume, write_arrays

FIELD = np.random.default_rng(3).random((4, 5, 6)).astype(np.float32)


@pytest.mark.parametrize(
    ("dtype", "comes_back"),
    [
        ("<f4", np.float32),
        (">f4", np.float32),
        ("<f2", np.float32),
        ("u1", np.float32),
        ("<i2", np.float32),
        (">f8", np.float64),
        ("<i4", np.float64),
    ],
)
@pytest.mark.parametrize("order", ["C", "F"])
def test_values_survive_any_number_format(tmp_path: Path, dtype: str, comes_back: type, order: str) -> None:
    field = np.array(FIELD * 100, dtype=dtype, order=order)  # type: ignore[call-overload]
    np.save(tmp_path / "a.npy", field)
    read = read_volume(tmp_path / "a.npy")
    assert read.dtype == comes_back and read.flags.c_contiguous and read.dtype.isnative
    assert np.array_equal(read, field)


def test_npz_by_name_by_custom_and_alone(tmp_path: Path) -> None:
    np.savez(tmp_path / "one.npz", temperature=FIELD)
    np.savez_compressed(tmp_path / "two.npz", n=FIELD, other=FIELD * 2)
    np.savez(tmp_path / "odd.npz", a=FIELD, b=FIELD)
    assert np.array_equal(read_volume(tmp_path / "one.npz"), FIELD)
    assert np.array_equal(read_volume(tmp_path / "two.npz"), FIELD)
    assert np.array_equal(read_volume(tmp_path / "two.npz", name="other"), FIELD * 2)
    with pytest.raises(AssetError, match="holds 'a', 'b'"):
        read_volume(tmp_path / "odd.npz")


def test_the_shared_jet_is_read(shared_data: Path) -> None:
    assert read_volume(shared_data / "fuel_injection_64.npy").shape == (64, 64, 64)


@pytest.mark.parametrize(
    ("array", "words"),
    [
        (np.array([[[{}]]], object), "pickled"),
        (np.zeros((2, 2, 2), complex), "complex"),
        (np.zeros((2, 2, 2), bool), "bool"),
        (np.zeros((2, 2, 2), "U3"), "not real numbers"),
        (np.zeros((2, 2)), "2 axes"),
        (np.zeros((2,) * 5), "5 axes"),
        (np.zeros((2, 0, 2)), "no voxels"),
    ],
)
def test_what_is_not_a_volume_says_why(tmp_path: Path, array: np.ndarray, words: str) -> None:
    np.save(tmp_path / "a.npy", array, allow_pickle=True)
    np.savez(tmp_path / "a.npz", n=array)
    for name in ("a.npy", "a.npz"):
        with pytest.raises(AssetError, match=words) as caught:
            read_volume(tmp_path / name)
        assert caught.value.path.endswith(name)


@pytest.mark.parametrize("keep", [0, 3, 40, 200])
def test_a_cut_file_is_an_error(tmp_path: Path, keep: int) -> None:
    for name in ("a.npy", "a.npz"):
        np.savez(tmp_path / name, n=FIELD) if name == "a.npz" else np.save(tmp_path / name, FIELD)
        cut = tmp_path / ("cut_" + name)
        cut.write_bytes((tmp_path / name).read_bytes()[:keep])
        with pytest.raises(AssetError, match=r"empty|damaged|truncated"):
            read_volume(cut)


def test_a_huge_array_is_refused_by_its_header(tmp_path: Path) -> None:
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"shape": (4000,) * 3, "fortran_order": False, "descr": "<f4"})
    (tmp_path / "a.npy").write_bytes(stream.getvalue())
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("n.npy", stream.getvalue())
    for name in ("a.npy", "a.npz"):
        with pytest.raises(AssetError, match=r"238\.4 GiB"):
            read_volume(tmp_path / name)


def test_a_pickle_is_never_run(tmp_path: Path) -> None:
    (tmp_path / "a.npy").write_bytes(b"\x80\x04cos\nsystem\n(S'touch owned'\ntR.")
    with pytest.raises(AssetError, match="damaged or not a NumPy file"):
        read_volume(tmp_path / "a.npy")


def test_named_arrays_come_back_and_a_failure_leaves_nothing(tmp_path: Path) -> None:
    arrays = {"field": FIELD, "faces": np.arange(6, dtype=np.int32).reshape(2, 3)}
    write_arrays(tmp_path / "a.npz", arrays)
    read = read_arrays(tmp_path / "a.npz")
    assert all(np.array_equal(read[k], v) and read[k].dtype == v.dtype for k, v in arrays.items())
    with pytest.raises(AssetError, match="cannot hold the Python objects of 'n'"):
        write_arrays(tmp_path / "b.npz", {"n": np.array([{}], object)})
    assert [p.name for p in tmp_path.iterdir()] == ["a.npz"]
