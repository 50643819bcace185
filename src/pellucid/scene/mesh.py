"""Opaque things made of triangles."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pellucid.errors import AssetWarning, SceneError
from pellucid.scene import checks, shapes
from pellucid.scene.placement import Origin, SceneObject, check_placement, store

if TYPE_CHECKING:
    from pellucid.io.meshes import MeshData

GEOMETRY_FIELDS = ("vertices", "faces", "normals", "uvs")


@dataclass(frozen=True, eq=False)
class Mesh(SceneObject):
    """An opaque surface of triangles with a matt base and a glossy coat.

    Parameters
    ----------
    vertices : (V, 3) metres, before `scale`, `rotation` and `position`.
    faces : (F, 3) rows of `vertices`, counter-clockwise seen from outside.
    normals : (V, 3); worked out when None.
    uvs : (V, 2), (0, 0) at the lower left of the map; needed by a map.
    base_color : linear Rec.709, 0 to 1; multiplies the map.
    base_color_map : (H, W, 3 or 4) linear, sRGB when of uint8 or uint16; row 0 at the top.
    roughness : 0 mirror-like to 1 matt.
    specular : reflectance of the coat at normal incidence, 0 to 1; 0.04 is that of n = 1.5.
    emission : radiance it sends out by itself, >= 0.
    position, rotation, scale : metres, degrees about x, y, z in this order, one factor > 0.
    double_sided : also seen from the back.
    shading : ``"smooth"`` uses `normals`, or angle-weighted means of the faces when there are none;
        ``"flat"`` gives every face its own vertices and normal.
    origin : the recipe that scene files store; set by the class methods.

    After construction `normals` are always present, of unit length, and every array is read-only.

    Raises
    ------
    SceneError : wrong shapes, faces that name no vertex, values out of range or not finite.
    """

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None = None
    uvs: np.ndarray | None = None
    base_color: checks.Vector = (0.8, 0.8, 0.8)
    base_color_map: np.ndarray | None = None
    roughness: float = 0.6
    specular: float = 0.04
    emission: checks.Vector = (0.0, 0.0, 0.0)
    position: checks.Vector = (0.0, 0.0, 0.0)
    rotation: checks.Vector = (0.0, 0.0, 0.0)
    scale: float = 1.0
    double_sided: bool = True
    shading: str = "smooth"
    origin: Origin | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        store(
            self,
            **check_placement("mesh", self.position, self.rotation, self.scale),
            base_color=checks.color("mesh.base_color", self.base_color, high=1.0),
            roughness=checks.number("mesh.roughness", self.roughness, low=0.0, high=1.0),
            specular=checks.number("mesh.specular", self.specular, low=0.0, high=1.0),
            emission=checks.color("mesh.emission", self.emission),
            double_sided=checks.flag("mesh.double_sided", self.double_sided),
            shading=checks.choice("mesh.shading", self.shading, ("smooth", "flat")),
            base_color_map=_checked_map(self.base_color_map),
        )
        self._store_geometry()
        if self.base_color_map is not None and self.uvs is None:
            raise SceneError("mesh.uvs", "are needed by base_color_map", "give (V, 2) texture coordinates")

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed; new geometry has no recipe."""
        if any(name in changes for name in GEOMETRY_FIELDS):
            changes = {"origin": None} | changes
        return super().replace(**changes)

    @classmethod
    def load(cls, path: str | PathLike[str], **look: Any) -> Self:
        """A mesh from .obj, .ply, .stl, .glb or .gltf, with the base colour and map it brings along.

        Several materials become one, of their mean colour; :meth:`load_all` keeps them apart. What the file names but
        does not bring, such as a picture, is told by an AssetWarning.

        Parameters
        ----------
        look : any field but geometry, such as ``roughness=0.2`` or ``position=(0, 1, 0)``; it wins over
            what the file says.

        Raises
        ------
        AssetError : the file cannot be used. SceneError : a value out of range.
        """
        from pellucid.io.meshes import read_mesh

        return cls._of_file(path, read_mesh(path), {}, look)

    @classmethod
    def load_all(cls, path: str | PathLike[str], **look: Any) -> list[Self]:
        """The meshes of a file: one for each of its materials, each with its own colour and map.

        Parameters
        ----------
        look : any field but geometry, for all of them; it wins over what the file says.

        Raises
        ------
        AssetError : the file cannot be used. SceneError : a value out of range.
        """
        from pellucid.io.meshes import read_meshes

        return [cls._of_file(path, data, {"part": i}, look) for i, data in enumerate(read_meshes(path))]

    @classmethod
    def _of_file(cls, path: str | PathLike[str], data: MeshData, part: dict[str, int], look: dict[str, Any]) -> Self:
        if data.missing:
            remedy = "the faces concerned have one colour; put the file beside it, or give base_color"
            warnings.warn(AssetWarning(path, "; ".join(data.missing), remedy), stacklevel=3)
        own_map = None if data.uvs is None or data.base_color_map is None else _checked_map(data.base_color_map)
        found: dict[str, Any] = {"base_color_map": own_map}
        if data.base_color is not None:
            found["base_color"] = data.base_color
        elif own_map is not None:
            found["base_color"] = (1.0, 1.0, 1.0)
        origin = Origin({"file": str(Path(fspath(path)).resolve()), **part}, own_map)
        return cls(data.vertices, data.faces, data.normals, data.uvs, **(found | look), origin=origin)

    @classmethod
    def plane(cls, size_m: float | tuple[float, float] = 1.0, **look: Any) -> Self:
        """A rectangle in the plane y = 0 that faces +Y, `size_m` along x and z."""
        size = _sizes("mesh.size_m", size_m, 2)
        return cls(*shapes.plane(*size), **look, origin=Origin({"kind": "plane", "size_m": size}))

    @classmethod
    def box(cls, size_m: float | checks.Vector = 1.0, **look: Any) -> Self:
        """A box around the origin with edges `size_m` along x, y, z."""
        size = _sizes("mesh.size_m", size_m, 3)
        return cls(*shapes.box((size[0], size[1], size[2])), **look, origin=Origin({"kind": "box", "size_m": size}))

    @classmethod
    def sphere(cls, radius_m: float = 0.5, segments: int = 64, **look: Any) -> Self:
        """A sphere around the origin of `segments` (8 to 1024) faces round the equator."""
        radius = checks.number("mesh.radius_m", radius_m, low=0.0, exclusive=True, unit="metres")
        segments = checks.integer("mesh.segments", segments, low=8, high=1024)
        origin = Origin({"kind": "sphere", "radius_m": radius, "segments": segments})
        return cls(*shapes.sphere(radius, segments), **look, origin=origin)

    @classmethod
    def torus(cls, radius_m: float = 0.5, tube_m: float = 0.2, segments: int = 64, **look: Any) -> Self:
        """A ring around the y axis: the middle of its tube, of radius `tube_m`, goes round at `radius_m`.

        `segments` (8 to 1024) faces go round the axis, half as many round the tube.
        """
        radius = checks.number("mesh.radius_m", radius_m, low=0.0, exclusive=True, unit="metres")
        remedy = "the tube is thinner than the ring is wide"
        tube = checks.number("mesh.tube_m", tube_m, low=0.0, high=radius, exclusive=True, unit="metres", remedy=remedy)
        segments = checks.integer("mesh.segments", segments, low=8, high=1024)
        recipe = {"kind": "torus", "radius_m": radius, "tube_m": tube, "segments": segments}
        return cls(*shapes.torus(radius, tube, segments), **look, origin=Origin(recipe))

    @classmethod
    def checkerboard(
        cls,
        size_m: float | tuple[float, float] = 2.0,
        squares: int = 8,
        colors: tuple[checks.Vector, checks.Vector] = ((0.8, 0.8, 0.8), (0.08, 0.08, 0.08)),
        **look: Any,
    ) -> Self:
        """A plane with a chessboard of `squares` (1 to 256) fields along each side in two linear colours."""
        size = _sizes("mesh.size_m", size_m, 2)
        count = checks.integer("mesh.squares", squares, low=1, high=256)
        if not isinstance(colors, tuple | list) or len(colors) != 2:
            raise SceneError("mesh.colors", f"must be two colours, got {colors!r}")
        light, dark = (checks.color(f"mesh.colors[{i}]", c, high=1.0) for i, c in enumerate(colors))
        board = checks.frozen(shapes.checker_map(count, light, dark))
        recipe = {"kind": "checkerboard", "size_m": size, "squares": count, "colors": (light, dark)}
        found: dict[str, Any] = {"base_color": (1.0, 1.0, 1.0), "base_color_map": board}
        return cls(*shapes.plane(*size), **(found | look), origin=Origin(recipe, board))

    def _store_geometry(self) -> None:
        vertices = checks.array("mesh.vertices", self.vertices, (None, 3))
        faces = checks.array("mesh.faces", self.faces, (None, 3), np.int32)
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise SceneError("mesh.faces", f"name vertices {faces.min()} to {faces.max()} of {len(vertices)}")
        normals, uvs = self.normals, self.uvs
        if uvs is not None:
            uvs = checks.array("mesh.uvs", uvs, (len(vertices), 2))
        if normals is not None:
            normals = _unit(checks.array("mesh.normals", normals, (len(vertices), 3)))
        elif self.shading == "smooth":
            normals = checks.frozen(shapes.vertex_normals(vertices, faces).astype(np.float32))
        if self.shading == "flat":
            vertices, faces, normals, uvs = _flattened(vertices, faces, uvs)
        store(self, vertices=vertices, faces=faces, normals=normals, uvs=uvs)


