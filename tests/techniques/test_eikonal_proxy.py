"""Proxies of volumes: the same picture as with the box, fewer rays, and no matter left outside."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import shapes
from pellucid.techniques.eikonal.hulls import PLANES, SPHERE, hull_of
from pellucid.techniques.eikonal.prepare import prepare

SIZE = (120, 90)
CAMERA = pl.Camera(position=(0.02, 0.07, 0.22), target=(0.0, 0.0, 0.0), fov_deg=30.0)
BALL_MESH = pl.Mesh.sphere(0.04, segments=24)
KNOT = pl.Mesh.box((0.05, 0.03, 0.04))


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


def picture(renderer, item):
    floor = pl.Mesh.checkerboard(0.5, position=(0, -0.045, 0))
    scene = pl.Scene(camera=CAMERA, objects=[floor, item], lights=[pl.DirectionalLight((0.5, -1.0, -0.3))])
    return renderer.render(scene, SIZE)


def changed(one, other):
    """Share of the pixels that differ: edges behind glass move by parts of a pixel with any rounding."""
    return np.mean(np.abs(one.radiance - other.radiance).max(axis=2) > 0.02)


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
@pytest.mark.parametrize("proxy", ["sphere", BALL_MESH], ids=["sphere", "mesh"])
def test_a_proxy_changes_no_picture(renderer, boundary, proxy):
    ball = pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, 64, 0.12)
    item = pl.RefractiveVolume(ball, boundary=boundary, rotation=(10, 20, 30), position=(0.005, 0, 0))
    whole, tight = picture(renderer, item), picture(renderer, item.replace(proxy=proxy))
    # From another start a sharp ray is rounded in another way, and a smooth one takes other steps.
    assert changed(whole, tight) < (4e-3 if boundary == "sharp" else 0.03)
    assert (np.isfinite(whole.depth) == np.isfinite(tight.depth)).mean() > 0.999


def test_the_mesh_of_a_body_is_a_proxy_where_the_body_stands(renderer):
    moved = KNOT.vertices + np.array([0.02, 0.01, 0.0])
    item = pl.RefractiveVolume.from_mesh((moved, KNOT.faces), 1.5, 48, position=(-0.02, 0, 0))
    own = item.replace(proxy=pl.Mesh(moved, KNOT.faces, shading="flat"))
    whole = picture(renderer, item)
    rounding = changed(whole, picture(renderer, item.replace(position=(-0.02, 1e-6, 0))))
    assert changed(whole, picture(renderer, own)) < max(2.0 * rounding, 6e-3)
    hull = hull_of(prepare(item.volume, "sharp"), own.proxy, own.center_m)
    assert hull.kind == PLANES and len(hull.planes) == 6


def test_half_spaces_hold_the_mesh_and_little_more():
    ball = pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, 64, 0.12)
    hull = hull_of(prepare(ball, "sharp"), BALL_MESH, (0.0, 0.0, 0.0))
    assert len(hull.planes) == 26
    assert (BALL_MESH.vertices @ hull.planes[:, :3].T <= hull.planes[:, 3]).all()
    assert (hull.planes[:, 3] < 0.04 + 2.1 * 0.12 / 64).all()
    round_ = hull_of(prepare(ball, "sharp"), "sphere", (0.0, 0.0, 0.0))
    assert round_.kind == SPHERE and 0.04 < round_.sphere[3] < 0.04 + 3 * 0.12 / 64


def test_matter_outside_a_proxy_is_counted(renderer):
    ball = pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, 48, 0.1)
    with pytest.raises(pl.SceneError, match=r"refractive_volume.proxy: leaves \d+ of \d+ voxels of matter outside"):
        picture(renderer, pl.RefractiveVolume(ball, proxy=pl.Mesh.sphere(0.03)))
    with pytest.raises(pl.SceneError, match=r"refractive_volume\.proxy"):
        pl.RefractiveVolume(ball, proxy="cylinder")


def test_smoke_around_a_body_is_matter(renderer):
    ball = pl.Volume.from_sdf(shapes.sphere(0.02), 1.5, 32, 0.1)
    smoke = ball.replace(scattering=np.full((*ball.shape, 3), 0.5))
    with pytest.raises(pl.SceneError, match=r"refractive_volume\.proxy"):
        hull_of(prepare(smoke, "sharp"), pl.Mesh.sphere(0.025), (0.0, 0.0, 0.0))
    assert hull_of(prepare(smoke, "sharp"), "sphere", (0.0, 0.0, 0.0)).sphere[3] > 0.08
