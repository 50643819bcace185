"""Frames of a mesh for relief: how its surface runs along its texture, how it bends, and the hull around it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pellucid.techniques.relief.layouts import VERTEX_TEXELS, ReliefVertex

FLATNESS = 1e-4  # of the size of a mesh, and of its normals
VERTICES_A_ROW = 1638  # of the texture of vertices: as many whole ones as every device allows
BORDER_SLACK = 1e-4  # of the extent of the texture coordinates


@dataclass(frozen=True)
class Hull:
    """Triangles around a relief.

    Attributes
    ----------
    vertices : (3 F,) of ``layouts.ReliefVertex``, three a triangle.
    tile_m : metres a tile along u and v, in the mean over the surface.
    clip_low, clip_high : rectangle of texture coordinates that open borders bound; without end where none does.
    """

    vertices: np.ndarray
    tile_m: tuple[float, float]
    clip_low: tuple[float, float]
    clip_high: tuple[float, float]

    @cached_property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (3,) of the mesh, metres."""
        position = self.vertices["position"].astype(np.float64)
        return position.min(axis=0), position.max(axis=0)

    @cached_property
    def plane(self) -> dict[str, np.ndarray] | None:
        """Origin, tangent, bitangent and unit normal of the plane with one frame that the mesh lies on, (3,) metres.

        None for a mesh that is curved, or whose texture is stretched unevenly.
        """
        vertices = self.vertices[self.vertices["wall"] < 0.5]
        frame = {name: vertices[name].astype(np.float64) for name in ("position", "normal", "tangent", "bitangent")}
        mean = {name: values.mean(axis=0) for name, values in frame.items()}
        offset = vertices["u"][:, None] * mean["tangent"] + vertices["v"][:, None] * mean["bitangent"]
        origins = frame["position"] - offset
        size = max(float(np.ptp(frame["position"], axis=0).max()), 1e-12)
        turned = float(np.abs(frame["normal"] - mean["normal"]).max())
        if np.abs(origins - origins.mean(axis=0)).max() > FLATNESS * size or turned > FLATNESS:
            return None
        normal = mean["normal"] / np.linalg.norm(mean["normal"])
        return {"origin": origins.mean(axis=0), **{k: mean[k] for k in ("tangent", "bitangent")}, "normal": normal}


def hull_of(vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, uvs: np.ndarray) -> Hull:
    """The hull of a mesh: every triangle, which shaders move outwards, and walls at open borders.

    Parameters
    ----------
    vertices : (V, 3) metres. faces : (F, 3). normals : (V, 3) unit. uvs : (V, 2) in tiles.
    """
    faces = _with_area(vertices, faces)
    turned = np.einsum("fi,fi->f", _face_cross(vertices, faces), normals[faces].sum(axis=1)) < 0.0
    faces = np.where(turned[:, None], faces[:, ::-1], faces)
    tangent, bitangent = tangents(vertices, faces, normals, uvs)
    form = curvature(faces, normals, uvs, tangent, bitangent, vertices)
    corner = np.zeros(len(vertices), ReliefVertex)
    corner["position"], corner["normal"] = vertices, normals
    corner["u"], corner["v"] = uvs[:, 0], uvs[:, 1]
    corner["tangent"], corner["bitangent"], corner["curvature"] = tangent, bitangent, form
    top = corner[faces.ravel()]
    top["level"] = 1.0
    borders = open_borders(vertices, faces, normals)
    area = np.linalg.norm(_face_cross(vertices, faces), axis=1)
    area = area / area.sum()
    sides = [float((area * np.linalg.norm(t[faces].mean(axis=1), axis=1)).sum()) for t in (tangent, bitangent)]
    low, high = _clip(uvs, faces, borders)
    return Hull(_joined(top, _walls(corner, borders)), (sides[0], sides[1]), low, high)


