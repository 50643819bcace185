"""Signed distance of meshes against analytic shapes and against brute force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from pellucid.errors import SceneError
from pellucid.fields.triangles import TriangleFrames
from pellucid.fields.voxelise import cleaned, signed_distance
from pellucid.fields.winding import WindingNumber, solid_angle

BUNNY = Path("/work/shared/data/bunny.ply")


def centres(n: int, edge: float) -> tuple[np.ndarray, float, np.ndarray]:
    """First voxel, voxel edge, and all centres (n, n, n, 3) of a cube about the origin."""
    h = edge / n
    line = (np.arange(n) + 0.5) * h - edge / 2
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    return np.full(3, line[0]), h, np.stack([x, y, z], axis=-1)


def sphere(subdivisions: int = 4, radius: float = 1.0) -> trimesh.Trimesh:
    return trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)


def brute_distance(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    frames = TriangleFrames(corners)
    best = np.full(len(points), np.inf)
    for start in range(0, len(points), 512):
        s = slice(start, start + 512)
        d2 = frames.squared_distance(np.arange(len(corners)), np.zeros((len(corners), 3)), points[s])
        best[s] = np.sqrt(d2.min(axis=0))
    return best


def brute_winding(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    return solid_angle(corners, points[None]).sum(axis=0) / (4 * np.pi)


def sign_changes_within_one_voxel(sdf: np.ndarray, h: float) -> bool:
    """Where neighbours differ in sign the surface lies between them: their distances add up to h at most."""
    for axis in range(3):
        a, b = np.moveaxis(sdf, axis, 0)[:-1], np.moveaxis(sdf, axis, 0)[1:]
        if (np.abs(a - b)[(a < 0) != (b < 0)] > h * (1 + 1e-5)).any():
            return False
    return True


def test_point_triangle_distance_against_dense_sampling():
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(20, 3, 3))
    points = rng.normal(size=(20, 3)) * 2
    exact = np.sqrt(TriangleFrames(corners).squared_distance(np.arange(20), points, np.zeros((1, 3))))[:, 0]
    u, v = np.meshgrid(np.linspace(0, 1, 401), np.linspace(0, 1, 401))
    u, v = u[u + v <= 1.0], v[u + v <= 1.0]
    for t in range(20):
        a, b, c = corners[t]
        samples = a + u[:, None] * (b - a) + v[:, None] * (c - a)
        sampled = np.linalg.norm(samples - points[t], axis=1).min()
        assert exact[t] <= sampled + 1e-12
        assert sampled - exact[t] < np.linalg.norm(corners[t] - a, axis=1).max() / 400


def test_solid_angle_of_an_octant_is_a_eighth_of_the_sphere():
    corners = np.eye(3)[None]
    assert solid_angle(corners, np.zeros((1, 1, 3)))[0, 0] == pytest.approx(np.pi / 2, abs=1e-14)


def test_tree_agrees_with_the_sum_over_all_triangles_on_an_open_mesh():
    ball = sphere(3)
    keep = ball.triangles_center[:, 1] > -0.3
    v, f = cleaned(ball.vertices, ball.faces[keep])
    groups = np.random.default_rng(0).uniform(-1.5, 1.5, size=(40, 1, 3)) + np.zeros((1, 8, 1))
    groups = groups + np.random.default_rng(1).normal(size=groups.shape) * 0.03
    fast = WindingNumber(v, f)(groups).ravel()
    np.testing.assert_allclose(fast, brute_winding(v[f], groups.reshape(-1, 3)), atol=1e-12)


def test_neighbours_are_summed_like_single_groups():
    ball = sphere(2)
    v, f = cleaned(ball.vertices, ball.faces[:-30])
    winding = WindingNumber(v, f)
    groups = np.random.default_rng(0).uniform(-1.2, 1.2, size=(39, 2, 3))
    np.testing.assert_allclose(winding.of_neighbours(groups), winding(groups), atol=1e-12)


def test_tree_alone_is_near_the_sum_where_open_edges_are_too_many_to_correct():
    ball = sphere(4)
    rng = np.random.default_rng(0)
    v, f = cleaned(ball.vertices, ball.faces[rng.uniform(size=len(ball.faces)) < 0.6])
    groups = rng.uniform(-1.3, 1.3, size=(300, 1, 3))
    fast = WindingNumber(v, f)(groups).ravel()
    assert np.abs(fast - brute_winding(v[f], groups[:, 0])).max() < 0.02


def test_sphere_is_exact_in_the_band_and_a_close_lower_bound_beyond():
    ball = sphere(4)
    origin, h, p = centres(48, 2.6)
    sdf = signed_distance(ball.vertices, ball.faces, (48,) * 3, origin, h)
    sample = np.random.default_rng(1).integers(0, sdf.size, 1500)
    sdf, p = sdf.ravel()[sample], p.reshape(-1, 3)[sample]
    true = brute_distance(np.asarray(ball.triangles), p)
    analytic = np.linalg.norm(p, axis=-1) - 1.0
    band = true < 3 * h
    assert band.sum() > 200
    facet = 1.0 - np.linalg.norm(ball.triangles_center, axis=1).min()
    assert np.abs(np.abs(sdf) - true)[band].max() < 1e-6
    assert np.abs(sdf - analytic)[band].max() < facet + 1e-6
    assert (np.abs(sdf) <= true + 1e-6).all()
    assert (true - np.abs(sdf)).max() < 1.7321 * h
    assert ((sdf < 0) == (analytic < 0))[np.abs(analytic) > facet].all()


def test_box_with_large_triangles_and_brick_voxels():
    box = trimesh.creation.box(extents=(1.0, 0.6, 1.4))
    voxel = np.array([0.05, 0.04, 0.07])
    shape = (30, 28, 32)
    origin = -0.5 * (np.array(shape[::-1]) - 1) * voxel
    sdf = signed_distance(box.vertices, box.faces, shape, origin, voxel)
    axes = [origin[a] + np.arange(shape[2 - a]) * voxel[a] for a in range(3)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    q = np.abs(np.stack([x, y, z], axis=-1)) - [0.5, 0.3, 0.7]
    true = np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)
    assert np.abs(sdf - true)[np.abs(true) < 3 * voxel.min()].max() < 1e-6
    assert (np.abs(sdf) <= np.abs(true) + 1e-6).all()
    assert ((sdf < 0) == (true < 0))[np.abs(true) > 1e-9].all()


def test_open_hemisphere_is_closed_at_half_winding():
    ball = sphere(4)
    v, f = cleaned(ball.vertices, ball.faces[ball.triangles_center[:, 1] > 0.0])
    origin, h, p = centres(40, 2.6)
    sdf = signed_distance(v, f, (40,) * 3, origin, h)
    sample = np.random.default_rng(1).integers(0, sdf.size, 1500)
    w = brute_winding(v[f], p.reshape(-1, 3)[sample])
    assert ((sdf.ravel()[sample] < 0) == (w > 0.5)).all()
    # On the axis the level set crosses where the sum over all triangles says so.
    column = brute_winding(v[f], p[20, :, 20])
    below = np.flatnonzero((column[:-1] < 0.5) & (column[1:] > 0.5))[0]
    crossing = below + (0.5 - column[below]) / (column[below + 1] - column[below])
    expected = np.abs(np.arange(40) - crossing) * h
    near = np.abs(np.arange(40) - crossing) < 2.5
    assert np.abs(np.abs(sdf[20, :, 20]) - expected)[near].max() < 0.1 * h
    assert sign_changes_within_one_voxel(sdf, h)


def test_inverted_mesh_is_turned_back():
    ball = sphere(2)
    origin, h, _ = centres(20, 2.6)
    right = signed_distance(ball.vertices, ball.faces, (20,) * 3, origin, h)
    inverted = signed_distance(ball.vertices, ball.faces[:, ::-1], (20,) * 3, origin, h)
    np.testing.assert_array_equal(right < 0, inverted < 0)
    np.testing.assert_allclose(right, inverted, atol=1e-6)


def test_walls_inside_two_crossing_spheres_are_no_surface():
    shift = np.array([0.5, 0.0, 0.0])
    two = trimesh.util.concatenate([sphere(4).apply_translation(shift), sphere(4).apply_translation(-shift)])
    origin, h, p = centres(48, 3.4)
    sdf = signed_distance(two.vertices, two.faces, (48,) * 3, origin, h)
    union = np.minimum(np.linalg.norm(p - shift, axis=-1), np.linalg.norm(p + shift, axis=-1)) - 1.0
    assert ((sdf < 0) == (union < 0))[np.abs(union) > 0.003].all()
    outside = (union > 0) & (union < 3 * h)
    assert np.abs(sdf - union)[outside].max() < 0.003
    # Inside, the nearest surface is the sphere about the other centre, or the circle where both meet.
    wall = (np.abs(np.linalg.norm(p - shift, axis=-1) - 1) < h) & (union < -5 * h)
    assert wall.any() and sdf[wall].max() < -3 * h


def test_bodies_apart_and_merged_duplicates_and_degenerate_faces():
    a, b = sphere(2, 0.4).apply_translation([0.6, 0, 0]), sphere(2, 0.4).apply_translation([-0.6, 0, 0])
    soup = np.concatenate([a.triangles, b.triangles]).reshape(-1, 3)
    faces = np.arange(len(soup)).reshape(-1, 3)
    faces = np.concatenate([faces, [[0, 0, 1], [2, 2, 2]]])
    origin, h, p = centres(32, 2.4)
    sdf = signed_distance(soup, faces, (32,) * 3, origin, h)
    offset = np.minimum(np.linalg.norm(p - [0.6, 0, 0], axis=-1), np.linalg.norm(p - [-0.6, 0, 0], axis=-1))
    true = offset - 0.4
    assert ((sdf < 0) == (true < 0))[np.abs(true) > 0.02].all()


def test_mesh_beyond_the_grid_keeps_the_bound():
    ball = sphere(3)
    origin, h, p = centres(24, 0.6)
    origin = origin + np.array([0.55, 0.0, 0.0])
    p = p + np.array([0.55, 0.0, 0.0])
    sdf = signed_distance(ball.vertices, ball.faces, (24,) * 3, origin, h)
    true = brute_distance(np.asarray(ball.triangles), p[::3, ::3, ::3].reshape(-1, 3))
    assert (np.abs(sdf[::3, ::3, ::3]).ravel() <= true + 1e-6).all()
    assert ((sdf < 0) == (np.linalg.norm(p, axis=-1) < 1.0))[np.abs(np.linalg.norm(p, axis=-1) - 1) > 0.02].all()


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), int), "vertices"),
        (np.eye(3), np.zeros((0, 3), int), "faces"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], "not finite"),
        (np.eye(3), [[0, 1, 5]], "outside"),
        (np.eye(3), [[0, 1, 1]], "area"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "indices"),
    ],
)
def test_bad_meshes_are_refused_with_a_reason(vertices, faces, words):
    with pytest.raises(SceneError, match=words):
        signed_distance(vertices, faces, (4, 4, 4), (0, 0, 0), 0.1)


def test_progress_runs_to_one():
    seen: list[float] = []
    ball = sphere(1)
    origin, h, _ = centres(8, 2.6)
    signed_distance(ball.vertices, ball.faces, (8,) * 3, origin, h, seen.append)
    assert seen == sorted(seen) and seen[-1] == 1.0


@pytest.mark.skipif(not BUNNY.exists(), reason="the bunny is not on this machine")
def test_bunny_is_watertight_although_its_bottom_is_open():
    from scipy.ndimage import label

    mesh = trimesh.load(BUNNY, process=False)
    v, f = cleaned(mesh.vertices, mesh.faces)
    low, high = v.min(axis=0), v.max(axis=0)
    n = 40
    h = float((high - low).max() / (n - 6))
    origin = (low + high) / 2 - (n - 1) / 2 * h
    sdf = signed_distance(v, f, (n, n, n), origin, h)
    line = [origin[a] + np.arange(n) * h for a in range(3)]
    z, y, x = np.meshgrid(line[2], line[1], line[0], indexing="ij")
    sample = np.random.default_rng(5).integers(0, n**3, 1500)
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)[sample]
    w = brute_winding(v[f], points)
    np.testing.assert_array_equal(sdf.ravel()[sample] < 0, w > 0.5)
    # An ear thinner than a voxel may come apart; the body may not.
    pieces = np.bincount(label(sdf < 0)[0].ravel())[1:]
    assert pieces.max() > 0.999 * pieces.sum()
    assert label(sdf > 0)[1] == 1
    assert sign_changes_within_one_voxel(sdf, h)
    # The filled volume is the one the mesh's own triangles enclose, to the volume of the closing surface.
    assert (sdf < 0).sum() * h**3 == pytest.approx(abs(mesh.volume), rel=0.02)
