"""Ripples on the GPU are those of NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.waves import Ripples
from pellucid.simulation import RippleSimulation

if TYPE_CHECKING:
    from pellucid.gpu import Device

CELL = 0.002


def rainy(boundary: str, **options: Any) -> Ripples:
    ripples = Ripples((37, 52), CELL, 0.3, 0.5, boundary, level_m=0.003, **options)
    for n, (x, z) in enumerate([(0.0, 0.0), (0.051, -0.03), (-0.02, 0.036)]):
        ripples.drop(x, z, 0.004 + 0.001 * n, 0.003, time_s=0.11 * n)
    return ripples


def rowed(boundary: str) -> Ripples:
    ripples = Ripples((37, 52), CELL, 0.3, 0.5, boundary)
    ripples.push([(-0.05, 0.0), (0.04, 0.02), (0.06, 0.02)], 0.006, 0.002, speed_m_s=0.5, time_s=0.02)
    ripples.push([(0.01, 0.01)], 0.004, 0.001, times_s=[0.1, 0.4])
    ripples.drop(0.0, 0.0, 0.004, 0.003, time_s=0.1)
    return ripples


def shown(device: Device, texture: Any) -> np.ndarray:
    return device.read_texture(texture)[..., 0]


@pytest.mark.parametrize("boundary", ["reflect", "periodic", "absorb"])
def test_both_twins_have_the_same_heights(boundary: str, device: Device) -> None:
    ripples = rainy(boundary)
    simulation = RippleSimulation(device, ripples)
    for time in (0.0, 0.004, 0.25, 1.0):  # 300 steps
        wanted = ripples.advance(time)
        highest = np.abs(wanted - 0.003).max()
        np.testing.assert_allclose(shown(device, simulation.advance(time)), wanted, atol=1e-5 * max(highest, 1e-3))


@pytest.mark.parametrize("boundary", ["reflect", "periodic"])
def test_what_floats_presses_alike_on_both(boundary: str, device: Device) -> None:
    ripples = rowed(boundary)
    simulation = RippleSimulation(device, ripples)
    for time in (0.05, 0.16, 0.5, 0.12):
        wanted = ripples.advance(time)
        np.testing.assert_allclose(shown(device, simulation.advance(time)), wanted, atol=2e-8)


def test_an_earlier_time_and_a_later_drop_are_followed(device: Device) -> None:
    ripples = rainy("reflect")
    simulation = RippleSimulation(device, ripples)
    early = shown(device, simulation.advance(0.15))
    simulation.advance(0.5)
    np.testing.assert_array_equal(shown(device, simulation.advance(0.15)), early)
    ripples.advance(0.2)
    ripples.drop(0.0, 0.02, 0.005, 0.004)
    simulation.advance(0.4)
    np.testing.assert_allclose(shown(device, simulation.heights), ripples.advance(0.4), atol=1e-8)


def test_work_goes_into_a_given_encoder(device: Device) -> None:
    ripples = rainy("absorb", limit_m=0.0002)
    simulation = RippleSimulation(device, ripples)
    encoder = device.wgpu.create_command_encoder()
    texture = simulation.advance(0.05, encoder)
    assert not shown(device, texture).any()
    device.wgpu.queue.submit([encoder.finish()])
    heights = shown(device, texture)
    assert (heights.min(), heights.max()) == pytest.approx((0.0028, 0.0032), abs=1e-6)
    np.testing.assert_allclose(heights, ripples.advance(0.05), atol=1e-8)


def test_bad_times_are_refused(device: Device) -> None:
    with pytest.raises(SceneError, match=r"^time_s: "):
        RippleSimulation(device, rainy("reflect")).advance(-1.0)
