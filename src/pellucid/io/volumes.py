"""Arrays of voxels from .npy and .npz; the header is judged before anything is loaded."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import IO, cast

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import existing_file, replacing, suffix_of

MAX_BYTES = 4 << 30
"""Largest array that is loaded, 1000 voxels cubed in float32."""
PREFERRED_NAMES = ("n", "volume", "data")


def read_volume(path: str | PathLike[str], *, name: str | None = None) -> np.ndarray:
    """Read an array of voxels.

    Parameters
    ----------
    path : .npy, or .npz holding one array or one called ``n``, ``volume`` or ``data``.
    name : which array of an .npz to take.

    Returns
    -------
    (Z, Y, X) or (Z, Y, X, C) float array, C-contiguous, in the byte order of this machine: float32 or
    float64 as stored; half floats and integers of up to 16 bits become float32, larger ones float64.

    Raises
    ------
    AssetError : missing, empty, truncated, holding Python objects, not numbers, wrong number of axes,
        larger than 4 GiB.
    """
    file = existing_file(path)
    if suffix_of(file, (".npy", ".npz"), "read as a volume") == ".npy":
        with _reported(file), file.open("rb") as stream:
            array = _read_npy(file, stream, available=file.stat().st_size, axes=(3, 4))
    else:
        with _reported(file), zipfile.ZipFile(file) as archive:
            member = archive.getinfo(_choose(file, archive.namelist(), name))
            array = _read_member(file, archive, member, axes=(3, 4))
    return _as_float(array)


def read_arrays(path: str | PathLike[str]) -> dict[str, np.ndarray]:
    """Every array of an .npz by name, with any number of axes, as floats or integers as stored.

    Raises
    ------
    AssetError : as :func:`read_volume`.
    """
    file = existing_file(path)
    suffix_of(file, (".npz",), "read as a set of arrays")
    with _reported(file), zipfile.ZipFile(file) as archive:
        return {info.filename.removesuffix(".npy"): _read_member(file, archive, info) for info in archive.infolist()}


def write_arrays(path: str | PathLike[str], arrays: Mapping[str, np.ndarray]) -> None:
    """Write named arrays to an .npz, whole or not at all.

    Raises
    ------
    AssetError : wrong suffix, missing folder, full disk.
    """
    file = Path(path)
    suffix_of(file, (".npz",), "written as a set of arrays")
    for name, array in arrays.items():
        if array.dtype.hasobject:
            raise AssetError(file, f"cannot hold the Python objects of {name!r}", "give plain numbers")
    with replacing(file) as part:
        np.savez(part, **arrays)  # type: ignore[arg-type]


@contextmanager
def _reported(file: Path) -> Iterator[None]:
    """Turns whatever NumPy and zipfile raise on damaged files into an AssetError."""
    try:
        yield
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, KeyError, NotImplementedError, SyntaxError) as error:
        raise AssetError(file, f"is damaged or not a NumPy file: {error}", "write it again with numpy.save") from error


def _choose(file: Path, members: list[str], name: str | None) -> str:
    arrays = [member.removesuffix(".npy") for member in members if member.endswith(".npy")]
    wanted = [name] if name else [*PREFERRED_NAMES, *(arrays if len(arrays) == 1 else [])]
    for candidate in wanted:
        if candidate in arrays:
            return f"{candidate}.npy"
    held = ", ".join(map(repr, arrays)) or "nothing"
    raise AssetError(file, f"has no array called {wanted[0]!r}; it holds {held}", "name the array to take")


def _read_member(
    file: Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo, axes: tuple[int, ...] | None = None
) -> np.ndarray:
    with archive.open(member) as stream:
        return _read_npy(file, stream, member.file_size, axes)


def _read_npy(file: Path, stream: IO[bytes], available: int, axes: tuple[int, ...] | None) -> np.ndarray:
    version = np.lib.format.read_magic(stream)
    read_header = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }.get(version)
    if read_header is None:
        raise AssetError(file, f"uses version {version} of the NumPy format", "save it again with numpy.save")
    shape, fortran, dtype = read_header(stream)
    _judge(file, shape, dtype, axes)
    needed = int(np.prod(shape, dtype=object)) * dtype.itemsize
    if available - stream.tell() < needed:
        raise AssetError(
            file, f"is truncated: {needed} bytes announced, {available - stream.tell()} there", "copy it again"
        )
    flat = np.frombuffer(stream.read(needed), dtype)
    return flat.reshape(shape, order="F" if fortran else "C")


def _judge(file: Path, shape: tuple[int, ...], dtype: np.dtype, axes: tuple[int, ...] | None) -> None:
    if dtype.hasobject:
        raise AssetError(file, "holds pickled Python objects, which are never loaded", "save plain numbers")
    if dtype.kind not in "fiu" or dtype.itemsize > 8:
        raise AssetError(file, f"holds {dtype}, not real numbers", "convert it to float32")
    if axes and len(shape) not in axes:
        raise AssetError(file, f"has {len(shape)} axes, shape {shape}", "a volume is (Z, Y, X) or (Z, Y, X, channels)")
    if 0 in shape:
        raise AssetError(file, f"holds no voxels, shape {shape}", "save it again")
    size = int(np.prod(shape, dtype=object)) * dtype.itemsize
    if size > MAX_BYTES:
        raise AssetError(file, f"holds {size / 2**30:.1f} GiB, shape {shape}", "crop or resample it below 4 GiB")


def _as_float(array: np.ndarray) -> np.ndarray:
    kind, size = array.dtype.kind, array.dtype.itemsize
    small = size <= 2 or (kind == "f" and size == 4)
    return cast(np.ndarray, np.ascontiguousarray(array, dtype=np.float32 if small else np.float64))
