"""Rays go on: volumes seen through one another, in a row, nested, in smoke, between meshes."""

from __future__ import annotations

import numpy as np
import pytest

import oracles
import pellucid as pl
from pellucid.fields import shapes
from pellucid.fields.reaching import interfere, matter_of
from pellucid.techniques.eikonal.relay import BODIES_IN_A_ROW

SIZE = (160, 120)
CAMERA = pl.Camera(position=(0.05, 0.06, 0.3), target=(0.0, 0.0, 0.0), fov_deg=26.0)
WHITE = pl.Environment.constant((1.0, 1.0, 1.0))


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture(scope="module")
def ball():
    return pl.Volume.from_sdf(shapes.sphere(0.03), 1.5, 64, 0.07)


def scene(*objects, environment=None, camera=CAMERA):
    return pl.Scene(camera=camera, environment=environment or pl.Environment.studio(), objects=objects)


def bodies(renderer):
    (technique,) = renderer._techniques.values()
    return technique.bodies


FLOOR = pl.Mesh.checkerboard(1.0, squares=20, position=(0, -0.05, 0))


# ---- apart --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("position", [(0.02, 0.02, 0.4), (0.3, 0.1, 0.2)])
def test_two_balls_look_as_in_one_volume_whichever_is_listed_first(renderer, ball, position):
    """One before the other: through the nearer the farther is seen, and each in the mirror of the other."""
    camera = pl.Camera(position=position, target=(0, 0, 0), fov_deg=24)
    near, far = pl.RefractiveVolume(ball, position=(0, 0, 0.04)), pl.RefractiveVolume(ball, position=(0.01, 0, -0.04))
    one = shapes.sphere(0.03)
    both = pl.RefractiveVolume.from_sdf(
        lambda x, y, z: np.minimum(one(x, y, z - 0.04), one(x - 0.01, y, z + 0.04)), 1.5, 150, (0.09, 0.07, 0.165)
    )
    apart = renderer.render(scene(FLOOR, near, far, camera=camera), SIZE)
    assert len(bodies(renderer)) == 2
    swapped = renderer.render(scene(FLOOR, far, near, camera=camera), SIZE)
    together = renderer.render(scene(FLOOR, both, camera=camera), SIZE)
    assert (apart.radiance == swapped.radiance).all() and (apart.depth == swapped.depth).all()
    error = np.abs(apart.radiance - together.radiance).max(axis=2)
    assert np.mean(error) < 2e-3 and np.quantile(error, 0.95) < 5e-3, f"mean {np.mean(error):.1e}"
    seen = np.isfinite(apart.depth) & np.isfinite(together.depth)
    assert np.quantile(np.abs(apart.depth[seen] - together.depth[seen]), 0.99) < 1e-4


def test_a_ball_behind_a_slab_refracts_as_snell_says(renderer):
    """A wall whose red grows from left to right tells where each ray arrives, against rays in float64."""
    n_slab, n_ball, radius, wall_z, tilt = 1.6, 1.5, 0.04, -0.08, 25.0
    ramp = np.linspace(0.0, 1.0, 256, dtype=np.float32)
    pattern = np.stack(np.broadcast_arrays(ramp[None, :], np.float32(0.5), np.float32(0.5)), axis=-1)
    pattern = np.repeat(pattern, 256, axis=0).copy()
    wall = pl.Mesh.plane(
        0.4, base_color=(1, 1, 1), base_color_map=pattern, specular=0.0, rotation=(90, 0, 0), position=(0, 0, wall_z)
    )
    glass = pl.RefractiveVolume.from_sdf(shapes.sphere(radius), n_ball, 96, 0.1)
    slab = pl.RefractiveVolume.from_sdf(
        shapes.box((0.1, 0.1, 0.02)), n_slab, 48, (0.12, 0.12, 0.04), position=(0, 0, 0.1), rotation=(0, tilt, 0)
    )
    camera = pl.Camera(position=(0, 0, 0.5), target=(0, 0, 0), orthographic_height_m=0.06)
    frame = renderer.render(scene(wall, slab, glass, environment=WHITE, camera=camera), SIZE)
    assert len(bodies(renderer)) == 2
    origins, directions = (a.reshape(-1, 3) for a in camera.pixel_rays(SIZE))
    # A plane slab shifts rays sideways by d (tan(t) - tan(t')) cos(t), and leaves their direction.
    t = np.radians(tilt)
    inside = np.arcsin(np.sin(t) / n_slab)
    shift = -0.02 * (np.tan(t) - np.tan(inside)) * np.cos(t)
    shifted = origins + np.array((shift, 0.0, 0.0))
    inner = np.linalg.norm(shifted[:, :2], axis=1) < 0.6 * radius
    leave, out = oracles.through_ball(shifted[inner], directions[inner], radius, n_ball)
    hit = leave + out * ((wall_z - leave[:, 2]) / out[:, 2])[:, None]
    theta = np.maximum(np.arcsin(np.linalg.norm(shifted[inner, :2], axis=1) / radius), 1e-4)
    kept = ((1.0 - oracles.fresnel(theta, 1.0, n_ball)) * (1.0 - oracles.fresnel(t, 1.0, n_slab))) ** 2
    seen = frame.radiance.reshape(-1, 3)[inner]
    # What is mirrored is white, so that the difference between red and blue comes from the wall alone.
    error = np.abs(0.5 + (seen[:, 0] - seen[:, 2]) / kept - (hit[:, 0] / 0.4 + 0.5))
    assert np.median(error) < 3e-3 and np.quantile(error, 0.9) < 0.02, f"median {np.median(error):.1e} of the wall"


