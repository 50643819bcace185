"""Rays in files: where they start, and where they ended."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import existing_file, replacing, suffix_of

if TYPE_CHECKING:
    from pellucid.techniques.eikonal.trace import Rays

READABLE = (".csv", ".npy")
WRITABLE = (".csv", ".npy", ".json")
COLUMNS = (
    "x", "y", "z", "dx", "dy", "dz", "optical_path_m",
    "transmittance_r", "transmittance_g", "transmittance_b", "status", "steps", "n",
)  # fmt: skip


def read_rays(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions, (N, 3) each, from rows of x, y, z, dx, dy, dz.

    Parameters
    ----------
    path : .csv, with or without a line of names, or .npy of shape (N, 6).

    Raises
    ------
    AssetError : missing, empty, not numbers, not six columns.
    """
    file = existing_file(path)
    rows = _read_npy(file) if suffix_of(file, READABLE, "read as rays") == ".npy" else _read_csv(file)
    if rows.ndim != 2 or rows.shape[1] != 6 or not len(rows):
        raise AssetError(file, f"holds an array of shape {rows.shape}", "a row is x, y, z, dx, dy, dz")
    return rows[:, :3], rows[:, 3:]


def write_rays(path: Path, rays: Rays) -> None:
    """Write where rays ended: .csv with names on top, .npy with named fields, .json by column. Whole or not at all."""
    table = as_table(rays)
    with replacing(path) as part:
        if path.suffix.lower() == ".npy":
            np.save(part, table)
        elif path.suffix.lower() == ".json":
            part.write_text(json.dumps({name: table[name].tolist() for name in COLUMNS}, indent=1) + "\n", "utf-8")
        else:
            with part.open("w", newline="", encoding="utf-8") as stream:
                csv.writer(stream, lineterminator="\n").writerows([COLUMNS, *table.tolist()])


def as_table(rays: Rays) -> np.ndarray:
    """(N,) structured array with the fields of `COLUMNS`."""
    columns: list[Any] = [*rays.position.T, *rays.direction.T, rays.optical_path, *rays.transmittance.T]
    kinds = ["f8"] * len(columns) + ["U9", "i8", "f8"]
    table = np.empty(len(rays), list(zip(COLUMNS, kinds, strict=True)))
    for name, values in zip(COLUMNS, [*columns, rays.status, rays.steps, rays.index], strict=True):
        table[name] = values
    return table


def _read_npy(file: Path) -> np.ndarray:
    try:
        rows = np.load(file, allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
        raise AssetError(file, f"is damaged or not a NumPy file: {error}", "write it with numpy.save") from None
    if not isinstance(rows, np.ndarray) or rows.dtype.kind not in "fiu":
        raise AssetError(file, "does not hold real numbers", "save an array of shape (N, 6)")
    return rows.astype(np.float64)


def _read_csv(file: Path) -> np.ndarray:
    rows: list[list[float]] = []
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            for line, cells in enumerate(csv.reader(stream), start=1):
                row = _numbers(cells)
                if row is None and rows:
                    raise AssetError(file, f"line {line}: {','.join(cells)!r} is not six numbers", "correct it there")
                if row is not None and len(row) != 6:
                    raise AssetError(file, f"line {line} has {len(row)} numbers", "a row is x, y, z, dx, dy, dz")
                if row:
                    rows.append(row)
    except (UnicodeDecodeError, csv.Error) as error:
        raise AssetError(file, f"is not a table of text: {error}", "save it as CSV") from None
    if not rows:
        raise AssetError(file, "holds no rays", "a row is x, y, z, dx, dy, dz")
    return np.array(rows)


def _numbers(cells: list[str]) -> list[float] | None:
    """The row as numbers; None for names, comments and empty lines."""
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        return None
