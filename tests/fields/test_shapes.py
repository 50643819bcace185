"""Analytic shapes: exact where they say so, never more than the distance elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from pellucid.errors import SceneError
from pellucid.fields import shapes
from pellucid.fields.volume import Volume

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
PROFILE = [(0.0, -0.5), (0.4, -0.45), (0.15, 0.0), (0.5, 0.4), (0.0, 0.3)]
STAR = [(0.0, 0.5), (-0.1, 0.1), (-0.5, 0.0), (-0.1, -0.1), (0.0, -0.5), (0.1, -0.1), (0.5, 0.0), (0.1, 0.1)]

EXACT = {
    "sphere": shapes.sphere(0.4),
    "box": shapes.box((0.5, 0.7, 0.3)),
    "rounded_box": shapes.rounded_box((0.8, 0.6, 0.5), 0.1),
    "cylinder": shapes.cylinder(0.3, 0.7),
    "capsule": shapes.capsule((-0.3, 0, 0.1), (0.3, 0.2, 0), 0.2),
    "torus": shapes.torus(0.35, 0.1),
    "plane": shapes.plane((1, 2, 3), 0.1),
    "prism": shapes.prism(0.7, 0.8),
    "lathe": shapes.lathe(PROFILE),
    "extruded_star": shapes.extruded_polygon(STAR, 0.5),
    "moved": shapes.moved(shapes.box(0.5), (0.1, 0.2, -0.1)),
    "rotated": shapes.rotated(shapes.box((0.5, 0.7, 0.3)), TURN),
}
BOUNDS = {
    "brilliant": shapes.brilliant_cut(1.0),
    "emerald": shapes.emerald_cut(1.2, 0.9),
    "rhombohedron": shapes.rhombohedron(0.8)[0],
    "difference": shapes.difference(shapes.box(0.8), shapes.sphere(0.45)),
    "intersection": shapes.intersection(shapes.box(0.8), shapes.sphere(0.5)),
    "smooth_union": shapes.smooth_union(0.1, shapes.box(0.5), shapes.moved(shapes.sphere(0.3), (0.3, 0, 0))),
    "lettering": shapes.lettering("P2", 0.9, 0.4),
    "embossed": shapes.embossed_block("GO", (1.0, 0.5, 0.3), 0.3, 0.05),
    "engraved": shapes.embossed_block("GO", (1.0, 0.5, 0.3), 0.3, 0.05, engraved=True),
    "glass": shapes.wine_glass(1.4, wall_m=0.05)[0],
    "wine": shapes.wine_glass(1.4, wall_m=0.05)[1],
}


def points(n=20000, seed=0, half=0.8):
    return np.random.default_rng(seed).uniform(-half, half, size=(3, n))


def gradient(f, p, step=1e-6):
    parts = []
    for axis in range(3):
        offset = np.zeros((3, 1))
        offset[axis] = step
        parts.append((f(*(p + offset)) - f(*(p - offset))) / (2 * step))
    return np.stack(parts)


@pytest.mark.parametrize("name", EXACT)
def test_exact_shapes_reach_their_surface_along_the_gradient(name):
    f = EXACT[name]
    p = points(4000)
    d, g = f(*p), gradient(f, p)
    smooth = np.abs(np.linalg.norm(g, axis=0) - 1) < 1e-6  # all but the medial axis
    assert smooth.mean() > 0.98
    foot = p - d * g / np.linalg.norm(g, axis=0)
    assert np.abs(f(*foot[:, smooth])).max() < 2e-5


@pytest.mark.parametrize("name", [*EXACT, *BOUNDS])
def test_no_shape_exceeds_the_distance_to_the_other_side(name):
    f = (EXACT | BOUNDS)[name]
    rng = np.random.default_rng(1)
    p = points(60000, seed=2, half=0.75)
    q = p + rng.normal(size=p.shape) * rng.uniform(0.005, 0.3, size=p.shape[1])
    a, b = f(*p), f(*q)
    other = (a < 0) != (b < 0)
    assert other.sum() > 300
    slack = np.abs(a) + np.abs(b) - np.linalg.norm(p - q, axis=0)
    assert slack[other].max() < 1e-9


@pytest.mark.parametrize("name", ["brilliant", "emerald"])
def test_stones_are_exact_inside_and_every_facet_is_there(name):
    planes = {
        "brilliant": shapes.brilliant_planes(1.0),
        "emerald": shapes.emerald_planes(1.2, 0.9),
    }[name]
    normals, offsets = planes
    assert normals.shape == (57, 3) and (offsets > 0).all()
    # A facet is there if some direction from the origin leaves the stone through its plane.
    rng = np.random.default_rng(0)
    direction = rng.normal(size=(150000, 3))
    if name == "brilliant":
        normals = np.concatenate([normals, [[np.cos(a), 0, np.sin(a)] for a in np.arange(64) * np.pi / 32]])
        offsets = np.concatenate([offsets, np.full(64, 0.5)])
    speed = direction @ normals.T
    reach = np.where(speed > 0, offsets / np.where(speed > 0, speed, 1), np.inf)
    assert set(range(57)) <= set(np.unique(reach.argmin(axis=1)))


def test_brilliant_has_the_proportions_of_tolkowsky():
    f = shapes.brilliant_cut(1.0)
    y = np.linspace(-0.6, 0.4, 100001)
    inside = y[f(0 * y, y, 0 * y) < 0]
    crown, pavilion = inside[-1] - 0.01, -inside[0] - 0.01
    assert crown == pytest.approx(0.162, abs=1e-3)
    assert pavilion == pytest.approx(0.431, abs=1e-3)


def test_lathe_of_a_half_disc_is_a_sphere_also_on_its_axis():
    turn = np.linspace(-np.pi / 2, np.pi / 2, 721)
    f = shapes.lathe(np.column_stack([np.cos(turn).clip(0), np.sin(turn)]))
    p = points(2000, half=1.5)
    p[0, :200] = p[2, :200] = 0.0
    assert np.abs(f(*p) - (np.linalg.norm(p, axis=0) - 1)).max() < 1e-5


def test_lathe_gives_a_grid_the_same_values_as_single_points():
    f = EXACT["lathe"]
    line = np.linspace(-0.7, 0.7, 12)
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    np.testing.assert_allclose(
        f(x, y, z).ravel()[:40],
        [f(*p) for p in zip(x.ravel()[:40], y.ravel()[:40], z.ravel()[:40], strict=True)],
        atol=1e-12,
    )


def test_smooth_curve_passes_its_knots():
    knots = np.array([(0, 0), (1, 0.5), (1.2, 2), (3, 2.2)])
    curve = shapes.smooth_curve(knots, samples=10)
    np.testing.assert_allclose(curve[::10], knots, atol=1e-12)


def test_wine_wets_the_wall_and_has_a_level_top():
    glass, wine = shapes.wine_glass(0.22)
    rng = np.random.default_rng(0)
    y = rng.uniform(-0.02, 0.02, 60000)
    r, turn = np.sqrt(rng.uniform(0, 0.045**2, y.size)), rng.uniform(0, 2 * np.pi, y.size)
    x, z = r * np.cos(turn), r * np.sin(turn)
    both = (glass(x, y, z) < 0) & (wine(x, y, z) < 0)
    assert both.any()
    assert -glass(x, y, z)[both].max() < 0.22 / 90 / 4
    top = y[wine(x, y, z) < 0].max()
    # Below the level, everything within the bowl is glass or wine: no air between.
    low = (y < top - 1e-4) & (y > top - 0.008) & (r < 0.034)
    assert (np.minimum(glass(x, y, z), wine(x, y, z))[low] < 0).all()


def test_glass_wall_is_as_thick_as_asked():
    glass, _ = shapes.wine_glass(0.22, wall_m=0.002)
    x = np.linspace(0, 0.06, 60001)
    inside = glass(x, 0 * x + 0.03, 0 * x) < 0
    assert inside.sum() * 1e-6 == pytest.approx(0.002, rel=0.02)


def test_nested_cubes_leave_the_same_shell_everywhere():
    inner, middle, outer = shapes.nested_rounded_cubes(0.1, 0.01)
    zero = np.zeros(1)
    assert outer(zero + 0.05, zero, zero) == pytest.approx(0, abs=1e-12)
    assert middle(zero + 0.04, zero, zero) == pytest.approx(0, abs=1e-12)
    assert inner(zero + 0.03, zero, zero) == pytest.approx(0, abs=1e-12)
    volume = Volume.from_regions([(inner, 1.33), (middle, 1.0), (outer, 1.5)], 24, 0.12)
    assert len(volume.regions) == 3


def test_every_letter_has_ink_inside_its_cell():
    for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-.":
        line = np.linspace(-0.5, 0.5, 101)
        y, x = np.meshgrid(line, line, indexing="ij")
        ink = shapes.lettering(letter, 1.0, 0.2)(x, y, 0 * x) < 0
        assert 0.005 < ink.mean() < 0.5
        assert not ink[:, 0].any() and not ink[:, -1].any()


def test_letters_are_joined_for_a_grid_and_single_points_alike():
    f = shapes.lettering("PELLUCID", 0.2, 0.3, rounding_m=0.01)
    line = np.linspace(-0.8, 0.8, 16)
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    np.testing.assert_allclose(f(x, y, z).ravel(), f(x.ravel(), y.ravel(), z.ravel()), atol=1e-12)


def test_creature_is_one_closed_smooth_body():
    vertices, faces = shapes.creature_mesh(0.2, resolution=48)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.body_count == 1 and mesh.volume > 0
    assert mesh.extents[1] == pytest.approx(0.2, rel=0.1)
    assert np.abs(shapes.creature(0.2)(*vertices.T)).max() < 1e-5


def test_graded_indices_are_what_the_formulas_say():
    r = np.array([0.0, 0.5, 1.0, 2.0])
    zero = np.zeros(4)
    np.testing.assert_allclose(shapes.luneburg(1.0)(r, zero, zero) ** 2, [2, 1.75, 1, 1])
    np.testing.assert_allclose(shapes.maxwell_fish_eye(1.0)(zero, r, zero), [2, 1.6, 1, 1])
    rod = shapes.grin_rod(1.6, 0.5, 1.0)
    np.testing.assert_allclose(rod(r, zero, r) ** 2, 1.6**2 * (1 - 0.25 * np.array([0, 0.25, 1, 1])))


def test_hot_air_is_thinner_by_the_ratio_of_temperatures():
    air = shapes.hot_air(0.02, 0.4, warmer_k=58.63, ambient_k=293.15, refractivity=2.72e-4)
    n = air(np.array([0.0, 1.0]), np.array([-0.2, -0.2]), np.array([0.0, 0.0]))
    np.testing.assert_allclose(n - 1, [2.72e-4 / 1.2, 2.72e-4], rtol=1e-10)
    volume = Volume.from_function(air, 24, 0.4, ambient_n=1 + 2.72e-4)
    assert -2.72e-4 < volume.delta_n.min() < -1e-5 and volume.delta_n.max() <= 0


@pytest.mark.parametrize(
    "make",
    [
        lambda: shapes.sphere(-1),
        lambda: shapes.rounded_box(1.0, 0.6),
        lambda: shapes.plane((0, 0, 0)),
        lambda: shapes.rotated(shapes.box(1), 2 * np.eye(3)),
        lambda: shapes.union(),
        lambda: shapes.lathe([(0, 0), (1, 0)]),
        lambda: shapes.lathe([(0, 0), (-1, 0), (0, 1)]),
        lambda: shapes.lettering("£", 1, 1),
        lambda: shapes.lettering("  ", 1, 1),
        lambda: shapes.embossed_block("WIDE", (1, 1, 1), 0.9, 0.1),
        lambda: shapes.brilliant_cut(1.0, table=2.0),
        lambda: shapes.emerald_cut(1.0, 2.0),
        lambda: shapes.wine_glass(0.2, filled=2.0),
        lambda: shapes.nested_rounded_cubes(0.1, 0.05),
        lambda: shapes.grin_rod(1.5, 2.0, 1.0),
        lambda: shapes.hot_air(0.1, 1.0, warmer_k=-400),
        lambda: shapes.creature_mesh(0.2, resolution=2),
    ],
)
def test_impossible_shapes_are_refused(make):
    with pytest.raises(SceneError):
        make()


def test_a_cleavage_rhomb_of_calcite():
    """One edge lies along x, the others are turned by thirds about the axis; angles of 101.9 degrees, 8 corners."""
    shape, axis = shapes.rhombohedron(0.8)
    k = np.cross(np.eye(3), -axis)
    third = np.eye(3) + np.sin(np.radians(120)) * k + (1 - np.cos(np.radians(120))) * k @ k
    edges = np.array([[1.0, 0.0, 0.0], third @ [1.0, 0.0, 0.0], third @ third @ [1.0, 0.0, 0.0]])
    assert np.degrees(np.arccos(edges[0] @ edges[1])) == pytest.approx(101.9)
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    for corner in 0.4 * signs @ edges:
        assert abs(shape(*corner)) < 1e-12 and shape(*(0.99 * corner)) < 0.0
    middles = 0.4 * np.concatenate([edges, -edges])  # of the faces
    assert np.abs(shape(*middles.T)).max() < 1e-12
    assert sum(abs(middle[1]) > 0.3 for middle in middles) == 2, "one face is up and one is down"
    with pytest.raises(SceneError, match="blunt_deg"):
        shapes.rhombohedron(0.8, 80.0)
