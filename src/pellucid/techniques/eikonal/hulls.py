"""Where the rays of a picture begin: a sphere or half-spaces around the matter of a volume; NumPy only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene.mesh import Mesh
from pellucid.techniques.eikonal.prepare import Prepared
from pellucid.techniques.eikonal.proxies import MATTER_MARGIN_VOXELS, matter_of

MAX_PLANES = 32
# A Gaussian of 0.75 voxels fades below `proxies.NOTHING` within five.
SOFT_MARGIN_VOXELS = 7.0
# The constant PROXY of proxy.wgsl
BOX, SPHERE, PLANES = 0, 1, 2
# Faces whose normals differ by less count as one: the rounding of 32-bit vertices.
SAME_NORMAL = 1e-4


@dataclass(frozen=True)
class Hull:
    """A convex body around the matter of a volume, object metres.

    kind : BOX, SPHERE or PLANES.
    sphere : (4,) centre and radius.
    planes : (N, 4) unit outward normals n and offsets w: n.x <= w inside.
    """

    kind: int
    sphere: np.ndarray
    planes: np.ndarray

    def write(self, record: np.ndarray) -> None:
        """Fill in what VolumeParams says of it."""
        record["proxy_sphere"] = self.sphere
        record["proxy_planes"][: len(self.planes)] = self.planes
        record["proxy_plane_count"] = len(self.planes)


def hull_of(prepared: Prepared, proxy: str | Mesh, center_m: tuple[float, float, float]) -> Hull:
    """The hull that `RefractiveVolume.proxy` asks for.

    It is larger by some voxels than what it is made from: a surface is sought from outside, and a smooth boundary is
    wider than the mesh that it came from.

    Raises
    ------
    SceneError : a mesh that leaves matter outside.
    """
    nowhere = Hull(BOX, np.zeros(4), np.zeros((0, 4)))
    if proxy == "box":
        return nowhere
    points = _matter_points(prepared)
    margin = (MATTER_MARGIN_VOXELS if prepared.sharp else SOFT_MARGIN_VOXELS) * max(prepared.voxel_m)
    if not isinstance(proxy, Mesh):
        if not len(points):
            return nowhere
        center = 0.5 * (points.min(axis=0) + points.max(axis=0))
        radius = np.linalg.norm(points - center, axis=1).max() + MATTER_MARGIN_VOXELS * max(prepared.voxel_m)
        return Hull(SPHERE, np.append(center, radius), nowhere.planes)
    planes = _half_spaces(proxy, np.asarray(center_m, float))
    planes[:, 3] += margin
    outside = (points @ planes[:, :3].T > planes[:, 3] - max(prepared.voxel_m)).any(axis=1).sum()
    if outside:
        reason = f"leaves {outside} of {len(points)} voxels of matter outside ({outside / len(points):.1%})"
        raise SceneError("refractive_volume.proxy", reason, "give a mesh around all matter, or 'sphere' or 'box'")
    return Hull(PLANES, nowhere.sphere, planes)


def _matter_points(prepared: Prepared) -> np.ndarray:
    """(N, 3) centres of the voxels that hold anything and have a neighbour that does not, object metres."""
    held = np.pad(matter_of(prepared), 1)
    inner = held.copy()
    for axis in range(3):
        inner &= np.roll(held, 1, axis) & np.roll(held, -1, axis)
    index = np.argwhere(held & ~inner)[:, ::-1] - 1
    return (index + 0.5) * np.array(prepared.voxel_m) - 0.5 * np.array(prepared.extent_m)


def _half_spaces(mesh: Mesh, center: np.ndarray) -> np.ndarray:
    """(N, 4) half-spaces that hold the mesh, in coordinates about the middle of the box.

    Those of its own faces where these have few normals, as a convex polyhedron has; else 26, along the axes and the
    diagonals of edges and corners of a cube [klosowski1998].
    """
    vertices = np.asarray(mesh.vertices, np.float64) - center
    corners = vertices[np.asarray(mesh.faces)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    normals = normals[length > 0.0] / length[length > 0.0, None]
    few = np.unique(np.round(normals / SAME_NORMAL) * SAME_NORMAL, axis=0)
    if len(few) > MAX_PLANES or len(few) < 4:
        grid = np.array(np.meshgrid(*[(-1, 0, 1)] * 3)).reshape(3, -1).T.astype(float)
        few = grid[np.abs(grid).sum(axis=1) > 0]
    few = few / np.linalg.norm(few, axis=1, keepdims=True)
    return np.concatenate([few, (vertices @ few.T).max(axis=0)[:, None]], axis=1)
