"""Drops on a pane: no water is lost, small ones hold, large ones run as fast as the forces say, trails are left."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.drops import STEP_S, Drops
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.sessile import DENSITY, GRAVITY, SURFACE_TENSION, rims_of


def dry(shape: tuple[int, int] = (64, 64), cell_m: float = 0.0005, **options: Any) -> Drops:
    return Drops(shape, cell_m, **{"initial": 0, "rain_m_per_s": 0.0, "dew_m_per_s": 0.0, **options})


def test_drops_are_dynamic_heights() -> None:
    drops = dry((48, 96))
    assert isinstance(drops, DynamicHeights)
    assert drops.tile_m == pytest.approx((0.048, 0.024))
    heights = drops.advance(0.0)
    assert heights.dtype == np.float32 and heights.shape == (48, 96)
    assert (heights == np.float32(drops.limits_m[0])).all()


@pytest.mark.parametrize("tilt_deg", [0.0, 40.0, 90.0])
def test_what_has_rained_is_on_the_pane_or_has_run_off(tilt_deg: float) -> None:
    drops = Drops((64, 64), 0.001, 3, tilt_deg, initial=300, rain_m_per_s=2e-5, dew_m_per_s=1e-6, volumes_ul=(0.1, 8.0))
    for time in (0.0, 0.5, 1.5, 3.0):
        drops.advance(time)
        assert drops.on_pane_m3 + drops.run_off_m3 == pytest.approx(drops.rained_m3, rel=1e-12)
    brought = 3.0 * (2e-5 + 1e-6) * 0.064**2 + 300 * 7.9e-9 / np.log(80)
    assert drops.rained_m3 == pytest.approx(brought, rel=0.1)
    assert (drops.run_off_m3 > 0.0) == (tilt_deg > 0.0)


def critical_volume(drops: Drops) -> float:
    """Where V density g sin(tilt) = 2 r gamma hysteresis [furmidge1962], by bisection, microlitres."""
    low, high = 1e-3, 1e3
    for _ in range(60):
        volume = np.sqrt(low * high)
        rim = float(rims_of(volume * 1e-9, drops.contact_angle))
        heavy = volume * 1e-9 * DENSITY * GRAVITY * np.sin(drops.tilt) > 2 * rim * SURFACE_TENSION * drops.hysteresis
        low, high = (low, volume) if heavy else (volume, high)
    return float(low)


@pytest.mark.parametrize("tilt_deg", [20.0, 90.0])
def test_drops_run_from_a_critical_volume(tilt_deg: float) -> None:
    for share, runs in ((0.95, False), (1.05, True)):
        drops = dry(tilt_deg=tilt_deg)
        drops.drop(0.0, -0.01, share * critical_volume(drops))
        drops.advance(0.5)
        assert (drops.swarm.y[0] > 0.0061) == runs


def test_a_drop_runs_as_fast_as_friction_lets_it() -> None:
    drops = dry((64, 64), 0.004, film_m=0.0, drag_pa_s=0.3)
    drops.drop(0.0, -0.1, 20.0)
    drops.advance(0.6)
    rim = float(rims_of(20e-9, drops.contact_angle))
    force = 20e-9 * DENSITY * GRAVITY - 2 * rim * SURFACE_TENSION * drops.hysteresis
    assert drops.swarm.speed[0] == pytest.approx(force / (0.3 * rim), rel=1e-3)


def test_a_drop_that_runs_leaves_a_trail_and_what_it_loses_lies_there() -> None:
    drops = dry((200, 64), 0.0005, film_m=20e-6)
    drops.drop(0.0, -0.048, 25.0)
    drops.advance(0.4)
    first, trail = drops.swarm.volume[0], drops.swarm.volume[1:]
    assert len(trail) > 5 and (drops.swarm.y[1:] < drops.swarm.y[0]).all()
    assert first + trail.sum() == pytest.approx(25e-9, rel=1e-12)
    # As thick as the film, as wide as the drop, as long as the way.
    rim = float(rims_of(25e-9, drops.contact_angle))
    assert trail.sum() == pytest.approx(20e-6 * 2 * rim * (drops.swarm.y[0] - 0.002), rel=0.25)


def test_drops_that_touch_become_one_in_their_centre_of_mass() -> None:
    drops = dry(tilt_deg=0.0)
    drops.drop(-0.0155, 0.0, 3.0)
    drops.drop(0.0153, 0.0, 1.0)  # on the other side of the seam
    drops.drop(0.0, 0.005, 1.0)
    drops.advance(STEP_S)
    assert drops.count == 2
    merged = drops.swarm.volume.argmax()
    assert drops.swarm.volume[merged] == pytest.approx(4e-9)
    assert drops.swarm.x[merged] == pytest.approx(0.0005 - 0.25 * 0.0012)


def test_heights_hold_the_volume_of_the_drops() -> None:
    drops = dry((128, 128), 0.0002, tilt_deg=0.0)
    for n, volume in enumerate((1.0, 5.0, 20.0, 40.0)):
        drops.drop(-0.0095 + 0.0063 * n, 0.004 * (n % 2), volume)
    heights = drops.advance(1.0).astype(float)
    assert np.maximum(heights, 0.0).sum() * 0.0002**2 == pytest.approx(66e-9, rel=0.02)


def test_heights_at_a_time_do_not_depend_on_the_pictures_before() -> None:
    def rainy() -> Drops:
        drops = Drops((48, 48), 0.001, 5, initial=60, rain_m_per_s=2e-5)
        drops.drop(0.0, -0.02, 30.0, time_s=0.12)
        return drops

    straight, often = rainy(), rainy()
    wanted = straight.advance(0.4)
    for time in (0.01, 0.2, 0.203, 0.4, 0.6):
        often.advance(time)
    np.testing.assert_array_equal(often.advance(0.4), wanted)
    other = Drops((48, 48), 0.001, 6, initial=60, rain_m_per_s=2e-5)
    assert (other.advance(0.4) != wanted).mean() > 0.05


def test_heights_keep_to_their_limits_and_join_left_and_right() -> None:
    drops = Drops((64, 64), 0.0008, 2, initial=200)
    drops.drop(-0.0256, 0.0, 80.0)
    heights = drops.advance(0.0)
    low, high = drops.limits_m
    assert heights.min() >= np.float32(low) and heights.max() <= np.float32(high)
    drops.advance(0.5)
    alone = dry((64, 64), 0.0008, tilt_deg=0.0)
    alone.drop(-0.0256, 0.0, 80.0)
    half = alone.advance(0.5)
    np.testing.assert_allclose(half, half[:, ::-1], atol=1e-7)
    assert half[32, 0] > 0.002 and half[32, 32] < 0.0


@pytest.mark.parametrize(
    ("options", "field"),
    [({"shape": (1, 4)}, "shape"), ({"shape": 4}, "shape"), ({"cell_m": -1.0}, "cell_m"), ({"seed": 0.5}, "seed"),
     ({"tilt_deg": 100.0}, "tilt_deg"), ({"initial": -1}, "initial"), ({"rain_m_per_s": np.nan}, "rain_m_per_s"),
     ({"volumes_ul": (3.0, 1.0)}, "volumes_ul"), ({"volumes_ul": 1.0}, "volumes_ul"),
     ({"contact_angle_deg": 90.0}, "contact_angle_deg"), ({"hysteresis": 3.0}, "hysteresis"),
     ({"drag_pa_s": 0.0}, "drag_pa_s"), ({"film_m": "thin"}, "film_m"), ({"below_m": 0.0}, "below_m")],
)  # fmt: skip
def test_parameters_are_checked(options: dict, field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        dry(**options)


def test_placed_drops_and_times_are_checked() -> None:
    drops = dry()
    for given, field in (((1.0, 0, 1.0), "x_m"), ((0, 1.0, 1.0), "z_m"), ((0, 0, 0.0), "volume_ul")):
        with pytest.raises(SceneError, match=rf"^{field}: "):
            drops.drop(*given)
    drops.advance(0.1)
    with pytest.raises(SceneError, match=r"^time_s: "):
        drops.drop(0, 0, 1.0, time_s=0.05)
    for time in (-1.0, np.nan, 1e9):
        with pytest.raises(SceneError, match=r"^time_s: "):
            drops.advance(time)
