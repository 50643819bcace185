"""The photon tracer that the light simulator is measured against, itself held to closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import oracles
import pellucid as pl
from pellucid.techniques.eikonal.reference import Convex, Cylinder, Limits, Matter, Sphere, World, trace_light

BOX = (0.1, 0.1, 0.1)
SUN = pl.DirectionalLight(direction=(0, 0, -1), irradiance=2.0, color=(1.0, 0.5, 0.25))
SLANTED = pl.DirectionalLight(direction=(0.3, -0.5, -0.8), irradiance=2.0)


def luneburg(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """n^2 = 2 - (r / R)^2, R = 0.04, and its gradient."""
    square = (x * x).sum(1) / 0.04**2
    n = np.sqrt(np.where(square < 1.0, 2.0 - square, 1.0))
    return n, np.where(square < 1.0, -1.0 / (n * 0.04**2), 0.0)[:, None] * x


@pytest.mark.parametrize("tent", [False, True])
def test_an_empty_box_keeps_the_fluence(tent: bool) -> None:
    light = trace_light(World(BOX), [SUN], (7, 8, 9), 2.0, tent=tent)
    assert np.abs(light.fluence / (2.0 * np.array(SUN.color)) - 1.0).max() < 1e-12
    assert np.abs(light.direction - [0, 0, -1]).max() < 1e-12
    assert light.flux_in == pytest.approx(2.0 * 0.01 * np.array(SUN.color), rel=1e-12)


def test_slanted_light_fills_an_empty_box_too() -> None:
    light = trace_light(World(BOX), [SLANTED], (8, 8, 8), 16.0)
    deviation = light.fluence / 2.0 - 1.0
    assert abs(deviation.mean()) < 1e-3 and deviation.std() < 0.02


def test_a_point_light_falls_with_the_square_of_the_distance() -> None:
    position = np.array([0.0, 0.0, 0.12])
    light = trace_light(World(BOX), [pl.PointLight(tuple(position), intensity=0.3)], (10, 10, 10), 12.0)
    inside = trace_light(World(BOX), [pl.PointLight((0.0, 0.0, 0.0), intensity=0.3)], (10, 10, 10), 30.0)
    grid = (np.arange(10) - 4.5) * 0.01
    z, y, x = np.meshgrid(grid, grid, grid, indexing="ij")
    centres = np.stack([x, y, z], -1)
    for found, source in ((light, position), (inside, np.zeros(3))):
        square = ((centres - source) ** 2).sum(-1)
        far = square > 0.03**2  # nearer, 1/d^2 is not constant within a voxel
        error = found.fluence[far][:, 0] / (0.3 / square[far]) - 1.0
        assert np.sqrt((error**2).mean()) < 0.03 and abs(error.mean()) < 4e-3
    assert inside.flux_in == pytest.approx(np.full(3, 4.0 * np.pi * 0.3), rel=1e-11)


def test_absorption_is_exact() -> None:
    """A block as wide as the box: voxels hold the mean of exp(-sigma s) over them."""
    sigma = np.array([5.0, 20.0, 80.0])
    block = Convex.box((0.2, 0.2, 0.06), Matter(1.0, absorption=tuple(sigma)))
    light = trace_light(World(BOX, [block]), [SUN], (10, 4, 4), 1.0)
    edges = np.clip(0.03 - (np.arange(11) - 5) * 0.01, 0.0, 0.06)
    mean = np.diff(np.exp(-edges[:, None] * sigma) / sigma, axis=0) / 0.01
    assert light.fluence[2:8, 1, 1] == pytest.approx(2.0 * np.array(SUN.color) * mean[2:8], rel=1e-9)
    assert light.flux_out / light.flux_in == pytest.approx(np.exp(-0.06 * sigma), rel=1e-12)


@pytest.mark.parametrize("roulette", [False, True])
def test_energy_closes(roulette: bool) -> None:
    matter = Matter(1.5, absorption=(3.0, 10.0, 30.0))
    bodies = [Sphere(0.02, Matter(2.0), (0.01, 0, 0)), Convex.box((0.06, 0.07, 0.05), matter), Cylinder(0.035, matter)]
    world = World(BOX, bodies, background=Matter(1.1, absorption=(1.0, 0.0, 0.0)))
    light = trace_light(world, [SLANTED], (8, 8, 8), 2.0, limits=Limits(bounces=12, roulette=roulette))
    found = light.flux_absorbed + light.flux_out + light.flux_ended
    assert found == pytest.approx(light.flux_in, rel=1e-12)


def test_the_fluence_absorbs_what_is_lost() -> None:
    """Absorbed power is the integral of sigma times fluence, whatever the paths."""
    world = World(BOX, background=Matter(luneburg, absorption=(4.0, 9.0, 0.0)), step_m=5e-4)
    light = trace_light(world, [SLANTED], (16, 16, 16), 1.0)
    power = light.fluence.sum((0, 1, 2)) * (0.1 / 16) ** 3 * [4.0, 9.0, 0.0]
    assert power == pytest.approx(light.flux_absorbed, rel=1e-9)


def test_a_ball_bends_light_as_the_closed_form_says() -> None:
    limits = Limits(bounces=2, min_flux=0.5)
    light = trace_light(World(BOX, [Sphere(0.04, Matter(1.5))]), [SUN], (4, 4, 4), 8.0, limits=limits)
    left = light.left[light.left.bounces == 2]
    count = 32
    grid = ((np.arange(count) + 0.5) / count - 0.5) * 0.1
    starts = np.stack([*(a.ravel() for a in np.meshgrid(grid, grid, indexing="ij")), np.full(count**2, 0.05)], axis=1)
    hits = (starts[:, :2] ** 2).sum(1) < 0.039**2
    d = np.broadcast_to([0.0, 0.0, -1.0], starts.shape)
    expected = oracles.through_ball(starts[hits], d[hits], 0.04, 1.5)[1]
    found = left.d[np.argsort(left.name)]
    assert len(found) >= len(expected)
    nearest = np.abs(found[:, None] - expected[None]).sum(2).min(0)
    assert nearest.max() < 1e-12
    axis = np.hypot(left.d[:, 0], left.d[:, 1]) < 0.05
    reach = -(left.x[axis, :2] * left.d[axis, :2]).sum(1) / (left.d[axis, :2] ** 2).sum(1)
    focus = -(left.x[axis] + reach[:, None] * left.d[axis])[:, 2]
    assert focus.mean() == pytest.approx(oracles.ball_lens_focus(0.04, 1.5), rel=0.01)


def test_a_luneburg_lens_gathers_light_on_its_rim_to_second_order_in_the_step() -> None:
    spread = []
    for step in (1e-3, 5e-4):
        world = World((0.1, 0.1, 0.08), [Sphere(0.04, Matter(luneburg))], step_m=step)
        left = trace_light(world, [SUN], (2, 4, 4), 8.0).left
        inner = np.hypot(left.d[:, 0], left.d[:, 1]) > 1e-3
        spread.append(oracles.line_distance(left.x[inner], left.d[inner], np.array([0, 0, -0.04])).max() / 0.04)
    assert spread[1] < 1e-4 and spread[0] / spread[1] > 3.5


def test_tents_keep_what_they_spread() -> None:
    world = World(BOX, [Sphere(0.03, Matter(1.5))])
    plain, spread = (trace_light(world, [SLANTED], (12, 12, 12), 2.0, tent=tent) for tent in (False, True))
    assert spread.fluence.sum() == pytest.approx(plain.fluence.sum(), rel=1e-12)
    assert np.abs(spread.fluence - plain.fluence).max() > 0.1
