"""What rays of other things and shadow maps see of a relief: its mesh at the lowest height, in its colours."""

from __future__ import annotations

import numpy as np

from pellucid.scene import Mesh, ReliefSurface
from pellucid.techniques.relief.prepare import SOLID_ROUGHNESS, roughness_of, tiles_of

BELOW = 1e-4  # of the mesh's extent: the relief's own rays to lamps must not meet what stands for it


def stand_in(item: ReliefSurface) -> Mesh:
    """An opaque mesh just below all of the solid layer."""
    mesh = item.mesh
    assert mesh.normals is not None and mesh.uvs is not None
    extent = float(np.ptp(mesh.vertices, axis=0).max())
    low = item.solid.limits_m[0] / item.scale - BELOW * extent
    colors = np.asarray(item.solid.colors)
    look = {"base_color": item.solid.colors} if colors.ndim == 1 else {"base_color": (1.0, 1.0, 1.0)}
    return Mesh(
        mesh.vertices + np.float32(low) * mesh.normals,
        mesh.faces,
        mesh.normals,
        mesh.uvs * np.asarray(tiles_of(item), np.float32),
        base_color_map=None if colors.ndim == 1 else item.solid.colors,
        roughness=roughness_of(item.solid, SOLID_ROUGHNESS),
        specular=item.solid.specular,
        position=item.position,
        rotation=item.rotation,
        scale=item.scale,
        **look,
    )
