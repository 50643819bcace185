"""Charts hold every surface within reach once, and the tents of their texels weigh it exactly."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.scene import Mesh
from pellucid.surroundings import Reach, geometry
from pellucid.surroundings.charts import Charts, build_charts
from pellucid.surroundings.coverage import covered_area

EVERYWHERE = Reach((0.0, 5.0, 0.0), 100.0, 0.1)


def charts(*meshes: Mesh, reach: Reach = EVERYWHERE, texel_m: float = 0.02, most: int = 1 << 20) -> Charts:
    triangles = geometry.gather(meshes).triangles
    corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1)
    mesh, single = triangles["material"].astype(int), triangles["single_sided"] != 0
    return build_charts(corners, mesh, single, [reach], texel_m, most)


def surface_m2(found: Charts) -> float:
    """Of all texels of the finest level."""
    return float(found.area_m2[found.owner > 0].sum(dtype=float))


def hills(side: int) -> Mesh:
    x, z = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
    place = np.arange(side * side).reshape(side, side)
    a, b, c, d = place[:-1, :-1], place[1:, :-1], place[:-1, 1:], place[1:, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (b, d, c))])
    return Mesh(np.stack([x, 0.1 * np.sin(4 * x) * np.cos(3 * z), z], -1).reshape(-1, 3), faces)


def test_a_rectangle_is_one_chart_and_fills_it_however_it_lies() -> None:
    for rotation in ((0, 0, 0), (0, 30, 0), (25, 45, 10)):
        found = charts(Mesh.plane(1.0, rotation=rotation))
        assert len(found.table) == 1 and (found.front == 1).all()
        np.testing.assert_allclose(surface_m2(found), 1.0, rtol=1e-6)
    square = charts(Mesh.plane(1.0))
    np.testing.assert_allclose(square.area_m2[square.owner > 0], 0.02**2, rtol=1e-5)


def test_every_face_of_a_box_has_a_chart_of_its_own() -> None:
    for rotation in ((0, 0, 0), (0, 45, 0), (35.26, 0, 45)):
        box = Mesh.box(1.0, rotation=rotation, double_sided=False)
        around = Reach((0.0, 0.0, 0.0), 100.0, 50.0)
        found = charts(box, reach=around)
        assert len(found.table) == 6 and sorted(found.front) == [k for k in range(1, 7) for _ in range(2)]
        np.testing.assert_allclose(surface_m2(found), 6.0, rtol=1e-6)


def test_a_smooth_surface_takes_few_charts_and_keeps_its_area() -> None:
    for mesh, most in ((hills(60), 1), (Mesh.sphere(1.0), 6)):
        triangles = geometry.gather([mesh]).triangles
        corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1).astype(float)
        area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        found = charts(mesh.replace(double_sided=False), reach=Reach((0, 5, 0), 100.0, 50.0))
        assert len(found.table) <= most and (found.front > 0).all()
        np.testing.assert_allclose(surface_m2(found), area.sum(), rtol=1e-5)


def test_a_large_floor_is_cut_off_where_no_light_can_land() -> None:
    reach = Reach((3.0, 1.0, -2.0), 1.25, 0.5)
    found = charts(Mesh.plane(1000.0), reach=reach, texel_m=0.05)
    row = found.table[0]
    np.testing.assert_allclose(row[10:12] - row[8:10], 30)  # a square around the circle of radius 0.75
    np.testing.assert_allclose(surface_m2(found), 1.5**2, rtol=1e-5)
    centre = row[:8].reshape(2, 4) @ [3.0, 0.0, -2.0, 1.0]
    np.testing.assert_allclose(centre, 0.5 * (row[8:10] + row[10:12]), atol=1e-3)


def test_what_is_out_of_reach_or_turned_away_has_no_chart() -> None:
    far = charts(Mesh.plane(1.0), Mesh.plane(1.0, position=(200, 0, 0)))
    assert sorted(far.front) == [0, 0, 1, 1]
    sheet = charts(Mesh.plane(1.0), reach=Reach((0, 5, 0), 100.0, 0.1))
    assert (sheet.front > 0).all() and (sheet.back == 0).all()
    cut = charts(Mesh.plane(1.0), reach=Reach((0, 0.05, 0), 100.0, 0.1))
    assert (cut.front == 1).all() and (cut.back == 2).all()
    ball = charts(Mesh.sphere(1.0), reach=Reach((0, 1.2, 0), 100.0, 1.0))
    assert (ball.back == 0).all() and (ball.front > 0).any()
    room = charts(Mesh.box(4.0), reach=Reach((0, 0, 0), 100.0, 1.0))
    assert (room.front == 0).all() and (room.back > 0).all()
    assert charts(Mesh.plane(1.0), reach=Reach((0, 5, 0), 4.0, 1.0)).size == (1, 1)


def test_texels_are_made_larger_until_the_atlas_fits() -> None:
    found = charts(Mesh.plane(1.0), Mesh.sphere(0.5, position=(2, 0, 0)), texel_m=0.001, most=10_000)
    assert found.size[0] * found.size[1] <= 10_000 and found.texel_m > 0.01
    soup = np.random.default_rng(0).normal(size=(500, 1, 3)) + 0.001 * np.random.default_rng(1).normal(size=(500, 3, 3))
    crowd = charts(Mesh(soup.reshape(-1, 3), np.arange(1500).reshape(-1, 3), shading="flat"), most=10)
    assert crowd.size[0] * crowd.size[1] <= 1200 and len(crowd.table) >= 400  # a texel each, at the least


def test_charts_do_not_overlap() -> None:
    found = charts(hills(20), Mesh.sphere(0.3, position=(0, 1, 0)), Mesh.box(0.4, position=(0, 0.8, 1)))
    taken = np.zeros(found.size[::-1], int)
    rectangles = np.unique(found.table[:, 8:].reshape(-1, 4).astype(int), axis=0)
    for x0, y0, x1, y1 in rectangles:
        taken[y0:y1, x0:x1] += 1
    assert taken.max() == 1 and (found.area_m2[taken == 0] == 0).all()
    for chart, (x0, y0, x1, y1) in enumerate(found.table[:, 8:12].astype(int), start=1):
        assert (found.owner[y0:y1, x0:x1] == chart).all()


def test_every_level_weighs_the_same_surface() -> None:
    found = charts(hills(40), Mesh.plane(1.0, position=(0, -1, 0), rotation=(0, 20, 0)))
    for chart in found.table[:, 8:].reshape(len(found.table), -1, 4).astype(int):
        areas = [found.area_m2[y0:y1, x0:x1].sum(dtype=float) for x0, y0, x1, y1 in chart]
        np.testing.assert_allclose(areas, areas[0], rtol=1e-6)
        assert (chart[1, 2:] - chart[1, :2] < chart[0, 2:] - chart[0, :2]).all()


def test_covered_area_equals_sampling() -> None:
    """Against many points: each shares its area among the four texels around it, clamped to the chart."""
    rng = np.random.default_rng(3)
    corners = rng.uniform(-2, 9, (6, 3, 2))
    low, high = np.broadcast_to([1.0, 2.0], (6, 2)), np.broadcast_to([7.0, 6.0], (6, 2))
    found = covered_area(corners, np.full(6, 2.0), low, high, (8, 9))
    side = 400
    cells = (
        np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2) + rng.random((side**2, 2))
    ) / side
    folded = np.where(cells.sum(axis=1, keepdims=True) > 1, 1 - cells, cells)
    expected = np.zeros((9, 8))
    for a, b, c in corners:
        p = a + folded[:, :1] * (b - a) + folded[:, 1:] * (c - a)
        p = p[((p > low[0]) & (p < high[0])).all(axis=1)]
        base = np.floor(p - 0.5)
        for i in (0, 1):
            for j in (0, 1):
                weight = np.abs(1 - i - (p - 0.5 - base)[:, 0]) * np.abs(1 - j - (p - 0.5 - base)[:, 1])
                x, y = np.clip(base + np.array([i, j]), low[0], high[0] - 1).astype(int).T
                np.add.at(expected, (y, x), 2.0 * weight / side**2)
    np.testing.assert_allclose(found, expected, atol=5e-4 * expected.max())


@pytest.mark.parametrize("texel_m", [0.0, -1.0, np.nan, np.inf])
def test_a_texel_has_a_size(texel_m: float) -> None:
    with pytest.raises(SceneError, match="texel_m"):
        charts(Mesh.plane(1.0), texel_m=texel_m)


@pytest.mark.parametrize("values", [((0, 0, np.nan), 1, 1), ((0, 0, 0), 0, 1), ((0, 0, 0), 1, -1)])
def test_a_reach_is_a_ball(values: tuple[object, float, float]) -> None:
    with pytest.raises(SceneError, match=r"reach\."):
        Reach(*values)  # type: ignore[arg-type]