def test_a_mesh_between_two_balls_hides_the_farther(renderer, ball):
    red = pl.Mesh.plane(
        0.3, base_color=(0, 0, 0), specular=0.0, emission=(3.0, 0.0, 0.0), rotation=(90, 0, 0), position=(0, 0, 0)
    )
    near, far = pl.RefractiveVolume(ball, position=(0, 0, 0.05)), pl.RefractiveVolume(ball, position=(0, 0, -0.05))
    dark = pl.Environment.constant((0.0, 0.0, 0.0))
    camera = pl.Camera(position=(0, 0, 0.5), target=(0, 0, 0), orthographic_height_m=0.06)
    with_far = renderer.render(scene(red, near, far, environment=dark, camera=camera), SIZE).radiance
    alone = renderer.render(scene(red, near, environment=dark, camera=camera), SIZE).radiance
    assert np.abs(with_far[60, 80] - (3.0 * 0.96**2, 0.0, 0.0)).max() < 0.02
    assert np.quantile(np.abs(with_far - alone), 0.99) < 1e-3


def test_depth_behind_hot_air_is_that_of_the_glass(renderer, ball):
    air = pl.RefractiveVolume.from_function(
        lambda x, y, z: 1.0 + 2e-4 * np.exp(-(x * x + y * y + z * z) / 0.02**2), 32, 0.1, position=(0.015, 0.015, 0.1)
    )
    glass = pl.RefractiveVolume(ball)
    clear = renderer.render(scene(glass), SIZE)
    warm = renderer.render(scene(glass, air), SIZE)
    assert len(bodies(renderer)) == 2
    seen = np.isfinite(clear.depth) & np.isfinite(warm.depth)
    assert seen.sum() > 0.98 * np.isfinite(clear.depth).sum() > 300
    assert np.quantile(np.abs(warm.depth[seen] - clear.depth[seen]), 0.95) < 1e-4
    assert (warm.radiance != clear.radiance).any()


def test_a_far_body_changes_nothing_where_no_ray_meets_it(renderer, ball):
    """Rays begin at a tighter box, so that numbers round differently, and no more."""
    glass = pl.RefractiveVolume(ball)
    alone = renderer.render(scene(FLOOR, glass), SIZE)
    other = renderer.render(scene(FLOOR, glass, glass.replace(position=(0, 40.0, 0), scale=0.1)), SIZE)
    error = np.abs(alone.radiance - other.radiance).max(axis=2)
    assert np.quantile(error, 0.95) < 1e-4 and np.mean(error) < 2e-3


