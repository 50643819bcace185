"""A frame keeps what was rendered, on the device until someone asks for it."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import pellucid as pl
from pellucid.gpu import Device
from pellucid.gpu.targets import TargetRing, Targets
from pellucid.renderer import Renderer


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    return Renderer(device)


def scene(x: float) -> pl.Scene:
    """A ball that is seen from another side at each x."""
    ball = pl.Mesh.sphere(0.4, base_color=(0.8, 0.3, 0.1))
    return pl.Scene(camera=pl.Camera((x, 0.0, 1.5)), environment=pl.Environment.studio(), objects=[ball])


def test_frames_that_are_kept_are_not_drawn_over(renderer: Renderer) -> None:
    places, size = (0.0, 0.3, 0.6, 0.9), (40, 30)
    alone = [(f.radiance.copy(), f.depth.copy()) for f in (renderer.render(scene(x), size) for x in places)]
    kept = [renderer.render(scene(x), size) for x in places]
    renderer.render(scene(2.0), (24, 16))
    for frame, (radiance, depth) in zip(kept, alone, strict=True):
        assert frame.size == size and frame.radiance.shape == (30, 40, 3)
        np.testing.assert_array_equal(frame.radiance, radiance)
        np.testing.assert_array_equal(frame.depth, depth)
    assert not np.array_equal(alone[0][0], alone[1][0])


def test_half_of_a_frame_may_be_asked_for_late(renderer: Renderer) -> None:
    depth = renderer.render(scene(0.0), (40, 30)).depth
    frame = renderer.render(scene(0.0), (40, 30))
    radiance = frame.radiance
    others = [renderer.render(scene(x), (40, 30)) for x in (0.3, 0.6)]
    np.testing.assert_array_equal(frame.depth, depth)
    assert frame.radiance is radiance and not np.array_equal(others[1].depth, depth)


def test_what_nobody_asks_for_is_not_read(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    for method in ("read_depth", "read_color"):
        monkeypatch.setattr(Targets, method, lambda self: pytest.fail("a picture was read"))
    renderer = Renderer(renderer.device)
    frame = renderer.render(scene(0.0), (40, 30))
    for x in (0.1, 0.2, 0.3):
        frame = renderer.render(scene(x), (40, 30))
    assert frame.srgb().shape == (30, 40, 3)


def test_a_mean_of_samples_is_that_of_its_pictures(renderer: Renderer) -> None:
    frame = renderer.render(scene(0.0), (40, 30), samples=4)
    again = renderer.render(scene(0.0), (40, 30), samples=4)
    np.testing.assert_array_equal(frame.radiance, again.radiance)
    assert frame.depth.shape == (30, 40)


def test_a_frame_can_be_sent(renderer: Renderer) -> None:
    frame = renderer.render(scene(0.0), (40, 30))
    sent = pickle.loads(pickle.dumps(frame))
    for name in ("radiance", "depth", "display"):
        np.testing.assert_array_equal(getattr(sent, name), getattr(frame, name))
    assert sent.timings == frame.timings and sent.size == frame.size


def test_a_ring_has_no_more_places_than_it_needs(device: Device) -> None:
    ring = TargetRing(device)
    targets = {id(ring.take((8, 8))[0]) for _ in range(5)}
    assert len(targets) == 1  # nobody holds them
    held = [ring.take((8, 8)) for _ in range(5)]
    assert len({id(targets) for targets, _ in held}) == TargetRing.MOST
