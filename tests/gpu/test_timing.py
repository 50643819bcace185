"""Milliseconds by label, and none where the device has no clock."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import pytest

from pellucid.gpu.kernel import ComputeKernel
from pellucid.gpu.timing import PassTimer

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.modules import ModuleSource

WORK = """
@group(0) @binding(0) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
  var x = f32(id.x);
  for (var i = 0u; i < 200u; i++) { x = sin(x) + 1.0; }
  out[id.x] = x;
}
"""


@pytest.fixture
def work(device: Device, assemble: Callable[..., ModuleSource]) -> Callable[[PassTimer, str], None]:
    kernel = ComputeKernel(device, assemble(WORK))
    out = device.buffer(4 * 64 * 64)
    return lambda timer, label: kernel.run((64, 1, 1), {"out": out}, timer=timer, label=label)


def test_passes_take_time_and_are_forgotten_when_read(device: Device, work: Callable[[PassTimer, str], None]) -> None:
    timer = PassTimer(device)
    if not timer.available:
        pytest.skip("no timestamp queries here")
    device.wait()
    begun = time.perf_counter()
    for label in ("first", "second"):
        work(timer, label)
    found = timer.milliseconds()
    wall = 1e3 * (time.perf_counter() - begun)
    assert set(found) == {"first", "second"} and min(found.values()) > 0.0
    assert sum(found.values()) < wall
    assert timer.milliseconds() == {}


def test_a_label_that_is_used_twice_is_summed(
    device: Device, monkeypatch: pytest.MonkeyPatch, work: Callable[[PassTimer, str], None]
) -> None:
    timer = PassTimer(device)
    if not timer.available:
        pytest.skip("no timestamp queries here")
    for label in ("a", "b", "a"):
        work(timer, label)
    ticks = np.array([[10, 13], [20, 70], [2**63, 2**63 + 4]], np.uint64)
    monkeypatch.setattr(device, "read", lambda *a: ticks)
    monkeypatch.setitem(device.cache, "tick_ns", 2e6)
    assert timer.milliseconds() == {"a": pytest.approx(14.0), "b": pytest.approx(100.0)}


def test_without_a_label_the_module_is_the_label(device: Device, work: Callable[[PassTimer, str], None]) -> None:
    timer = PassTimer(device)
    work(timer, "")
    assert set(timer.milliseconds()) <= {"top"}


def test_without_timestamps_it_is_empty(device: Device, work: Callable[[PassTimer, str], None]) -> None:
    blind = dataclasses.replace(device, features=device.features - {"timestamp-query"})
    timer = PassTimer(blind)
    assert not timer.available and timer.writes("x") is None
    work(timer, "x")
    assert timer.milliseconds() == {}


def test_passes_beyond_the_capacity_run_untimed(device: Device, work: Callable[[PassTimer, str], None]) -> None:
    timer = PassTimer(device, capacity=2)
    for label in "abcd":
        work(timer, label)
    assert set(timer.milliseconds()) <= {"a", "b"}
    work(timer, "e")
    assert set(timer.milliseconds()) <= {"e"}


def test_more_than_a_query_set_holds_is_cut(device: Device, work: Callable[[PassTimer, str], None]) -> None:
    timer = PassTimer(device, capacity=10**6)
    work(timer, "a")
    assert set(timer.milliseconds()) <= {"a"}


def test_a_clock_that_was_reset_inside_a_pass_is_no_time(
    device: Device, monkeypatch: pytest.MonkeyPatch, work: Callable[[PassTimer, str], None]
) -> None:
    timer = PassTimer(device)
    if not timer.available:
        pytest.skip("no timestamp queries here")
    work(timer, "a")
    monkeypatch.setattr(device, "read", lambda *a: np.array([[7, 5]], np.uint64))
    assert timer.milliseconds() == {"a": 0.0}
