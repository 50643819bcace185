"""The hierarchy holds every triangle once, encloses it, and finds the same hits as trying all triangles."""

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.surroundings import bvh
from surroundings.brute_force import brute_force_hits, random_triangles


def walk(tree: bvh.Bvh, triangles: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> float:
    """Descend the flattened tree as the shader does."""
    stack, nearest = [0], np.inf
    ordered = triangles[tree.order]
    while stack:
        i = stack.pop()
        with np.errstate(divide="ignore"):
            t = np.sort((np.stack([tree.lower[i], tree.upper[i]]) - origin) / direction, axis=0)
        if t[0].max() > t[1].min() + 1e-9 or t[1].min() < 0:
            continue
        if tree.count[i]:
            leaf = ordered[tree.link[i] : tree.link[i] + tree.count[i]]
            nearest = min(nearest, brute_force_hits(leaf, origin[None], direction[None])[0])
        else:
            stack += [i + 1, int(tree.link[i])]
    return nearest


@pytest.mark.parametrize("count", [1, 2, 5, 333])
def test_walking_the_tree_finds_the_hits_of_brute_force(count: int) -> None:
    triangles = random_triangles(count, size=0.3).astype(np.float32)
    tree = bvh.build(triangles)
    rng = np.random.default_rng(1)
    origins, directions = rng.uniform(-2, 2, (60, 3)), rng.normal(size=(60, 3))
    expected = brute_force_hits(triangles, origins, directions)
    found = [walk(tree, triangles, o, d) for o, d in zip(origins, directions, strict=True)]
    assert count < 100 or np.isfinite(expected).sum() > 5
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_every_triangle_stands_in_one_leaf_that_encloses_it() -> None:
    triangles = random_triangles(2000).astype(np.float32)
    tree = bvh.build(triangles)
    assert sorted(tree.order) == list(range(2000))
    leaves = np.flatnonzero(tree.count)
    places = np.concatenate([np.arange(tree.link[i], tree.link[i] + tree.count[i]) for i in leaves])
    assert sorted(places) == list(range(2000))
    for i in leaves:
        corners = triangles[tree.order[tree.link[i] : tree.link[i] + tree.count[i]]].reshape(-1, 3)
        assert (corners >= tree.lower[i]).all() and (corners <= tree.upper[i]).all()


def test_a_node_is_the_union_of_its_children() -> None:
    tree = bvh.build(random_triangles(1000))
    inner = np.flatnonzero(tree.count == 0)
    left, right = inner + 1, tree.link[inner]
    np.testing.assert_array_equal(tree.lower[inner], np.minimum(tree.lower[left], tree.lower[right]))
    np.testing.assert_array_equal(tree.upper[inner], np.maximum(tree.upper[left], tree.upper[right]))


def test_depth_stays_below_the_shader_stack_where_splits_by_area_would_degenerate() -> None:
    scale = 4.0 ** -np.arange(60)[:, None, None]  # each triangle four times smaller and nearer to the origin
    shrinking = np.repeat(scale * np.array([[[1, 0, 0], [1, 0.5, 0], [1, 0, 0.5]]]), 40, axis=0)
    same_place = np.zeros((5000, 3, 3))
    for triangles in (shrinking, same_place, np.concatenate([shrinking, same_place])):
        assert bvh.build(triangles).depth <= bvh.MAX_DEPTH


def test_surface_area_heuristic_beats_splitting_in_halves() -> None:
    """Expected box tests per random ray (MacDonald & Booth 1990) fall by at least a fifth on uneven matter."""
    rng = np.random.default_rng(2)
    clumps = np.concatenate([random_triangles(2000, s, 0.01) * 0.05 + rng.uniform(-1, 1, 3) for s in range(8)])
    large = random_triangles(200, 20, 0.5)
    triangles = np.concatenate([clumps, large])

    def cost(tree: bvh.Bvh) -> float:
        size = tree.upper.astype(float) - tree.lower
        area = size[:, 0] * size[:, 1] + size[:, 1] * size[:, 2] + size[:, 2] * size[:, 0]
        return float((area * np.maximum(tree.count, 1)).sum() / area[0])

    by_area = cost(bvh.build(triangles))
    original, bvh._sah_sides = bvh._sah_sides, lambda lower, upper, centroid, node, nodes: np.zeros(len(node), bool)
    try:
        by_halves = cost(bvh.build(triangles))
    finally:
        bvh._sah_sides = original
    assert by_area < 0.8 * by_halves


@pytest.mark.parametrize(
    "triangles", [np.zeros((0, 3, 3)), np.zeros((4, 3)), np.full((1, 3, 3), np.nan)], ids=["none", "shape", "nan"]
)
def test_bad_triangles_are_refused(triangles: np.ndarray) -> None:
    with pytest.raises(SceneError):
        bvh.build(triangles)
