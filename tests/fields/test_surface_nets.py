"""Meshes of level sets."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from pellucid.errors import SceneError
from pellucid.fields.surface_nets import surface_nets


def sampled(f, shape, extent):
    axes = [(np.arange(n) + 0.5) * e / n - e / 2 for n, e in zip(shape[::-1], extent, strict=True)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return f(x, y, z)


def test_ball_is_closed_faces_outward_and_has_its_volume():
    extent = (2.4, 2.6, 3.0)
    sdf = sampled(lambda x, y, z: np.sqrt(x * x + y * y + z * z) - 1, (40, 36, 32), extent)
    vertices, faces = surface_nets(sdf, extent)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.euler_number == 2
    assert mesh.volume == pytest.approx(4 / 3 * np.pi, rel=0.01)
    h = 3.0 / 40
    assert np.abs(np.linalg.norm(vertices, axis=1) - 1).max() < h * h


def test_plane_is_where_it_should_be_and_open_at_the_border():
    sdf = sampled(lambda x, y, z: x - 0.13, (6, 6, 6), (1, 1, 1))
    vertices, faces = surface_nets(sdf, 1.0)
    np.testing.assert_allclose(vertices[:, 0], 0.13, atol=1e-12)
    normal = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    assert (normal[:, 0] > 0).all()


def test_without_a_surface_there_is_an_error():
    for bad in (np.ones((4, 4, 4)), np.ones((4, 4)), np.full((4, 4, 4), np.nan)):
        with pytest.raises(SceneError, match="sdf"):
            surface_nets(bad, 1.0)
