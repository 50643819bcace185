"""Sheets in a picture: what is mirrored, light, geometry, motion, files."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import Ripples
from pellucid.io.images import write_image
from pellucid.optics import fresnel_dielectric, opposite_factor
from pellucid.scene.sphere_maps import sphere_map
from pellucid.techniques.sheet.prepare import faces_of, picture_levels, vertices_of
from sheet_scenes import CAMERA, GREY, ONE, SIZE, N, drawn, level_hits, rays, shown, waves

RNG = np.random.default_rng(5)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


# ---- what is seen ----------------------------------------------------------------------------------------------


def test_the_top_of_the_picture_lies_towards_minus_z(renderer: pl.Renderer) -> None:
    picture = np.zeros((4, 4, 3), np.float32)
    picture[0, 0] = (1.0, 0.0, 0.0)  # upper left
    picture[3, 3] = (0.0, 1.0, 0.0)
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    found = drawn(renderer, above, (32, 32), picture=picture, reflection="none").radiance
    np.testing.assert_allclose(found[2, 2], (1.0, 0.0, 0.0), atol=2e-3)
    np.testing.assert_allclose(found[29, 29], (0.0, 1.0, 0.0), atol=2e-3)


def test_fresnels_law_or_a_fixed_share(renderer: pl.Renderer) -> None:
    _, _, reflectance = level_hits(CAMERA)
    exact = drawn(renderer)
    seen = np.isfinite(exact.depth)
    np.testing.assert_allclose(exact.radiance[..., 0][seen], (0.5 + 0.5 * reflectance)[seen], atol=2e-4)
    fixed = drawn(renderer, blend=0.3).radiance[..., 0][seen]
    np.testing.assert_allclose(fixed, 0.5 * 0.7 + 0.3, atol=2e-4)
    np.testing.assert_allclose(drawn(renderer, reflection="none").radiance[seen], 0.5, atol=2e-4)


def test_absorption_is_that_of_the_way_to_the_picture(renderer: pl.Renderer) -> None:
    frame = drawn(renderer, absorption=(0.0, 1.0, 4.0), reflection="none")
    p, xz, _ = level_hits(CAMERA)
    seen = np.isfinite(frame.depth) & (np.abs(xz) < 1.0).all(axis=-1)
    way = np.sqrt(((p[..., (0, 2)] - xz) ** 2).sum(axis=-1) + 0.4**2)[..., None]
    np.testing.assert_allclose(frame.radiance[seen], (0.5 * np.exp(-way * (0.0, 1.0, 4.0)))[seen], rtol=1e-3)


@pytest.mark.parametrize("rule", ["ball", "linear"])
def test_a_sphere_map_of_the_sky_shows_the_sky(renderer: pl.Renderer, rule: str) -> None:
    sky = pl.Environment.sky(40.0, 30.0, sun_disc=False)
    pictures = []
    for look in ({"reflection": "environment"}, {"reflection": "sphere_map", "sphere_map": sphere_map(sky, 512, rule)}):
        sheet = pl.RefractiveSheet(GREY * 0.0, waves=waves(), size_m=2.0, blend=1.0, sphere_rule=rule, **look)  # type: ignore[arg-type]
        frame = renderer.render(pl.Scene(CAMERA, sky, objects=[sheet]), SIZE)
        pictures.append(frame.radiance[np.isfinite(frame.depth)])
    assert pictures[0].std() > 0.01
    np.testing.assert_allclose(pictures[1], pictures[0], rtol=0.02, atol=0.002)


def test_from_below_there_is_snells_window_and_the_mirrored_picture(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.0, -0.2, 0.0), (0.0, 0.0, 0.0), up=(0, 0, -1), fov_deg=110)
    share, seen = shown(renderer, "uv", camera=camera, size_m=20.0)
    _, d = rays(camera)
    angle = np.degrees(np.arccos(np.clip(d[..., 1], -1.0, 1.0)))
    window = np.degrees(np.arcsin(1 / N))
    np.testing.assert_allclose(share[..., 2][seen & (angle > window + 0.1)], 1.0)
    inside = seen & (angle < window - 0.1)
    np.testing.assert_allclose(share[..., 2][inside], fresnel_dielectric(d[..., 1], N, 1.0)[inside], atol=1e-4)
    # Mirrored at the level: the ray goes 0.2 m up and 0.4 m down.
    beyond = seen & (angle > window + 0.1)
    xz = 0.6 * d[..., (0, 2)] / d[..., 1:2]
    np.testing.assert_allclose(share[..., :2][beyond], (xz[beyond] + 10.0) / 20.0, atol=2e-6)
    # Radiance in matter is n^2 times as large: a picture of 1 in a sky of 1 is n^2 everywhere.
    frame = drawn(renderer, camera, picture=np.ones((2, 2, 3), np.float32), size_m=20.0)
    np.testing.assert_allclose(frame.radiance[seen], N * N, rtol=1e-3)


def test_rays_that_rise_under_steep_waves_do_not_end_in_the_dark(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.1, -0.3, 1.2), (0.0, -0.05, -0.2), fov_deg=70)
    steep = waves(0.1)
    frame = drawn(renderer, camera, waves=steep, picture=np.ones((2, 2, 3), np.float32), absorption=(0.3, 0.3, 0.3))
    assert frame.radiance[np.isfinite(frame.depth)].min() > 0.02


def test_the_factor_from_below_undoes_the_one_from_above(renderer: pl.Renderer) -> None:
    camera = pl.Camera((0.0, -0.2, 0.0), up=(0, 0, -1), fov_deg=150)
    share, seen = shown(renderer, "uv", camera=camera, size_m=20.0, refraction="approximate", factor=N - 1.0)
    _, d = rays(camera)
    # i - k n passes as long as cos > -k
    passes = d[..., 1] > -float(opposite_factor(N - 1.0))
    window = seen & passes & (d[..., 1] > np.sqrt(1 - 1 / N**2))
    np.testing.assert_allclose(share[..., 2][window], fresnel_dielectric(d[..., 1], N, 1.0)[window], atol=1e-4)
    np.testing.assert_allclose(share[..., 2][seen & ~passes], 1.0)


def test_meshes_cut_the_sheet_and_are_seen_through_it(renderer: pl.Renderer) -> None:
    ball = pl.Mesh.sphere(0.25, emission=(5.0, 0.0, 0.0), base_color=(0, 0, 0), specular=0.0)
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    look: dict[str, Any] = {"picture": GREY, "depth_m": 0.6, "size_m": 2.0, "medium": N, "reflection": "none"}
    seen = {}
    for y, through in ((0.0, True), (-0.4, True), (-0.4, False), (-0.9, True)):
        scene = pl.Scene(
            above, ONE, objects=[pl.RefractiveSheet(**look, meshes=through), ball.replace(position=(0.0, y, 0.0))]
        )
        frame = renderer.render(scene, (32, 32))
        seen[y, through] = frame.radiance[16, 16, 0], frame.depth[16, 16]
    np.testing.assert_allclose(seen[0.0, True], (5.0, 2.75), atol=0.01)  # stands out of the sheet
    np.testing.assert_allclose(seen[-0.4, True], (5.0, 3.0), atol=0.01)
    np.testing.assert_allclose(seen[-0.4, False], (0.5, 3.0), atol=0.01)
    np.testing.assert_allclose(seen[-0.9, True], (0.5, 3.0), atol=0.01)  # below the picture


@pytest.mark.parametrize("albedo", [1.0, 0.5])
def test_a_lit_white_picture_under_a_level_sheet_vanishes(renderer: pl.Renderer, albedo: float) -> None:
    frame = drawn(renderer, picture=np.full((2, 2, 3), albedo), lit=True)
    seen = np.isfinite(frame.depth)
    if albedo == 1.0:
        np.testing.assert_allclose(frame.radiance[seen], 1.0, atol=1e-3)
    else:
        assert (frame.radiance[seen] < 0.6).all() and (frame.radiance[seen] > 0.2).all()


def test_a_lit_picture_has_the_light_of_a_lamp_through_the_sheet(renderer: pl.Renderer) -> None:
    lamp = pl.DirectionalLight((1.0, -1.0, 0.0), irradiance=2.0)
    sheet = pl.RefractiveSheet(np.full((2, 2, 3), 0.4), 0.5, 2.0, medium=N, lit=True, absorption=(0, 1, 2))
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=1.0)
    dark = pl.Environment.constant(0.0)
    found = renderer.render(pl.Scene(above, dark, [lamp], [sheet]), (16, 16)).radiance[8, 8]
    c, a = np.sqrt(0.5), np.array([0.0, 1.0, 2.0])
    inside = np.sqrt(1.0 - 0.5 / N**2)
    e = 2.0 * c * (1.0 - fresnel_dielectric(c, 1.0, N)) * np.exp(-a * 0.5 / inside)
    from pellucid.surroundings.diffuse import diffuse_shares

    back = diffuse_shares(N, np.exp(-a * 0.5))[1]
    leaves = (1.0 - fresnel_dielectric(1.0, N, 1.0)) / N**2 * np.exp(-a * 0.5)
    np.testing.assert_allclose(found, 0.4 * e / np.pi / (1.0 - 0.4 * back) * leaves, rtol=2e-3)


# ---- geometry and motion ---------------------------------------------------------------------------------------


def test_a_sheet_may_be_turned_and_enlarged(renderer: pl.Renderer) -> None:
    plain = drawn(renderer, waves=waves(), show="uv")
    # Turned by 90 degrees about y, x goes to -z and z to x.
    eye, target = (2.0 * np.array([v[2], v[1], -v[0]]) + (0, 5, 0) for v in (CAMERA.position, CAMERA.target))
    placed = {"rotation": (0, 90, 0), "scale": 2.0, "position": (0, 5, 0)}
    turned = drawn(renderer, pl.Camera(tuple(eye), tuple(target), fov_deg=38), waves=waves(), show="uv", **placed)
    np.testing.assert_allclose(turned.radiance, plain.radiance, atol=2e-5)
    np.testing.assert_allclose(turned.depth, 2.0 * plain.depth, rtol=1e-5)


def test_a_grid_faces_up_and_has_the_slopes_of_its_waves() -> None:
    x = (np.arange(128) + 0.5) / 128 * 2.0 - 1.0
    sheet = pl.RefractiveSheet(GREY, size_m=2.0, waves=np.broadcast_to(0.05 * np.sin(3 * x), (96, 128)), segments=32)
    vertices, faces = vertices_of(sheet, 0.0), faces_of(sheet)
    assert len(vertices) == 33 * 33 and faces.max() == len(vertices) - 1
    p = vertices["position"].astype(float)
    corner = p[faces]
    assert (np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 1] > 0.0).all()
    inner = np.abs(p[:, 0]) < 0.99
    np.testing.assert_allclose(p[inner, 1], 0.05 * np.sin(3 * p[inner, 0]), atol=5e-5)
    slope = -vertices["normal"][:, 0] / vertices["normal"][:, 1]
    np.testing.assert_allclose(slope[inner], 0.15 * np.cos(3 * p[inner, 0]), atol=2e-3)


def test_a_mesh_of_the_same_shape_is_the_same_sheet(renderer: pl.Renderer) -> None:
    grid = pl.RefractiveSheet(GREY, size_m=2.0, waves=waves(), segments=40)
    vertices = vertices_of(grid, 0.0)
    mesh = pl.Mesh(vertices["position"], faces_of(grid).astype(np.int32), vertices["normal"])
    first = drawn(renderer, waves=waves(), segments=40, show="uv")
    second = drawn(renderer, mesh=mesh, size_m=1.0, show="uv")
    np.testing.assert_allclose(second.radiance, first.radiance, atol=1e-6)


def test_levels_of_a_picture_keep_its_mean() -> None:
    picture = RNG.uniform(size=(12, 7, 3)).astype(np.float32)
    levels = picture_levels(picture)
    assert [level.shape for level in levels] == [(12, 7, 4), (6, 3, 4), (3, 1, 4), (1, 1, 4)]
    np.testing.assert_allclose(levels[-1][0, 0, :3], picture.mean(axis=(0, 1)), rtol=1e-5)


def test_waves_move_with_time_and_again_after_a_drop(renderer: pl.Renderer) -> None:
    water = Ripples((48, 48), 2.0 / 48, 0.4)
    camera = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    scene = pl.Scene(camera, ONE, objects=[pl.RefractiveSheet(GREY, 0.4, 2.0, water, show="uv")])
    calm = renderer.render(scene, (32, 32)).radiance
    water.drop(0.0, 0.0, 0.15, 0.03)
    dent, first, second, again = (renderer.render(scene, (32, 32), time=t).radiance for t in (0.0, 0.2, 0.6, 0.2))
    assert min(np.abs(a - b).max() for a, b in ((calm, dent), (dent, first), (first, second))) > 1e-3
    np.testing.assert_array_equal(first, again)


def test_heights_that_fail_in_motion_are_named(renderer: pl.Renderer) -> None:
    class Broken:
        shape, tile_m, limits_m = (4, 4), (1.0, 1.0), (0.0, 0.1)

        def advance(self, time_s: float) -> np.ndarray:
            return np.full((4, 4), np.nan if time_s > 1.0 else -0.5 if time_s > 0.5 else 0.0, np.float32)

    scene = pl.Scene(CAMERA, ONE, objects=[pl.RefractiveSheet(GREY, 0.4, waves=Broken())])
    renderer.render(scene, (8, 8))
    with pytest.raises(pl.SceneError, match="not finite"):
        renderer.render(scene, (8, 8), time=2.0)
    with pytest.raises(pl.SceneError, match="picture lies"):
        renderer.render(scene, (8, 8), time=0.7)


def test_what_moves_compiles_nothing(renderer: pl.Renderer) -> None:
    drawn(renderer, refraction="approximate")
    technique = renderer._techniques[pl.RefractiveSheet]
    before = len(technique.pipelines)
    looks: list[dict[str, Any]] = [
        {"factor": 0.7},
        {"medium": 1.5},
        {"blend": 0.2},
        {"depth_m": 1.0},
        {"borders": "shrink"},
    ]
    looks += [{"waves": waves()}, {"absorption": (1, 1, 1)}, {"rotation": (0, 30, 0)}, {"picture": GREY + 0.1}]
    for look in looks:
        drawn(renderer, refraction="approximate", **look)
    assert len(technique.pipelines) == before > 0
    assert renderer.nbytes > technique.nbytes > 0


def test_several_sheets_stand_in_one_scene(renderer: pl.Renderer) -> None:
    reds = np.array((1.0, 0.0, 0.0), np.float32) * np.ones((2, 2, 3), np.float32)
    sheets = [
        pl.RefractiveSheet(reds[..., order], medium=N, reflection="none", position=(x, 0.0, 0.0))
        for x, order in ((-0.6, (0, 1, 2)), (0.6, (2, 1, 0)))
    ]
    above = pl.Camera((0, 3, 0), up=(0, 0, -1), orthographic_height_m=2.0)
    renderer.render(pl.Scene(above, ONE, objects=[sheets[0], sheets[0]]), (32, 24))
    renderer.render(pl.Scene(above, ONE, objects=[sheets[1], sheets[0], sheets[0]]), (32, 24))
    found = renderer.render(pl.Scene(above, ONE, objects=sheets), (32, 24)).radiance
    np.testing.assert_allclose(found[12, 8], (1.0, 0.0, 0.0), atol=1e-3)
    np.testing.assert_allclose(found[12, 24], (0.0, 0.0, 1.0), atol=1e-3)


def test_the_sheet_of_the_article(renderer: pl.Renderer) -> None:
    sky = sphere_map(pl.Environment.sky(40.0), 64, "linear")
    sheet = pl.RefractiveSheet.article(GREY, sphere_map=sky, sphere_rule="linear", waves=waves(), size_m=2.0)
    assert (sheet.refraction, sheet.per, sheet.borders) == ("approximate", "vertex", "clamp")
    assert (sheet.reflection, sheet.blend) == ("sphere_map", 0.3)
    assert pl.RefractiveSheet.article(GREY).reflection == "none"
    frame = renderer.render(pl.Scene(CAMERA, ONE, objects=[sheet]), SIZE)
    assert np.isfinite(frame.radiance).all() and frame.radiance[np.isfinite(frame.depth)].std() > 0.001


def test_a_scene_file_renders_from_the_command_line(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from pellucid.cli.app import app

    write_image(tmp_path / "floor.png", RNG.integers(0, 255, (8, 8, 3)).astype(np.uint8))
    np.savez(tmp_path / "pond.npz", waves=waves())
    text = """
        [camera]
        position = [0.5, 1.1, 1.3]
        [[objects]]
        type = "refractive_sheet"
        picture = "floor.png"
        depth_m = 0.3
        size_m = [2, 1.5]
        arrays = "pond.npz"
        refraction = "approximate"
    """
    assert tomllib.loads(text)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    out = tmp_path / "scene.png"
    run = CliRunner().invoke(app, ["render", str(tmp_path / "scene.toml"), "-o", str(out), "--size", "48x36"])
    assert run.exit_code == 0, run.output
    assert out.stat().st_size > 500
