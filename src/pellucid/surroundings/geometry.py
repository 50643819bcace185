"""The opaque meshes of a scene as one list of world-space triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pellucid.surroundings import bvh
from pellucid.surroundings.layouts import (
    MATERIAL_SINGLE_SIDED,
    BvhNode,
    BvhTriangle,
    Material,
    TriangleAttributes,
)

if TYPE_CHECKING:
    from pellucid.scene import Mesh


@dataclass(frozen=True)
class Geometry:
    """World-space triangles in the order of their hierarchy.

    Attributes
    ----------
    nodes, triangles, attributes : structured arrays of `layouts`; at least one record each, for a GPU
        cannot bind an empty buffer.
    count : number of true triangles, 0 for a scene without meshes.
    bounds : (lower, upper) in metres of each mesh.
    corners : world-space vertices (V, 3) of each mesh.
    texture_area : per mesh, area in the unit square of uv divided by area in square metres.
    """

    nodes: np.ndarray
    triangles: np.ndarray
    attributes: np.ndarray
    count: int
    bounds: list[tuple[np.ndarray, np.ndarray]]
    corners: list[np.ndarray]
    texture_area: list[float]

    @property
    def scale_m(self) -> float:
        """Largest coordinate of any vertex, the measure of rounding errors; 1 for an empty scene."""
        return max((float(np.abs(c).max()) for c in self.corners), default=1.0)


def gather(meshes: Sequence[Mesh]) -> Geometry:
    """Bring all meshes to world space and build their hierarchy."""
    if not meshes:
        one = (np.zeros(1, BvhNode), np.zeros(1, BvhTriangle), np.zeros(1, TriangleAttributes))
        return Geometry(*one, 0, [], [], [])
    corners = [_world_points(mesh) for mesh in meshes]
    positions = np.concatenate([c[mesh.faces] for c, mesh in zip(corners, meshes, strict=True)])
    normals = np.concatenate([_world_normals(c, mesh) for c, mesh in zip(corners, meshes, strict=True)])
    uvs = np.concatenate([_uvs(mesh) for mesh in meshes])
    material = np.repeat(np.arange(len(meshes)), [len(mesh.faces) for mesh in meshes])
    single = np.array([not mesh.double_sided for mesh in meshes])[material]
    tree = bvh.build(positions)
    o = tree.order
    return Geometry(
        _nodes(tree),
        _triangles(positions[o], single[o], material[o]),
        _attributes(normals[o], uvs[o]),
        len(positions),
        [(c.min(axis=0), c.max(axis=0)) for c in corners],
        corners,
        [_texture_area(positions[material == i], uvs[material == i]) for i in range(len(meshes))],
    )


def materials(meshes: Sequence[Mesh], geometry: Geometry, layers: Sequence[int], map_size: int) -> np.ndarray:
    """One Material record a mesh; `layers` are the layers of the base colour maps, -1 for none."""
    records = np.zeros(max(len(meshes), 1), Material)
    for record, mesh, layer, area in zip(records, meshes, layers, geometry.texture_area, strict=False):
        record["base_color"], record["roughness"] = mesh.base_color, mesh.roughness
        record["emission"], record["specular"] = mesh.emission, mesh.specular
        record["base_color_layer"] = layer
        record["texels_per_m"] = map_size * np.sqrt(area)
        record["flags"] = 0 if mesh.double_sided else MATERIAL_SINGLE_SIDED
    return records


def albedo(meshes: Sequence[Mesh]) -> np.ndarray:
    """(M, 3) mean base colour of each mesh; at least one row."""
    maps = [1.0 if m.base_color_map is None else np.mean(m.base_color_map, axis=(0, 1))[:3] for m in meshes]
    colors = [np.asarray(m.base_color, np.float64) * mean for m, mean in zip(meshes, maps, strict=True)]
    return np.array(colors or [np.zeros(3)])


def _world_points(mesh: Mesh) -> np.ndarray:
    matrix = np.asarray(mesh.object_to_world(), np.float64)
    return np.asarray(mesh.vertices, np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def _world_normals(points: np.ndarray, mesh: Mesh) -> np.ndarray:
    """Unit normals of the three corners of each face (F, 3, 3); those of the face where the mesh has none."""
    if mesh.normals is None:
        face = points[mesh.faces]
        flat = np.cross(face[:, 1] - face[:, 0], face[:, 2] - face[:, 0])
        normals = np.repeat(flat[:, None], 3, axis=1)
    else:
        matrix = np.linalg.inv(np.asarray(mesh.object_to_world(), np.float64)[:3, :3])
        normals = (np.asarray(mesh.normals, np.float64) @ matrix)[mesh.faces]
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    return normals / np.where(length > 0, length, 1.0)


def _uvs(mesh: Mesh) -> np.ndarray:
    if mesh.uvs is None:
        return np.zeros((len(mesh.faces), 3, 2))
    return np.asarray(mesh.uvs, np.float64)[mesh.faces]


def _texture_area(positions: np.ndarray, uvs: np.ndarray) -> float:
    edges, uv_edges = positions[:, 1:] - positions[:, :1], uvs[:, 1:] - uvs[:, :1]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=-1).sum()
    uv_area = np.abs(uv_edges[:, 0, 0] * uv_edges[:, 1, 1] - uv_edges[:, 0, 1] * uv_edges[:, 1, 0]).sum()
    return float(uv_area / area) if area > 0 else 0.0


def _nodes(tree: bvh.Bvh) -> np.ndarray:
    nodes = np.zeros(len(tree.link), BvhNode)
    nodes["lower"], nodes["upper"], nodes["link"], nodes["count"] = (
        tree.lower,
        tree.upper,
        tree.link,
        tree.count,
    )
    return nodes


def _triangles(positions: np.ndarray, single_sided: np.ndarray, material: np.ndarray) -> np.ndarray:
    triangles = np.zeros(len(positions), BvhTriangle)
    for k in range(3):
        triangles[f"corner_{k}"] = positions[:, k]
    triangles["single_sided"], triangles["material"] = single_sided, material
    return triangles


def _attributes(normals: np.ndarray, uvs: np.ndarray) -> np.ndarray:
    attributes = np.zeros(len(normals), TriangleAttributes)
    for k in range(3):
        attributes[f"normal_{k}"], attributes[f"uv_{k}"] = normals[:, k], uvs[:, k]
    return attributes
