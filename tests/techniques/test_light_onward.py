"""Light that leaves one volume and goes on into another."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import shapes
from pellucid.surroundings import Surroundings
from pellucid.techniques.eikonal.light import LightSimulator, Lit
from pellucid.techniques.eikonal.passes import EikonalTechnique

DOWN = pl.DirectionalLight(direction=(0.0, -1.0, 0.0), irradiance=2.0)
RADIUS = 0.02
BALL = (0.0, 0.04, 0.0)
CAMERA = pl.Camera(position=(0.0, 0.0, 0.2), target=(0.0, 0.0, 0.0))


def smoke(edge, voxels, strength=0.5):
    """A block of thin smoke in air."""
    scattering = np.full((voxels, voxels, voxels, 3), strength, np.float32)
    return pl.Volume((edge,) * 3, delta_n=np.zeros((voxels,) * 3, np.float32), scattering=scattering)


def ball(medium, voxels=24):
    return pl.Volume.from_sdf(shapes.sphere(RADIUS), medium, voxels, 0.05)


@pytest.fixture
def follow(device):
    """follow(objects) -> the simulator after a run through all of them, lit from above."""

    def run(*objects):
        technique, surroundings = EikonalTechnique(device), Surroundings(device)
        surroundings.prepare(pl.Scene(camera=CAMERA, objects=objects, lights=[DOWN]), (1, 1))
        technique.prepare(objects, surroundings)
        lit = [Lit(body, body.objects[0].light) for body in technique.bodies]
        technique.simulator.run(lit, [DOWN], surroundings)
        return technique.simulator

    return run


def balance(simulator, number):
    sums, _ = simulator.totals(number)
    np.testing.assert_allclose(
        sums["flux_absorbed"] + sums["flux_out"] + sums["flux_ended"], sums["flux_in"], rtol=1e-4
    )
    assert not sums["flux_unsent"].any()
    return {name: flux[0] for name, flux in sums.items()}


def test_what_a_slab_lets_through_enters_the_next_volume(follow):
    """T = 2 n / (n^2 + 1) of a lossless slab with all its inner reflections.

    The block lies within its shadow. It is half as wide as the slab's box, which is a voxel and a half wider than the
    slab on every side, so that its edges fall between parts of bundles.
    """
    slab = pl.Volume((0.1, 0.05, 0.1), delta_n=np.full((6, 12, 12), 0.5, np.float32))
    block = pl.RefractiveVolume(smoke(0.0625, 12), position=(0.0, -0.08, 0.0))
    simulator = follow(pl.RefractiveVolume(slab, boundary="sharp"), block)
    through = 2.0 * 1.5 / (1.5**2 + 1.0)
    balance(simulator, 0)
    assert balance(simulator, 1)["flux_in"] == pytest.approx(through * 2.0 * 0.0625**2, rel=5e-3)


def test_a_dark_ball_throws_its_shadow_into_a_volume_behind_it(follow):
    """Around the shadow light is whole; where the rim of the ball's box is seen from the lamp, to a sixteenth."""
    dark = pl.media.constant(1.0).with_absorption((1e4,) * 3)
    block = pl.RefractiveVolume(smoke(0.06, 24), position=(0.0, -0.01, 0.0))
    fluence = follow(pl.RefractiveVolume(ball(dark), position=BALL), block).read(1)[0][..., 0]
    at = (np.arange(24) + 0.5) / 24 * 0.06 - 0.03
    off = np.hypot(*np.meshgrid(at, at))
    level = fluence[:, 12, :]
    assert level[off < RADIUS - 0.003].max() < 0.02 * 2.0
    np.testing.assert_allclose(level[off > RADIUS + 0.003], 2.0, rtol=1.0 / 16 + 0.02)


def test_a_lens_has_its_focus_in_the_smoke_behind_it(follow):
    """The paraxial focus of a ball is n R / (2 (n - 1)) from its centre; outer rays meet before it."""
    block = pl.RefractiveVolume(smoke(0.04, 32), position=(0.0, BALL[1] - 0.047, 0.0))
    lens = pl.RefractiveVolume(ball(pl.media.constant(1.5), 32), position=BALL)
    fluence = follow(lens, block).read(1)[0][..., 0]
    axis = fluence[15:17, :, 15:17].mean(axis=(0, 2))
    below = 0.047 - ((np.arange(32) + 0.5) / 32 * 0.04 - 0.02)
    assert axis.max() > 20.0
    assert 1.3 * RADIUS < below[axis.argmax()] < 1.55 * RADIUS


def test_the_order_of_objects_does_not_matter(follow):
    block = pl.RefractiveVolume(smoke(0.04, 16), position=(0.0, -0.007, 0.0))
    lens = pl.RefractiveVolume(ball(pl.media.constant(1.5)), position=BALL)
    first = follow(lens, block).read(1)[0]
    second = follow(block, lens).read(0)[0]
    np.testing.assert_allclose(second, first, atol=1e-3 * first.max())


def test_a_body_aside_changes_nothing(follow):
    block = pl.RefractiveVolume(smoke(0.04, 16))
    aside = pl.RefractiveVolume(ball(pl.media.constant(1.0)), position=(0.2, 0.0, 0.0))
    np.testing.assert_allclose(follow(block, aside).read(0)[0], follow(block).read(0)[0], rtol=1e-4)


def test_light_is_kept_until_one_of_the_bodies_changes(device, monkeypatch):
    runs = []
    run = LightSimulator.run
    monkeypatch.setattr(LightSimulator, "run", lambda self, *rest, **named: runs.append(run(self, *rest, **named)))
    block = pl.RefractiveVolume(smoke(0.04, 8), position=(0.0, -0.007, 0.0))
    dark = pl.RefractiveVolume(ball(pl.media.constant(1.0).with_absorption((1e4,) * 3), 12), position=BALL)
    scene = pl.Scene(
        camera=CAMERA, objects=[dark, block], lights=[DOWN], environment=pl.Environment.constant((0.0, 0.0, 0.0))
    )
    renderer = pl.Renderer(device)
    shaded = renderer.render(scene, (16, 12)).radiance.sum()
    renderer.render(scene, (16, 12))
    assert len(runs) == 1
    moved = scene.replace(objects=[dark.replace(position=(0.3, 0.0, 0.0)), block])
    assert renderer.render(moved, (16, 12)).radiance.sum() > 2.0 * shaded
    assert len(runs) == 2


def test_what_two_bodies_in_a_row_let_through_lands_behind_both(device):
    """Two filters in a row: on the floor the lamp's light is missing once, and what is left of it is there."""
    filters = [
        pl.RefractiveVolume(smoke(0.05, 8, strength), position=(0.0, height, 0.0))
        for strength, height in ((6.0, 0.1), (10.0, 0.0))
    ]
    floor = pl.Mesh.plane(0.4, position=(0.0, -0.1, 0.0))
    renderer = pl.Renderer(device)
    renderer.render(pl.Scene(camera=CAMERA, objects=[floor, *filters], lights=[DOWN]), (8, 6))
    landed = renderer.surroundings.caustics.landed_flux()
    np.testing.assert_allclose(landed["blocked"], 2.0 * 0.05**2, rtol=0.01)
    np.testing.assert_allclose(landed["caustic"], 2.0 * 0.05**2 * np.exp(-16.0 * 0.05), rtol=0.01)
