"""Meshes written as OBJ with their materials and pictures, as most 3-D programs read them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import replacing, suffix_of
from pellucid.io.images import linear_to_srgb, write_image
from pellucid.io.meshes import MeshData

DIGITS = 7
"""Of every number: as many as single precision has."""


def write_obj(path: str | PathLike[str], parts: Sequence[MeshData]) -> None:
    """Write meshes as one .obj, an .mtl and a .png for each map beside it; a material is named after its part.

    Parameters
    ----------
    path : .obj.
    parts : names that differ, of letters, digits, hyphens and underscores.

    Raises
    ------
    AssetError : another suffix, no parts, names that cannot stand in the file, missing folder, full disk.
    """
    file = Path(path)
    suffix_of(file, (".obj",), "written as OBJ")
    names = [part.name for part in parts]
    if not names or len(set(names)) < len(names):
        raise AssetError(file, f"needs parts with names that differ, got {names}", "give each MeshData a name")
    odd = [name for name in names if not name.replace("-", "").replace("_", "").isalnum()]
    if odd:
        raise AssetError(file, f"cannot hold the name {odd[0]!r}", "use letters, digits, hyphens and underscores")
    with replacing(file) as to, to.open("w", encoding="utf-8") as out:
        out.write(f"mtllib {file.stem}.mtl\n")
        first = np.ones(3, np.int64)  # the numbers of the next v, vt and vn
        for part in parts:
            out.writelines(_lines(part, first))
            first += [len(array) if array is not None else 0 for array in (part.vertices, part.uvs, part.normals)]
    with replacing(file.with_suffix(".mtl")) as to:
        to.write_text("".join(_material(part, file) for part in parts), encoding="utf-8")


def _lines(part: MeshData, first: np.ndarray) -> Iterable[str]:
    yield f"usemtl {part.name}\n"
    for word, array in (("v", part.vertices), ("vt", part.uvs), ("vn", part.normals)):
        if array is not None:
            row = word + f" %.{DIGITS}g" * array.shape[1] + "\n"
            yield from (row % tuple(values) for values in array.tolist())
    kinds = [0] + [1] * (part.uvs is not None) + [2] * (part.normals is not None)
    corner = {1: "%d", 2: "%d/%d" if part.uvs is not None else "%d//%d", 3: "%d/%d/%d"}[len(kinds)]
    row = f"f {corner} {corner} {corner}\n"
    numbered = np.asarray(part.faces, np.int64)[:, :, None] + first[kinds]
    yield from (row % tuple(face) for face in numbered.reshape(len(numbered), -1).tolist())


def _material(part: MeshData, file: Path) -> str:
    words = f"newmtl {part.name}\n"
    if part.base_color is not None:
        words += "Kd {:.6g} {:.6g} {:.6g}\n".format(*part.base_color)
    if part.base_color_map is not None:
        picture = file.with_name(f"{file.stem}_{part.name}.png")
        encoded = linear_to_srgb(np.clip(part.base_color_map[..., :3], 0.0, 1.0))
        write_image(picture, np.round(255.0 * encoded).astype(np.uint8))
        words += f"map_Kd {picture.name}\n"
    return words
