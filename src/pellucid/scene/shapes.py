"""Triangles of simple shapes, and the normals of any."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Triangles(NamedTuple):
    """Vertices (V, 3), faces (F, 3) counter-clockwise from outside, normals (V, 3), uvs (V, 2)."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray


def plane(width: float, depth: float) -> Triangles:
    """Two triangles in the plane y = 0 that face +Y; the map's top lies towards -Z."""
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    x, z = (uvs[:, 0] - 0.5) * width, (0.5 - uvs[:, 1]) * depth
    normals = np.tile([0.0, 1.0, 0.0], (4, 1))
    return Triangles(np.stack([x, np.zeros(4), z], 1), np.array([[0, 1, 2], [0, 2, 3]]), normals, uvs)


def box(size: tuple[float, float, float]) -> Triangles:
    """Twelve triangles on 24 vertices, so that the edges stay sharp; each side carries the whole map."""
    base = plane(1.0, 1.0)
    parts = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            outward = np.zeros(3)
            outward[axis] = sign
            top = np.array([0.0, 1.0, 0.0]) if axis != 1 else np.array([0.0, 0.0, -sign])
            turn = np.stack([np.cross(top, outward), outward, -top], axis=1)
            raised = base.vertices + np.array([0.0, 0.5, 0.0])
            parts.append((raised @ turn.T * size, base.normals @ turn.T))
    faces = np.concatenate([base.faces + 4 * i for i in range(6)])
    vertices, normals = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    return Triangles(vertices, faces, normals, np.tile(base.uvs, (6, 1)))


def sphere(radius: float, segments: int) -> Triangles:
    """Circles of latitude and longitude, `segments` round the equator; u runs eastward, v to the north (+Y)."""
    rings = max(segments // 2, 2)
    v, u = np.meshgrid(np.linspace(0.0, 1.0, rings + 1), np.linspace(0.0, 1.0, segments + 1), indexing="ij")
    latitude, longitude = np.pi * (v - 0.5), 2.0 * np.pi * (u % 1.0)  # both sides of the seam at the same place
    across = np.where((v == 0.0) | (v == 1.0), 0.0, np.cos(latitude))
    normals = np.stack([across * np.sin(longitude), np.sin(latitude), across * np.cos(longitude)], -1).reshape(-1, 3)
    first = (np.arange(rings)[:, None] * (segments + 1) + np.arange(segments)).ravel()
    above = first + segments + 1
    southern, northern = np.stack([first, first + 1, above + 1], 1), np.stack([first, above + 1, above], 1)
    faces = np.concatenate([southern[segments:], northern[:-segments]])  # one of each pair has no area at a pole
    return Triangles(normals * radius, faces, normals, np.stack([u, v], -1).reshape(-1, 2))


def torus(radius: float, tube: float, segments: int) -> Triangles:
    """A ring around the y axis; u runs round the axis, v round the tube, from the outer equator over the top."""
    around = max(segments // 2, 4)
    v, u = np.meshgrid(np.linspace(0.0, 1.0, around + 1), np.linspace(0.0, 1.0, segments + 1), indexing="ij")
    turn, roll = 2.0 * np.pi * (u % 1.0), 2.0 * np.pi * (v % 1.0)  # both sides of a seam at the same place
    outward = np.stack([np.sin(turn), np.zeros_like(turn), np.cos(turn)], -1)
    normals = np.cos(roll)[..., None] * outward + np.sin(roll)[..., None] * (0.0, 1.0, 0.0)
    vertices = (radius * outward + tube * normals).reshape(-1, 3)
    first = (np.arange(around)[:, None] * (segments + 1) + np.arange(segments)).ravel()
    above = first + segments + 1
    faces = np.concatenate([np.stack([first, first + 1, above + 1], 1), np.stack([first, above + 1, above], 1)])
    return Triangles(vertices, faces, normals.reshape(-1, 3), np.stack([u, v], -1).reshape(-1, 2))


def checker_map(squares: int, light: tuple[float, ...], dark: tuple[float, ...]) -> np.ndarray:
    """(N, N, 3) float32 chessboard with enough texels that its edges look sharp, about 1024 on a side."""
    texels = max(1, round(1024 / squares))
    odd = np.add.outer(np.arange(squares), np.arange(squares)) % 2 == 1
    board = np.where(odd[..., None], np.asarray(dark, np.float32), np.asarray(light, np.float32))
    return np.asarray(board.repeat(texels, 0).repeat(texels, 1), np.float32)


def vertex_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Mean of the adjoining face normals, weighted by the angle each face takes up [thuermer1998].

    Vertices at one place are treated as one, so seams of a map do not show.

    Returns
    -------
    (V, 3) float64 unit vectors; +Y where no face of any area adjoins.
    """
    _, place = np.unique(vertices + 0.0, axis=0, return_inverse=True)
    place = place.reshape(-1)
    corners = np.asarray(vertices, np.float64)[faces]
    normal = face_normals(vertices, faces)
    total = np.zeros((place.max() + 1, 3))
    for i in range(3):
        to_next, to_last = corners[:, (i + 1) % 3] - corners[:, i], corners[:, (i + 2) % 3] - corners[:, i]
        across = np.linalg.norm(np.cross(to_next, to_last), axis=1)
        angle = np.arctan2(across, np.einsum("ij,ij->i", to_next, to_last))
        for axis in range(3):
            total[:, axis] += np.bincount(place[faces[:, i]], angle * normal[:, axis], minlength=len(total))
    length = np.linalg.norm(total, axis=1, keepdims=True)
    unit = np.where(length > 1e-12, total / np.maximum(length, 1e-300), [0.0, 1.0, 0.0])
    return np.asarray(unit[place])


def face_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(F, 3) float64 unit normals; zero for faces without area."""
    corners = np.asarray(vertices, np.float64)[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return np.asarray(np.where(length > 0.0, cross / np.where(length > 0.0, length, 1.0), 0.0))