def vertex_texels(vertices: np.ndarray) -> np.ndarray:
    """Vertices as an image, (rows, columns, 4) float32: records one after the other, none over the end of a row."""
    columns = min(len(vertices), VERTICES_A_ROW)
    rows = -(-len(vertices) // columns)
    padded = np.zeros(rows * columns, ReliefVertex)
    padded[: len(vertices)] = vertices
    return padded.view(np.float32).reshape(rows, columns * VERTEX_TEXELS, 4)


def tangents(
    vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, uvs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """dP/du and dP/dv at each vertex, (V, 3) metres a tile: means of the faces by area, in the plane of the normal."""
    du, dv = _along_texture(vertices, faces, uvs)
    area = np.linalg.norm(_face_cross(vertices, faces), axis=1)
    return _at_vertices(du, area, faces, normals), _at_vertices(dv, area, faces, normals)


def curvature(
    faces: np.ndarray,
    normals: np.ndarray,
    uvs: np.ndarray,
    tangent: np.ndarray,
    bitangent: np.ndarray,
    vertices: np.ndarray,
) -> np.ndarray:
    """Second fundamental form at each vertex, (V, 3): dN/du.T, mean of dN/du.B and dN/dv.T, dN/dv.B."""
    du, dv = _along_texture(normals, faces, uvs)
    area = np.linalg.norm(_face_cross(vertices, faces), axis=1)
    n_u, n_v = _at_vertices(du, area, faces, normals), _at_vertices(dv, area, faces, normals)
    mixed = 0.5 * (_dot(n_u, bitangent) + _dot(n_v, tangent))
    return np.stack([_dot(n_u, tangent), mixed, _dot(n_v, bitangent)], axis=1)


def open_borders(vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Directed edges (E, 2) without a neighbour. Vertices are one where place and normal are, so that seams of the
    texture are closed, and sharp edges, along which a hull gapes, are not."""
    scale = max(float(np.abs(vertices).max()), 1e-30)
    keys = np.round(np.concatenate([vertices / scale, normals], axis=1), 5) + 0.0
    _, place = np.unique(keys, axis=0, return_inverse=True)
    place = place.reshape(-1)
    edges = np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)])
    welded = place[edges]
    forward = welded[:, 0].astype(np.int64) * (place.max() + 1) + welded[:, 1]
    backward = welded[:, 1].astype(np.int64) * (place.max() + 1) + welded[:, 0]
    return np.asarray(edges[~np.isin(forward, backward) & (welded[:, 0] != welded[:, 1])])


def _walls(corner: np.ndarray, borders: np.ndarray) -> np.ndarray:
    """Two triangles for each border edge, counter-clockwise from outside."""
    quads = corner[borders[:, [0, 1, 1, 0, 1, 0]].ravel()]
    quads["level"] = np.tile([0.0, 0.0, 1.0, 0.0, 1.0, 1.0], len(borders))
    quads["wall"] = 1.0
    return quads


def _joined(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Records one after the other; np.concatenate would leave out the padding between their fields."""
    out = np.zeros(len(a) + len(b), ReliefVertex)
    out[: len(a)], out[len(a) :] = a, b
    return out


def _clip(uvs: np.ndarray, faces: np.ndarray, borders: np.ndarray) -> tuple[tuple[float, float], tuple[float, float]]:
    """The sides of the rectangle around all uvs on which a border edge lies."""
    used = uvs[faces.ravel()]
    ends = np.stack([used.min(axis=0), used.max(axis=0)])
    found = np.array([[-1e9, -1e9], [1e9, 1e9]])
    slack = BORDER_SLACK * (ends[1] - ends[0])
    for side in range(2):
        for axis in range(2):
            there = np.abs(uvs[borders][..., axis] - ends[side, axis]) <= slack[axis]
            if there.all(axis=1).any():
                found[side, axis] = ends[side, axis]
    (u0, v0), (u1, v1) = found.tolist()
    return (u0, v0), (u1, v1)


def _along_texture(values: np.ndarray, faces: np.ndarray, uvs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (F, 3) by u and by v of what is linear on each face; zero where a face has no area in the texture."""
    e1, e2 = (values[faces[:, k]] - values[faces[:, 0]] for k in (1, 2))
    t1, t2 = (uvs[faces[:, k]] - uvs[faces[:, 0]] for k in (1, 2))
    determinant = t1[:, 0] * t2[:, 1] - t1[:, 1] * t2[:, 0]
    inverse = np.where(np.abs(determinant) > 1e-12, 1.0 / np.where(determinant == 0.0, 1.0, determinant), 0.0)[:, None]
    return inverse * (t2[:, 1:] * e1 - t1[:, 1:] * e2), inverse * (t1[:, :1] * e2 - t2[:, :1] * e1)


def _at_vertices(values: np.ndarray, weight: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Weighted means of values of faces, without their part along the normal; their mean length is kept."""
    count = len(normals)
    total, weights, length = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    for k in range(3):
        weights += np.bincount(faces[:, k], weight, count)
        length += np.bincount(faces[:, k], weight * np.linalg.norm(values, axis=1), count)
        for axis in range(3):
            total[:, axis] += np.bincount(faces[:, k], weight * values[:, axis], count)
    flat = total - _dot(total, normals)[:, None] * normals
    norm = np.linalg.norm(flat, axis=1)
    scale = np.where(norm > 1e-30, length / np.maximum(weights, 1e-30) / np.maximum(norm, 1e-30), 0.0)
    return np.asarray(flat * scale[:, None])


def _with_area(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    area = np.linalg.norm(_face_cross(vertices, faces), axis=1)
    return np.asarray(faces[area > 1e-12 * max(float(area.max()), 1e-30)])


def _face_cross(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    corner = vertices[faces]
    return np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(np.einsum("ij,ij->i", a, b))