def test_a_caustic_stays_where_a_second_body_stands_by(renderer):
    """The floor lies in the box of the volume, but not in the tighter one that its rays are followed in."""
    ball = pl.RefractiveVolume.from_sdf(shapes.sphere(0.03), 1.5, 48, 0.1)
    floor = pl.Mesh.plane(0.6, specular=0.0, position=(0, -0.041, 0))
    what = scene(floor, ball, camera=pl.Camera(position=(0.05, 0.15, 0.3), target=(0, 0, 0), fov_deg=30))
    what = what.replace(lights=[pl.DirectionalLight(direction=(0.6, -0.7, 0.4))])
    focus = (slice(80, 100), slice(84, 116))
    alone = renderer.render(what, SIZE).radiance[focus].max()
    beside = ball.replace(position=(0, 0.3, 0), light=pl.LightQuality(caustics=False))
    two = renderer.render(what.replace(objects=[floor, ball, beside]), SIZE).radiance[focus].max()
    assert abs(two / alone - 1.0) < 0.02, f"{two:.2f} instead of {alone:.2f}"


def test_a_dispersive_body_leaves_the_others_as_they_are(renderer, ball):
    clear = pl.RefractiveVolume(ball, position=(-0.04, 0, 0))
    flint = pl.media.get("N-SF66").with_absorption((0.0, 0.0, 0.0))
    spread = pl.RefractiveVolume.from_sdf(shapes.sphere(0.03), flint, 48, 0.07, position=(0.04, 0, 0))
    furnace = renderer.render(scene(clear, spread, environment=WHITE), SIZE).radiance
    assert np.abs(furnace - 1.0).max() < 1e-5
    both = renderer.render(scene(clear, spread), SIZE).radiance[:, :70]
    single = renderer.render(scene(clear, spread.replace(dispersion=False)), SIZE).radiance[:, :70]
    error = np.abs(both - single).max(axis=2)
    assert np.quantile(error, 0.9) < 1e-6 < error.max(), "but for what it mirrors of the other"


def test_the_same_scene_gives_the_same_bits(renderer, device, ball):
    row = [pl.RefractiveVolume(ball, position=(0.07 * k - 0.07, 0, -0.02 * k)) for k in range(3)]
    first = renderer.render(scene(FLOOR, *row), SIZE).radiance
    assert (first == renderer.render(scene(FLOOR, *row), SIZE).radiance).all()


