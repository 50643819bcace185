"""Surfaces from voxel fields: a triangle mesh of a zero level set.

Surface nets [gibson1998], without the relaxation: one vertex in every cell that the surface
passes, at the mean of the crossings on the cell's edges; one quadrilateral around every crossed edge.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def surface_nets(
    sdf: npt.ArrayLike, extent_m: tuple[float, float, float] | float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Triangles of the surface where `sdf` changes sign, facing the positive side.

    Parameters
    ----------
    sdf : (Z, Y, X), negative inside; any field with a sign will do.
    extent_m : edges (x, y, z) of the grid's box, which is centred on the origin, or its longest edge.

    Returns
    -------
    vertices (V, 3) in metres and faces (F, 3), counter-clockwise seen from outside. The mesh is closed
    if the surface does not reach the border of the grid.

    Raises
    ------
    SceneError
        The field is not (Z, Y, X), has values that are not finite, or never changes sign.
    """
    values = np.asarray(sdf, dtype=np.float64)
    if values.ndim != 3 or min(values.shape) < 2:
        raise SceneError("sdf", f"has shape {values.shape}", "give (Z, Y, X), at least two voxels each")
    if not np.isfinite(values).all():
        raise SceneError("sdf", "has values that are not finite")
    vertices, faces = nets_in_voxels(values)
    if len(faces) == 0:
        raise SceneError("sdf", "has no surface inside the grid", "it must change sign")
    count = np.array(values.shape[::-1], dtype=np.float64)
    edges = np.asarray(extent_m, dtype=np.float64)
    extent = edges * count / count.max() if edges.ndim == 0 else edges
    return (vertices + 0.5) / count * extent - 0.5 * extent, faces


def nets_in_voxels(values: Floats, largest_step: float = np.inf) -> tuple[Floats, Ints]:
    """Vertices in voxel units (x, y, z; voxel centres at whole numbers), and faces.

    Edges over which the field jumps by `largest_step` or more are no crossings: there the field is
    discontinuous, and the surface is whatever made it so.
    """
    inside = values < 0.0
    cells = np.array(values.shape) - 1
    total = np.zeros((int(cells.prod()), 3))
    hits = np.zeros(len(total), dtype=np.int64)
    quads: list[Ints] = []
    for axis in range(3):
        voxel, position, outward = _crossings(values, inside, axis, largest_step)
        around = _cells_around(voxel, axis, cells)
        for cell in around.T:
            there = cell >= 0
            np.add.at(total, cell[there], position[there])
            np.add.at(hits, cell[there], 1)
        whole = (around >= 0).all(axis=1)
        ring = np.where(outward[whole, None], around[whole], around[whole][:, ::-1])
        quads.append(ring)
    used = hits > 0
    number = np.cumsum(used) - 1
    vertices = total[used] / hits[used][:, None]
    return vertices, _triangles(vertices, number[np.concatenate(quads)])


def _crossings(
    values: Floats, inside: npt.NDArray[np.bool_], axis: int, largest_step: float
) -> tuple[Ints, Floats, npt.NDArray[np.bool_]]:
    """Lower voxel (z, y, x) of each crossed edge along `axis`, the crossing (x, y, z), and whether inside is below."""
    lower = tuple(slice(None, -1) if a == axis else slice(None) for a in range(3))
    upper = tuple(slice(1, None) if a == axis else slice(None) for a in range(3))
    a, b = values[lower], values[upper]
    start_inside: npt.NDArray[np.bool_] = inside[lower]
    crossed = np.asarray(start_inside ^ inside[upper])
    if np.isfinite(largest_step):
        crossed &= np.abs(a - b) < largest_step
    voxel = np.argwhere(crossed)
    a, b = a[crossed], b[crossed]
    position = voxel[:, ::-1].astype(np.float64)
    position[:, 2 - axis] += a / (a - b)
    return voxel, position, start_inside[crossed]


def _cells_around(voxel: Ints, axis: int, cells: Ints) -> Ints:
    """(N, 4) flat indices of the cells around an edge, counter-clockwise along +axis; -1 outside."""
    # Axes are counted z, y, x here: after z come x and y, after y come z and x, after x come y and z.
    u, v = {0: (2, 1), 1: (0, 2), 2: (1, 0)}[axis]
    around = np.empty((len(voxel), 4), dtype=np.int64)
    for n, (du, dv) in enumerate(((-1, -1), (0, -1), (0, 0), (-1, 0))):
        cell = voxel.copy()
        cell[:, u] += du
        cell[:, v] += dv
        there = np.all((cell >= 0) & (cell < cells), axis=1)
        flat = np.ravel_multi_index(tuple(np.where(there[:, None], cell, 0).T), tuple(cells))
        around[:, n] = np.where(there, flat, -1)
    return around


def _triangles(vertices: Floats, quads: Ints) -> Ints:
    """Cut quadrilaterals along their shorter diagonal."""
    if len(quads) == 0:
        return np.empty((0, 3), dtype=np.int64)
    p, q, r, s = (vertices[quads[:, k]] for k in range(4))
    other = np.sum((q - s) ** 2, axis=1) < np.sum((p - r) ** 2, axis=1)
    a, b, c, d = np.where(other[:, None], np.roll(quads, -1, axis=1), quads).T
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