def _checked_map(value: Any) -> np.ndarray | None:
    if value is None:
        return None
    channels = 4 if np.shape(value)[-1:] == (4,) else 3
    result = checks.picture("mesh.base_color_map", value, (None, None, channels))
    if result.min() < 0.0:
        raise SceneError("mesh.base_color_map", "holds negative values", "it is linear reflectance from 0 to 1")
    return result


def _sizes(name: str, value: Any, count: int) -> tuple[float, ...]:
    parts = (value,) * count if np.ndim(value) == 0 else tuple(value)
    if len(parts) != count:
        raise SceneError(name, f"must be one length or {count}, got {len(parts)}")
    return tuple(checks.number(name, part, low=0.0, exclusive=True, unit="metres") for part in parts)


def _unit(normals: np.ndarray) -> np.ndarray:
    """The normals themselves when they have unit length, else scaled to it."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    if (length < 1e-12).any():
        raise SceneError("mesh.normals", "hold a zero vector", "leave them out and they are worked out")
    if np.abs(length - 1.0).max() < 1e-5:
        return normals
    return checks.frozen(np.asarray(normals / length, np.float32))


def _flattened(
    vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Every face with vertices of its own that carry its normal."""
    normal = shapes.face_normals(vertices, faces)
    normal[~normal.any(axis=1)] = (0.0, 1.0, 0.0)  # a face without area is not seen, but must be finite
    corner = faces.ravel()
    return (
        checks.frozen(vertices[corner]),
        checks.frozen(np.arange(len(corner), dtype=np.int32).reshape(-1, 3)),
        checks.frozen(normal.repeat(3, axis=0).astype(np.float32)),
        None if uvs is None else checks.frozen(uvs[corner]),
    )