def test_forty_balls_in_a_furnace_and_more_in_a_row_than_rays_follow(renderer):
    tiny = pl.Volume.from_sdf(shapes.sphere(0.01), 1.5, 20, 0.024)
    wall = [pl.RefractiveVolume(tiny, position=(0.025 * (k % 8) - 0.09, 0.025 * (k // 8) - 0.05, 0)) for k in range(40)]
    assert len(wall) > 32, "more than one word of marks"
    assert np.abs(renderer.render(scene(*wall, environment=WHITE), (64, 48)).radiance - 1.0).max() < 1e-5
    row = [pl.RefractiveVolume(tiny, position=(0, 0, -0.025 * k)) for k in range(BODIES_IN_A_ROW + 3)]
    assert np.abs(renderer.render(scene(*row, environment=WHITE), (64, 48)).radiance - 1.0).max() < 1e-5


def test_moving_one_of_several_compiles_nothing(device, ball, monkeypatch):
    renderer = pl.Renderer(device)
    one, other = pl.RefractiveVolume(ball, position=(-0.05, 0, 0)), pl.RefractiveVolume(ball, position=(0.05, 0, 0))
    renderer.render(scene(FLOOR, one, other), SIZE)
    for maker in ("create_shader_module", "create_compute_pipeline", "create_render_pipeline"):
        monkeypatch.setattr(device.wgpu, maker, lambda **k: pytest.fail("compiled again"))
    renderer.render(scene(FLOOR, one, other.replace(position=(0.06, 0.01, 0), rotation=(0, 40, 0))), SIZE)
    renderer.render(scene(FLOOR, other, one, camera=CAMERA.replace(position=(0.1, 0.1, 0.3))), SIZE)


# ---- in one another -------------------------------------------------------------------------------------------


def nested():
    outer, inner = shapes.sphere(0.045), shapes.sphere(0.02)
    glass = pl.RefractiveVolume.from_sdf(outer, 1.5, 80, 0.1)
    bubble = pl.RefractiveVolume.from_sdf(inner, 1.0, 40, 0.05, position=(0.01, 0.005, 0.003), rotation=(10, 20, 30))
    regions = [(lambda x, y, z: inner(x - 0.01, y - 0.005, z - 0.003), 1.0), (outer, 1.5)]
    return glass, bubble, pl.RefractiveVolume.from_regions(regions, 80, 0.1)


def test_a_bubble_in_glass_looks_as_two_regions_do_whichever_is_listed_first(renderer):
    glass, bubble, one = nested()
    two = renderer.render(scene(FLOOR, glass, bubble), SIZE).radiance
    (body,) = bodies(renderer)
    assert {id(item) for item in body.objects} == {id(glass), id(bubble)}
    swapped = renderer.render(scene(FLOOR, bubble, glass), SIZE).radiance
    assert (two == swapped).all()
    error = np.abs(two - renderer.render(scene(FLOOR, one), SIZE).radiance).max(axis=2)
    assert np.mean(error) < 4e-3 and np.median(error) < 1e-3, f"mean {np.mean(error):.1e}"


def test_objects_in_one_another_move_together_without_being_composed_again(renderer, monkeypatch):
    glass, bubble, _ = nested()
    renderer.render(scene(glass, bubble), SIZE)
    monkeypatch.setattr("pellucid.techniques.eikonal.joining.compose", lambda *a: pytest.fail("composed again"))
    shifted = [item.replace(position=np.add(item.position, (0.02, 0.0, -0.01))) for item in (glass, bubble)]
    renderer.render(scene(*shifted), SIZE)


def test_glass_in_smoke_looks_as_in_one_volume(renderer):
    fog = np.full((40, 40, 40, 3), 6.0, np.float32)
    ball = shapes.sphere(0.03)
    glass = pl.RefractiveVolume.from_sdf(ball, 1.5, 40, 0.07)
    smoke = pl.RefractiveVolume.from_array(np.ones((40, 40, 40)), 0.1, scattering=fog, absorption=0.5 * fog)
    line = (np.arange(56) + 0.5) * 0.1 / 56 - 0.05
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    outside = (ball(x, y, z) > 0.0)[..., None] * np.full(3, 6.0)
    one = pl.Volume.from_sdf(ball, 1.5, 56, 0.1).replace(scattering=outside, absorption=0.5 * outside)
    two = renderer.render(scene(FLOOR, smoke, glass), SIZE).radiance
    assert len(bodies(renderer)) == 1
    error = np.abs(two - renderer.render(scene(FLOOR, pl.RefractiveVolume(one)), SIZE).radiance).max(axis=2)
    assert np.mean(error) < 0.01 and np.median(error) < 5e-3, f"mean {np.mean(error):.1e}"


def test_a_furnace_stays_closed_with_nested_overlapping_and_smoky_objects(renderer):
    glass, bubble, _ = nested()
    across = pl.RefractiveVolume.from_sdf(shapes.sphere(0.02), 1.7, 40, 0.05, position=(0.05, 0.0, 0.0))
    fog = np.full((24, 24, 24, 3), 5.0, np.float32)
    smoke = pl.RefractiveVolume.from_array(np.ones((24, 24, 24)), 0.16, scattering=fog)
    floor = pl.Mesh.plane(4.0, base_color=(1.0, 1.0, 1.0), specular=0.0, position=(0, -0.05, 0))
    for objects in ((glass, bubble, across), (glass, smoke, bubble)):
        frame = renderer.render(scene(*objects, floor, environment=WHITE), SIZE)
        assert len(bodies(renderer)) == 1
        error = np.abs(frame.radiance - 1.0).max()
        assert error < 5e-3, f"the furnace is off by {error:.1e}"


def test_what_cannot_be_composed_is_drawn_box_after_box(renderer, ball):
    """Five media in one another: rays still go on, and no energy is lost."""
    row = [
        pl.RefractiveVolume.from_sdf(shapes.sphere(0.03), 1.3 + 0.1 * k, 32, 0.07, position=(0.03 * k - 0.06, 0, 0))
        for k in range(5)
    ]
    frame = renderer.render(scene(*row, environment=WHITE), SIZE)
    assert len(bodies(renderer)) == 5
    assert np.abs(frame.radiance - 1.0).max() < 1e-5


def test_balls_whose_boxes_overlap_at_their_corners_only_stay_apart(ball):
    matter = matter_of(ball, "sharp")
    here = np.eye(4)
    for offset, together in (((0.055, 0.055, 0.0), False), ((0.055, 0.0, 0.0), True), ((0.065, 0.0, 0.0), False)):
        there = pl.RefractiveVolume(ball, position=offset).object_to_world()
        assert interfere(matter, here, matter, there) is together
