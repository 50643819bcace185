"""Triangle meshes from OBJ, PLY, STL and glTF, read through trimesh and checked before anyone uses them."""

from __future__ import annotations

import io
import logging
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pellucid.errors import AssetError
from pellucid.io.files import existing_file, suffix_of
from pellucid.io.images import decoded

READABLE = (".obj", ".ply", ".stl", ".glb", ".gltf")
MAX_FACES = 20_000_000


@dataclass(frozen=True, eq=False)
class MeshData:
    """Triangles as a file states them, in the file's own coordinates.

    Attributes
    ----------
    vertices : (V, 3) float64, metres (the number in the file is taken as metres).
    faces : (F, 3) int32 rows of `vertices`, counter-clockwise seen from outside.
    normals : (V, 3) float32 unit vectors, or None when the file has none.
    uvs : (V, 2) float32, (0, 0) at the lower left of the map, or None.
    base_color : (3,) linear Rec.709 of the material, or None. When several materials are merged it is
        their mean by number of faces.
    base_color_map : (H, W, 3 or 4) float32 linear, row 0 at the top, or None. Kept only when the whole
        mesh shares one map.
    name : the file's stem; of one of several parts, that of its material.
    missing : what the file names but could not be had, such as a picture; for each a sentence.
    """

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None = None
    uvs: np.ndarray | None = None
    base_color: tuple[float, float, float] | None = None
    base_color_map: np.ndarray | None = None
    name: str = ""
    missing: tuple[str, ...] = ()


def read_mesh(path: str | PathLike[str]) -> MeshData:
    """Read a mesh; the geometries of a file that holds several are placed as it says and merged.

    Parameters
    ----------
    path : .obj, .ply, .stl, .glb or .gltf.

    Raises
    ------
    AssetError : missing, empty, truncated, not a mesh, no faces, coordinates that are not finite,
        faces that point outside the vertices, zero extent, more than 20 million faces.
    """
    file, parts, missing = _parts(path)
    mesh = replace(_merged(parts, file.stem), missing=missing)
    _judge(file, mesh)
    return mesh


def read_meshes(path: str | PathLike[str]) -> list[MeshData]:
    """Read a mesh as its parts: one for each geometry and material of the file, in its order.

    What is missing stands in the first part.

    Parameters
    ----------
    path : as for :func:`read_mesh`, which merges the parts.

    Raises
    ------
    AssetError : as :func:`read_mesh`.
    """
    file, parts, missing = _parts(path)
    meshes = [_merged([part], part.name or file.stem) for part in parts]
    _judge(file, _merged(parts, file.stem))
    return [replace(meshes[0], missing=missing), *meshes[1:]]


def _parts(path: str | PathLike[str]) -> tuple[Path, list[_Part], tuple[str, ...]]:
    file = existing_file(path)
    suffix = suffix_of(file, READABLE, "read as a mesh")
    _judge_header(file, suffix)
    parts, missing = _triangle_parts(file, suffix)
    if not parts:
        raise AssetError(file, "holds no faces", "export triangles, not only points, lines or an empty scene")
    return file, parts, missing


