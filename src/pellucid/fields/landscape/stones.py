"""Boulders: spheres pushed out and in."""

from __future__ import annotations

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.landscape.patch import Patch


def stone(seed: int = 0, roughness: float = 0.28, finer: int = 2) -> Patch:
    """A boulder about the origin of mean radius about 1: a divided icosahedron, cut by planes, with lumps.

    Parameters
    ----------
    seed : of random numbers. roughness : share of the radius that it departs from a sphere, 0 to 0.6.
    finer : how often each triangle is divided into four, 0 to 5: 20, 80, 320, 1280 ... faces.

    Raises
    ------
    SceneError : a value out of its range.
    """
    if not 0.0 <= roughness <= 0.6:
        raise SceneError("roughness", f"is {roughness}", "use 0 to 0.6")
    if not 0 <= finer <= 5:
        raise SceneError("finer", f"is {finer}", "use 0 to 5")
    rng = np.random.default_rng(seed)
    directions, faces = _icosphere(finer)
    radius = np.ones(len(directions))
    for octave, strength in ((1.2, 0.5), (2.7, 0.22), (6.0, 0.08)):
        waves = rng.normal(size=(7, 3)) * octave
        radius += roughness * strength * np.cos(directions @ waves.T + rng.uniform(0.0, 6.3, 7)).sum(axis=1) / 2.6
    # Faces where it broke: no point reaches beyond the planes.
    normals = rng.normal(size=(6, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    reach = directions @ normals.T
    limit = (1.0 - roughness * rng.uniform(0.2, 1.0, 6)) / np.maximum(reach, 1e-6)
    radius = np.minimum(radius, np.where(reach > 0.05, limit, np.inf).min(axis=1))
    return Patch(directions * radius[:, None], faces)


def _icosphere(finer: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices on the unit sphere and faces of an icosahedron, each face divided into 4^finer."""
    t = 0.5 * (1.0 + np.sqrt(5.0))
    corners = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t),
                        (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)])  # fmt: skip
    faces = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                      (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
                      (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)], np.int32)  # fmt: skip
    for _ in range(finer):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, where = np.unique(edges, axis=0, return_inverse=True)
        middle = where.reshape(-1, 3) + len(corners)
        corners = np.concatenate([corners, 0.5 * (corners[unique[:, 0]] + corners[unique[:, 1]])])
        a, b, c = faces.T
        ab, bc, ca = middle.T
        faces = np.concatenate([np.stack(f, 1) for f in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
        corners /= np.linalg.norm(corners, axis=1, keepdims=True)
    return corners / np.linalg.norm(corners, axis=1, keepdims=True), faces.astype(np.int32)
