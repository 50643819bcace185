"""Rays against triangles the slow way."""

import numpy as np


def random_triangles(count: int, seed: int = 0, size: float = 0.05) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.uniform(-1, 1, (count, 1, 3)) + size * rng.normal(size=(count, 3, 3))


def brute_force_hits(triangles: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Distance to the nearest triangle by Cramer's rule on all pairs: (N,), inf for none."""
    v0, e1, e2 = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    nearest = np.full(len(origins), np.inf)
    for i, (o, d) in enumerate(zip(origins, directions, strict=True)):
        system = np.stack([e1, e2, np.broadcast_to(-d, e1.shape)], axis=-1)
        with np.errstate(all="ignore"):
            det = np.linalg.det(system)
            solvable = np.abs(det) > 1e-14
            u, v, t = np.linalg.solve(system[solvable], (o - v0[solvable])[..., None])[..., 0].T
        inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
        nearest[i] = t[inside].min(initial=np.inf)
    return nearest
