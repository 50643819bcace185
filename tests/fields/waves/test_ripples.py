"""Ripples against the wave equation: speed, energy, mass, damping, borders; and heights at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.waves import Ripples

CELL, SPEED = 0.002, 0.3


def pool(shape: tuple[int, int] = (48, 64), **options: Any) -> Ripples:
    given = {"cell_m": CELL, "speed_m_s": SPEED, "damping": 0.0, "dtype": np.float64} | options
    return Ripples(shape, **given)


def test_ripples_are_dynamic_heights() -> None:
    ripples = pool()
    assert isinstance(ripples, DynamicHeights)
    assert ripples.tile_m == pytest.approx((0.128, 0.096)) and ripples.limits_m == (-0.02, 0.02)
    assert ripples.advance(0.0).dtype == np.float32


@pytest.mark.parametrize("across", [(1, 0), (1, 1), (2, 1)])
@pytest.mark.parametrize("cells", [6, 8, 16])
def test_waves_travel_at_the_given_speed_in_all_directions(across: tuple[int, int], cells: int) -> None:
    """A standing wave of a known wave number swings with c k. Six cells to a wave are right to 1 %."""
    size = 96
    turns = size / cells / np.hypot(*across)
    k = np.round(np.array(across) * turns).astype(int)
    ripples = pool((size, size), boundary="periodic")
    at = 2 * np.pi * (np.arange(size) + 0.5) / size
    wave = np.cos(k[0] * at[None, :] + k[1] * at[:, None])
    ripples.displacement = wave.copy()
    ripples.velocity = np.zeros_like(wave)
    omega = SPEED * 2 * np.pi * np.hypot(*k) / (size * CELL)
    # Started at rest at half a step before 0; followed over ten swings.
    amplitude = []
    steps = int(10 * 2 * np.pi / omega / ripples.step_s)
    for n in range(1, steps):
        ripples._steps_to(n)
        amplitude.append((ripples.displacement * wave).mean() / (wave * wave).mean())
    values = np.array(amplitude)
    rising = np.nonzero((values[:-1] < 0) & (values[1:] >= 0))[0]
    zeros = rising - values[rising] / (values[rising + 1] - values[rising])
    found = 2 * np.pi / (np.diff(zeros).mean() * ripples.step_s)
    assert found == pytest.approx(omega, rel=0.01 if cells == 6 else 0.004)


def test_the_error_of_the_speed_falls_in_fourth_order() -> None:
    """From the stencil itself: sin^2(omega dt / 2) = dt^2 / 4 times what it does to a wave."""
    errors = []
    for cells in (8, 16):
        ripples = pool()
        phase = 2 * np.pi / cells * (np.arange(5) - 2)
        symbol = -(ripples.stencil() * np.cos(phase)[None, :]).sum()
        omega = 2 / ripples.step_s * np.arcsin(0.5 * ripples.step_s * np.sqrt(symbol))
        errors.append(abs(omega / (SPEED * 2 * np.pi / (cells * CELL)) - 1))
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.1) and errors[0] < 0.003


def test_a_ring_arrives_when_it_should() -> None:
    """The crest that a drop sends out has moved by the speed times the time between two pictures."""
    ripples = pool((128, 128), boundary="absorb", limit_m=1.0)
    ripples.drop(0.0, 0.0, 0.008, 0.01)
    radius = (np.arange(64) + 0.5) * CELL

    def crest(time_s: float) -> float:
        row = ripples.advance(time_s)[64, 64:].astype(float)
        n = int(np.argmax(row))
        bend = row[n - 1] - 2 * row[n] + row[n + 1]
        return float(radius[n] + 0.5 * (row[n - 1] - row[n + 1]) / bend * CELL)

    assert (crest(0.30) - crest(0.20)) / 0.10 == pytest.approx(SPEED, rel=0.01)


@pytest.mark.parametrize("boundary", ["reflect", "periodic"])
def test_without_damping_energy_and_mass_stay(boundary: str) -> None:
    ripples = pool(boundary=boundary)
    ripples.drop(0.01, -0.02, 0.006, 0.004)
    ripples.drop(-0.05, 0.04, 0.004, 0.002)
    ripples.advance(10 * ripples.step_s)
    start = ripples.energy
    moved = np.abs(ripples.displacement).sum() * CELL**2
    for n in range(1, 5):
        ripples.advance(n * 200 * ripples.step_s)
        assert ripples.energy == pytest.approx(start, rel=1e-10)
        assert abs(ripples.volume_m3) < 1e-10 * moved


@pytest.mark.parametrize("damping", [0.0, 0.5, 50.0, 5000.0])
@pytest.mark.parametrize("boundary", ["reflect", "absorb"])
def test_energy_never_grows(damping: float, boundary: str) -> None:
    ripples = pool(damping=damping, boundary=boundary)
    ripples.drop(0.01, 0.01, 0.005, 0.003)
    energy = []
    for n in range(1, 60):
        ripples.step(0.7 * ripples.step_s)
        energy.append(ripples.energy)
        assert n and np.isfinite(energy[-1])
    assert np.all(np.diff(energy) <= 1e-12 * energy[0]) and energy[-1] >= 0.0


@pytest.mark.parametrize("dt", [1e-6, 0.013, 1.0, 7.0])
def test_any_step_is_stable(dt: float) -> None:
    ripples = pool(dtype=np.float32)
    ripples.drop(0.0, 0.0, 0.006, 0.004)
    for _ in range(3):
        heights = ripples.step(dt)
    assert np.isfinite(heights).all() and np.abs(heights).max() <= 0.0041


def test_waves_fade_as_damping_says() -> None:
    ripples = pool((32, 32), boundary="periodic", damping=0.5)
    at = 2 * np.pi * (np.arange(32) + 0.5) / 32
    ripples.displacement = np.tile(np.cos(at), (32, 1))
    ripples._steps_to(1)
    first = ripples.energy
    ripples._steps_to(601)
    # Energy swings about its mean by damping / omega = 1.7 %.
    assert ripples.energy / first == pytest.approx(np.exp(-600 * ripples.step_s), rel=0.035)


def test_a_border_that_absorbs_lets_waves_go() -> None:
    open_pool, closed = (pool((96, 96), boundary=b) for b in ("absorb", "reflect"))
    for ripples in (open_pool, closed):
        ripples.drop(0.0, 0.0, 0.01, 0.004)
        ripples.advance(1.6)  # the ring has gone to the border and back more than twice
    assert open_pool.energy < 2e-3 * closed.energy


def test_a_periodic_pool_has_no_border() -> None:
    """A drop on the border sends out what a drop in the middle does, moved by half the pool."""
    middle, edge = pool((32, 32), boundary="periodic"), pool((32, 32), boundary="periodic")
    middle.drop(0.0, 0.0, 0.006, 0.004)
    edge.drop(-16 * CELL, -16 * CELL, 0.006, 0.004)
    np.testing.assert_allclose(np.roll(edge.advance(0.2), (16, 16), (0, 1)), middle.advance(0.2), atol=1e-9)


def test_heights_at_a_time_do_not_depend_on_the_pictures_before() -> None:
    def rainy() -> Ripples:
        ripples = pool((24, 24), dtype=np.float32)
        for n in range(5):
            ripples.drop(0.004 * n - 0.01, 0.002 * n, 0.004, 0.003, time_s=0.03 * n)
        return ripples

    straight, often = rainy(), rainy()
    wanted = straight.advance(0.2)
    for time in (0.011, 0.05, 0.0501, 0.17, 0.2, 0.31):
        often.advance(time)
    np.testing.assert_array_equal(often.advance(0.2), wanted)


def test_heights_go_on_smoothly_between_steps() -> None:
    ripples = pool((32, 32))
    ripples.drop(0.0, 0.0, 0.006, 0.004)
    dt = ripples.step_s
    before, after = (ripples.advance((7 + e) * dt).astype(float) for e in (-1e-4, 1e-4))
    change = np.abs(ripples.advance(8 * dt) - before).max()
    assert np.abs(after - before).max() < 1e-3 * change


def test_a_drop_of_now_is_there_and_its_middle_is_pressed_down() -> None:
    ripples = pool((33, 33), level_m=0.1)
    ripples.advance(0.5)
    ripples.drop(0.0, 4 * CELL, 0.006, 0.004)
    heights = ripples.advance(0.5 + ripples.step_s)
    low = np.unravel_index(heights.argmin(), heights.shape)
    assert low == (20, 16) and heights.min() < 0.098 and heights.max() > 0.1


def test_heights_keep_to_their_limits() -> None:
    ripples = pool(limit_m=0.001, level_m=0.01)
    ripples.drop(0.0, 0.0, 0.006, 0.02)
    heights = ripples.advance(0.02)
    assert (heights.min(), heights.max()) == pytest.approx((0.009, 0.011))


@pytest.mark.parametrize(
    ("options", "field"),
    [({"shape": (4, 4)}, "shape"), ({"shape": 12}, "shape"), ({"shape": (12.0, 12)}, "shape"),
     ({"cell_m": 0.0}, "cell_m"), ({"speed_m_s": np.nan}, "speed_m_s"), ({"damping": -1.0}, "damping"),
     ({"boundary": "open"}, "boundary"), ({"dtype": np.int32}, "dtype"), ({"limit_m": 0.0}, "limit_m"),
     ({"level_m": "high"}, "level_m")],
)  # fmt: skip
def test_parameters_are_checked(options: dict, field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        pool(**options)


def test_drops_and_times_are_checked() -> None:
    ripples = pool()
    for given, field in (
        ((1.0, 0, 0.01, 0.01), "x_m"),
        ((0, 1.0, 0.01, 0.01), "z_m"),
        ((0, 0, 1e-4, 0.01), "radius_m"),
    ):
        with pytest.raises(SceneError, match=rf"^{field}: "):
            ripples.drop(*given)
    ripples.advance(0.1)
    with pytest.raises(SceneError, match=r"^time_s: "):
        ripples.drop(0, 0, 0.01, 0.01, time_s=0.05)
    for time in (-1.0, np.nan, np.inf, 1e9):
        with pytest.raises(SceneError, match=r"^time_s: "):
            ripples.advance(time)
    with pytest.raises(SceneError, match=r"^dt: "):
        ripples.step(-0.1)


def test_what_floats_still_lies_in_its_dent() -> None:
    """At rest u + q is the same everywhere: a dent of the depth that was given, filled up elsewhere by its volume."""
    ripples = pool((49, 49), damping=20.0)
    ripples.push([(0.0, 0.0)], 0.012, 0.003, times_s=[0.0, 9.0])
    heights = ripples.advance(4.0)
    dent = float(heights.max() - heights.min())
    assert dent == pytest.approx(0.003, rel=1e-3)
    assert np.unravel_index(heights.argmin(), heights.shape) == (24, 24)


@pytest.mark.parametrize("boundary", ["reflect", "periodic"])
def test_what_moves_keeps_the_mass_and_its_waves_stay_bounded(boundary: str) -> None:
    ripples = pool(boundary=boundary)
    ripples.push([(-0.05, 0.0), (0.05, 0.01), (0.09, 0.01)], 0.008, 0.002, speed_m_s=0.45)
    end = ripples.pushes[0].times_s[-1]
    highest = max(float(np.abs(ripples.advance(share * end)).max()) for share in np.linspace(0.1, 1.0, 9))
    moved = np.abs(ripples.displacement).sum() * CELL**2
    assert abs(ripples.volume_m3) < 1e-10 * moved and 0.0005 < highest < 0.01
    ripples.advance(end + ripples.step_s)
    energy = ripples.energy
    ripples.advance(end + 3.0)  # nothing presses any more, one long step
    assert ripples.energy == pytest.approx(energy, rel=1e-9)


def test_what_is_faster_than_waves_draws_a_wedge() -> None:
    """Half angle arcsin(c / v): behind something at twice the speed of waves, crests lie along 30 degrees."""
    ripples = pool((160, 240), boundary="absorb", limit_m=1.0)
    ripples.push([(-0.2, 0.0), (0.2, 0.0)], 0.006, 0.002, speed_m_s=2 * SPEED)
    heights = ripples.advance(0.35 / (2 * SPEED)).astype(float)
    x, z = ripples.centres()
    lines = [int(np.argmin(np.abs(x - at))) for at in (0.0, 0.04)]
    crests = [abs(float(z[np.argmax(heights[:80, column])])) for column in lines]
    assert np.degrees(np.arctan2(crests[0] - crests[1], x[lines[1]] - x[lines[0]])) == pytest.approx(30.0, abs=1.5)


def test_pushes_are_the_same_however_they_are_watched() -> None:
    def rowed() -> Ripples:
        ripples = pool((32, 40), dtype=np.float32, boundary="periodic")
        ripples.push([(-0.03, 0.0), (0.05, 0.02)], 0.006, 0.002, time_s=0.05)
        return ripples

    straight, often = rowed(), rowed()
    wanted = straight.advance(0.2)
    for time in (0.01, 0.06, 0.0601, 0.3):
        often.advance(time)
    np.testing.assert_array_equal(often.advance(0.2), wanted)


def test_slopes_of_ripples_belong_to_their_heights_and_drops_renew_them() -> None:
    ripples = pool((32, 32), boundary="periodic")
    ripples.drop(0.0, 0.0, 0.008, 0.004)
    before = ripples.surface(0.1)
    assert ripples.surface(0.1) is before
    h = before.heights
    np.testing.assert_allclose(before.slopes[..., 0], (np.roll(h, -1, 1) - np.roll(h, 1, 1)) / (2 * CELL), atol=1e-6)
    np.testing.assert_allclose(before.slopes[..., 1], (np.roll(h, -1, 0) - np.roll(h, 1, 0)) / (2 * CELL), atol=1e-6)
    ripples.drop(0.0, 0.0, 0.008, 0.004)
    assert np.abs(ripples.surface(0.1).heights - h).max() > 0.001


@pytest.mark.parametrize(
    ("given", "options", "field"),
    [(([0.0, 1.0], 0.01, 0.01), {}, "path_m"), (([(0, 0)], 0.01, 0.01), {}, "path_m"),
     (([(0, 0), (np.nan, 1)], 0.01, 0.01), {}, "path_m"), (([(0, 0), (1, 1)], 1e-4, 0.01), {}, "radius_m"),
     (([(0, 0), (1, 1)], 0.01, 0.01), {"times_s": [1.0, 0.5]}, "times_s"),
     (([(0, 0), (1, 1)], 0.01, 0.01), {"times_s": [0, 1], "time_s": 1.0}, "times_s"),
     (([(0, 0), (1, 1)], 0.01, 0.01), {"speed_m_s": 0.0}, "speed_m_s"),
     (([(0, 0), (1, 1)], 0.01, 0.01), {"time_s": -1.0}, "time_s")],
)  # fmt: skip
def test_pushes_are_checked(given: tuple[Any, ...], options: dict[str, Any], field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        pool().push(*given, **options)