def _judge_header(file: Path, suffix: str) -> None:
    """Refuses what the header already shows to be too large or cut short, before it is loaded."""
    with file.open("rb") as stream:
        head = stream.read(4096)
    if suffix == ".ply":
        if not head.startswith(b"ply"):
            raise AssetError(file, "is not a PLY file: it does not begin with 'ply'", "export it again")
        announced = re.search(rb"element\s+face\s+(\d+)", head)
        _refuse_many_faces(file, int(announced[1]) if announced else 0)
    if suffix == ".stl" and not head.lstrip().lower().startswith(b"solid"):
        if len(head) < 84:
            raise AssetError(file, "is truncated: shorter than an STL header", "export or copy it again")
        faces = struct.unpack_from("<I", head, 80)[0]
        if file.stat().st_size < 84 + 50 * faces:
            raise AssetError(file, f"is truncated or not an STL file: {faces} faces announced", "export it again")
        _refuse_many_faces(file, faces)
    if suffix == ".obj" and b"\0" in head:
        raise AssetError(file, "is not an OBJ file: it holds bytes that are no text", "export it again")
    if suffix == ".glb" and not head.startswith(b"glTF"):
        raise AssetError(file, "is truncated or not a GLB file: it does not begin with 'glTF'", "export it again")
    if suffix == ".gltf" and not head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{"):
        raise AssetError(file, "is truncated or not a glTF file: it does not begin with '{'", "export it again")


def _refuse_many_faces(file: Path, faces: int) -> None:
    if faces > MAX_FACES:
        raise AssetError(file, f"has {faces:,} faces, more than {MAX_FACES:,}", "decimate it first")


class _Part(NamedTuple):
    """One geometry of a file and its place in the file's scene, (4, 4)."""

    mesh: Any
    placement: np.ndarray
    name: str = ""

    def vertices(self) -> np.ndarray:
        with np.errstate(invalid="ignore"):  # a vertex at infinity is reported, not warned about
            return np.asarray(self.mesh.vertices, np.float64) @ self.placement[:3, :3].T + self.placement[:3, 3]

    def faces(self) -> np.ndarray:
        mirrored = np.linalg.det(self.placement[:3, :3]) < 0.0
        faces = np.asarray(self.mesh.faces)
        return faces[:, ::-1] if mirrored else faces

    def normals(self) -> np.ndarray | None:
        stored = _stored_normals(self.mesh)
        if stored is None:
            return None
        turned = stored @ np.linalg.inv(self.placement[:3, :3])
        return np.asarray(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def _triangle_parts(file: Path, suffix: str) -> tuple[list[_Part], tuple[str, ...]]:
    """The geometries of the file that have faces, and what the file names but could not be had."""
    import trimesh

    log = logging.getLogger("trimesh")
    was_disabled, log.disabled = log.disabled, True  # what matters is raised below; the rest only alarms
    try:
        loaded, missing = _loaded(file)
        placed = [(str(loaded.graph[node][1]), loaded.graph[node][0]) for node in loaded.graph.nodes_geometry]
        parts = [_Part(loaded.geometry[name], np.asarray(matrix, np.float64), name) for name, matrix in placed]
        parts = [part for part in parts if isinstance(part.mesh, trimesh.Trimesh) and len(part.mesh.faces)]
        if suffix == ".stl":  # the format has no shared vertices at all
            for part in parts:
                part.mesh.merge_vertices()
    except Exception as error:  # trimesh lets whatever its parsers meet come through
        reason = f"is truncated or not {suffix[1:].upper()}: {type(error).__name__}: {error}"
        raise AssetError(file, reason, "open and export it again in a 3-D program") from error
    finally:
        log.disabled = was_disabled
    return (_in_order(parts, _named(_as_utf8(file.read_bytes()), "usemtl")) if suffix == ".obj" else parts), missing


def _in_order(parts: Sequence[_Part], used: list[str]) -> list[_Part]:
    """The parts of an OBJ, which trimesh gives in no order, in that of their materials; named after them.

    Where the look is unknown trimesh fills in a material and a grey picture of its own; they are taken away.
    """
    named = []
    for part in parts:
        material: Any = getattr(part.mesh.visual, "material", None)
        name = getattr(material, "name", None)
        if name not in used and hasattr(material, "image"):
            material.image = None
        named.append(part._replace(name=name if name in used else ""))
    return sorted(named, key=lambda part: used.index(part.name) if part.name else len(used))


def _loaded(file: Path) -> tuple[Any, tuple[str, ...]]:
    """The file as a trimesh scene. Older programs write names and remarks in Latin-1, where trimesh gives up."""
    import trimesh
    from trimesh.resolvers import FilePathResolver

    missing: list[str] = []
    defined: list[str] = []

    class Beside(FilePathResolver):
        def get(self, name: str) -> bytes:
            try:
                content = bytes(super().get(_file_in(name)))
                if file.suffix.lower() == ".obj" and not name.lower().endswith(".mtl"):
                    _decode_all(content)
            except (OSError, SyntaxError) as error:  # what a damaged picture raises
                why = "is not there" if isinstance(error, FileNotFoundError) else "is no picture that can be read"
                missing.append(f"{_file_in(name)!r} {why}")
                raise
            if not name.lower().endswith(".mtl"):
                return content
            content = _as_utf8(content)
            defined.extend(_named(content, "newmtl"))
            return content

    content = file.read_bytes()
    match file.suffix.lower():
        case ".obj":
            content = _as_utf8(content)
        case ".ply":
            header, end, body = content.partition(b"end_header")
            content = _as_utf8(header) + end + body
        case ".stl" if content[:80].lstrip().lower().startswith(b"solid") and b"\0" not in content[:4096]:
            content = _as_utf8(content)
    resolver = Beside(str(file))
    scene = trimesh.load_scene(io.BytesIO(content), file_type=file.suffix[1:].lower(), resolver=resolver, process=False)
    used = _named(content, "usemtl") if defined else []
    unknown = [name for name in used if name not in defined]
    missing += [f"the material {name!r} is in none of its .mtl files" for name in unknown]
    return scene, tuple(dict.fromkeys(missing))


def _named(text: bytes, keyword: str) -> list[str]:
    """The names that stand after a keyword of an OBJ or its materials, in their order."""
    names = re.findall(rf"^\s*{keyword}[ \t]+(\S.*)$", text.decode("utf-8", "replace"), re.MULTILINE)
    return list(dict.fromkeys(name.strip() for name in names))


def _file_in(words: str) -> str:
    """The name of a file out of what an .mtl says: after options such as ``-s 2 2 1``, slashes as everywhere."""
    name = words.strip().replace("\\", "/")
    return name.split()[-1] if name.startswith("-") else name


def _decode_all(picture: bytes) -> None:
    """Raises what is wrong with a picture; read by halves it would be found only when the map is needed."""
    from PIL import Image

    with Image.open(io.BytesIO(picture)) as image:
        image.load()


def _as_utf8(content: bytes) -> bytes:
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1").encode("utf-8")
    return content


def _merged(parts: Sequence[_Part], name: str) -> MeshData:
    offsets = np.cumsum([0] + [len(part.mesh.vertices) for part in parts[:-1]])
    colors, maps = zip(*(_material(part.mesh) for part in parts), strict=True)
    weights = [len(part.mesh.faces) for part in parts]
    known = [(color, weight) for color, weight in zip(colors, weights, strict=True) if color is not None]
    base = np.average([c for c, _ in known], axis=0, weights=[w for _, w in known]) if known else None
    shared = maps[0] if all(image is maps[0] for image in maps) else None
    return MeshData(
        vertices=np.concatenate([part.vertices() for part in parts]),
        faces=np.concatenate([p.faces() + o for p, o in zip(parts, offsets, strict=True)]).astype(np.int32),
        normals=_stacked([part.normals() for part in parts]),
        uvs=_stacked([_stored_uvs(part.mesh) for part in parts]),
        base_color=None if base is None else (float(base[0]), float(base[1]), float(base[2])),
        base_color_map=None if shared is None else _linear_map(shared),
        name=name,
    )


def _stacked(arrays: Sequence[np.ndarray | None]) -> np.ndarray | None:
    present = [array for array in arrays if array is not None]
    return np.concatenate(present).astype(np.float32) if len(present) == len(arrays) else None


def _stored_normals(part: Any) -> np.ndarray | None:
    """Vertex normals that came from the file; trimesh would make up its own when asked."""
    if "vertex_normals" not in part._cache.cache:
        return None
    normals = np.asarray(part.vertex_normals, np.float64)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    if normals.shape != part.vertices.shape or not np.isfinite(normals).all() or (length < 1e-6).any():
        return None
    return normals / length


def _stored_uvs(part: Any) -> np.ndarray | None:
    uvs = getattr(part.visual, "uv", None)
    if uvs is None or np.asarray(uvs).shape != (len(part.vertices), 2) or not np.isfinite(uvs).all():
        return None
    return np.asarray(uvs)


def _material(part: Any) -> tuple[np.ndarray | None, Any]:
    """Linear base colour (None when the file says nothing) and the map as trimesh holds it."""
    material = getattr(part.visual, "material", None)
    if material is None or part.visual.kind != "texture":
        return None, None
    image = getattr(material, "baseColorTexture", None)
    image = getattr(material, "image", None) if image is None else image
    if not type(image).__module__.startswith("PIL."):  # without Pillow trimesh leaves an object that only raises
        image = None
    factor = getattr(material, "baseColorFactor", None)
    if factor is not None:  # glTF states factors in linear light, trimesh keeps them as bytes
        return np.asarray(factor, np.float64)[:3] / (255.0 if np.asarray(factor).dtype == np.uint8 else 1.0), image
    # trimesh fills in a grey of its own for `diffuse`; only "kd" tells that the file gave one (linear)
    diffuse = (getattr(material, "kwargs", None) or {}).get("kd")
    known = diffuse is not None and np.asarray(diffuse).shape == (3,)
    return np.clip(np.asarray(diffuse, np.float64), 0.0, 1.0) if known else None, image


def _linear_map(image: Any) -> np.ndarray:
    mode = "RGBA" if "A" in image.getbands() else "RGB"
    return decoded(np.asarray(image.convert(mode), np.uint8))


def _judge(file: Path, mesh: MeshData) -> None:
    _refuse_many_faces(file, len(mesh.faces))
    bad = np.count_nonzero(~np.isfinite(mesh.vertices).all(axis=1))
    if bad:
        raise AssetError(file, f"{bad} of {len(mesh.vertices)} vertices are not finite numbers", "export it again")
    if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices):
        raise AssetError(file, "has faces that name vertices it does not hold", "it may be cut short; export it again")
    used = mesh.vertices[np.unique(mesh.faces)]
    extent = np.ptp(used, axis=0)
    if not extent.max() > 0.0:
        raise AssetError(file, "has no extent: all its vertices coincide", "check the scale it was exported with")
