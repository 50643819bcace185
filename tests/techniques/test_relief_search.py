"""Searches along rays on the device against the exact meetings of `reference.py`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from pellucid.scene.relief_quality import ReliefQuality
from pellucid.techniques.relief.meet import ReliefMeeting
from pellucid.techniques.relief.reference import (
    NONE,
    SOLID,
    HeightField,
    ReliefRays,
    first_below,
    relief_first,
    relief_leave,
)

if TYPE_CHECKING:
    from pellucid.gpu import Device

TILE = (0.5, 0.3)
DEPTH = 0.02
COUNT = 4000


def surface(kind: str, shape: tuple[int, int] = (48, 64), seed: int = 0) -> np.ndarray:
    """Heights 0 to DEPTH: round hills, bricks with steep edges, or spiky noise."""
    rng = np.random.default_rng(seed)
    v, u = (np.mgrid[0 : shape[0], 0 : shape[1]] + 0.5) / np.array(shape)[:, None, None]
    if kind == "hills":
        h = 0.5 + 0.25 * np.sin(2 * np.pi * (2 * u + v)) + 0.25 * np.cos(2 * np.pi * (3 * v - u))
    elif kind == "bricks":
        edge = np.maximum(np.abs((4 * v) % 1 - 0.5), np.abs((2 * u + (np.floor(4 * v) % 2) / 2) % 1 - 0.5))
        h = 0.1 * rng.random(shape) + 0.9 * (edge < 0.4)
    else:
        h = rng.random(shape) ** 6
    return (DEPTH * h).astype(np.float32)


def rays(seed: int, bend: float = 0.0) -> tuple[ReliefRays, np.ndarray]:
    """From the top downwards to the bottom, many of them flat."""
    rng = np.random.default_rng(seed)
    d = rng.normal(size=(COUNT, 3)) * (1.0, 1.0, 0.4)
    d[:, 2] = -np.abs(d[:, 2]) - 0.03
    d[: COUNT // 20, 0] = 0.0  # along a row, along a column, straight down
    d[COUNT // 20 : COUNT // 10, 1] = 0.0
    d[:10, :2] = 0.0
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    found = ReliefRays.of(rng.random((COUNT, 2)) * 4 - 2, DEPTH, d, TILE)
    found = ReliefRays(found.uv, found.h, found.duv, found.dh, np.full(COUNT, bend))
    return found, 1.001 * DEPTH / -found.dh


def height_error(rays: ReliefRays, t: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Error along the rays as a share of DEPTH; inf where one of both meets and the other does not."""
    both = np.isfinite(t) & np.isfinite(true)
    neither = ~np.isfinite(t) & ~np.isfinite(true)
    error = np.abs(np.where(both, t, 0.0) - np.where(both, true, 0.0)) * np.abs(rays.dh) / DEPTH
    return np.where(both, error, np.where(neither, 0.0, np.inf))


def meeting(device: Device, search: str, *layers: Any, **options: Any) -> ReliefMeeting:
    upper = layers[1] if len(layers) > 1 else None
    quality = ReliefQuality(search=search, adapt_angle=False, adapt_distance=False)
    return ReliefMeeting(device, layers[0], upper, quality, TILE, **options)


@pytest.mark.parametrize("kind", ["hills", "bricks", "spikes"])
@pytest.mark.parametrize("search", ["cone", "max_mip"])
def test_what_skips_nothing_finds_the_first_meeting(device: Device, search: str, kind: str) -> None:
    for shape, tiling in (((48, 64), True), ((33, 50), True), ((33, 50), False)):
        h = surface(kind, shape)
        asked, reach = rays(1)
        t, layer = meeting(device, search, h, tiling=tiling)(asked, reach)
        error = height_error(asked, t, first_below(HeightField(h, tiling), asked, reach))
        # A ray may graze an edge nearer than 32-bit numbers tell it from its neighbours.
        assert np.mean(error > 1e-3) <= 5e-4
        assert np.median(error) < 2e-6
        assert ((layer == SOLID) == np.isfinite(t)).all()


@pytest.mark.parametrize("search", ["cone", "max_mip"])
def test_bent_rays_too(device: Device, search: str) -> None:
    h = surface("bricks")
    for bend in (1.5, -0.3):
        asked, reach = rays(2, bend)
        reach = np.minimum(reach, 1.0)
        t, _ = meeting(device, search, h)(asked, reach)
        true = first_below(HeightField(h), asked, reach)
        assert np.isfinite(true).mean() > 0.5 and (bend < 0 or (~np.isfinite(true)).mean() > 0.02)
        assert np.mean(height_error(asked, t, true) > 1e-3) <= 5e-4


@pytest.mark.parametrize("search", ["cone", "max_mip"])
def test_the_first_of_two_layers_and_which(device: Device, search: str) -> None:
    solid, upper = surface("bricks"), 1.2 * surface("hills")
    asked, reach = rays(3)
    t, layer = meeting(device, search, solid, upper)(asked, reach)
    true, true_layer = relief_first(HeightField(solid), HeightField(upper), asked, reach)
    assert np.mean(height_error(asked, t, true) > 1e-3) <= 5e-4
    assert np.mean(layer != true_layer) <= 1e-3
    assert 0.2 < np.mean(layer == SOLID) < 0.8
    t, layer = meeting(device, search, solid, upper, looks_for="solid")(asked, reach)
    true = first_below(HeightField(solid), asked, reach)
    assert np.mean(height_error(asked, t, true) > 1e-3) <= 5e-4
    assert set(layer.tolist()) == {SOLID}


def test_rays_leave_the_translucent_matter_where_they_should(device: Device) -> None:
    solid = 0.6 * surface("spikes")
    upper = (solid + 0.003 + 0.3 * surface("hills")).astype(np.float32)
    asked, _ = rays(4)
    rng = np.random.default_rng(4)
    low, high = HeightField(solid).height(asked.uv), HeightField(upper).height(asked.uv)
    start = low + (high - low) * (0.01 + 0.98 * rng.random(COUNT))
    rising = rng.random(COUNT) < 0.5
    inside = ReliefRays(asked.uv, start, asked.duv, np.where(rising, -asked.dh, asked.dh), asked.bend)
    t, layer = meeting(device, "max_mip", solid, upper, looks_for="leave")(inside, 1.0)
    true, true_layer = relief_leave(HeightField(solid), HeightField(upper), inside, 1.0)
    assert np.mean(height_error(inside, t, true) > 1e-3) <= 5e-4
    assert np.mean(layer != true_layer) <= 1e-3
    assert NONE not in layer.tolist()


def test_a_ray_that_starts_on_a_surface_and_leaves_it_does_not_meet_it_there(device: Device) -> None:
    h = surface("hills")
    asked, reach = rays(5)
    t = first_below(HeightField(h), asked, reach)
    field, uv = HeightField(h), asked.uv_at(t)
    slope = np.sum(field.slopes(uv, TILE) * asked.duv * TILE, axis=1)
    away = ReliefRays(uv, asked.height_at(t), asked.duv, slope + 0.5, asked.bend)
    for search in ("cone", "max_mip"):
        t, _ = meeting(device, search, h)(away, 0.01)
        assert not (t < 1e-4).any()


def test_searches_by_steps_come_near_and_finer_ones_nearer(device: Device) -> None:
    h = surface("hills")
    asked, reach = rays(6)
    steep = np.abs(asked.dh) > 0.5
    true = first_below(HeightField(h), asked, reach)
    medians = {}
    for name, options in {
        "steps": {"binary_steps": 0, "linear_approximation": False},
        "halving": {"linear_approximation": False},
        "line": {},
    }.items():
        quality = ReliefQuality(search="linear", adapt_angle=False, adapt_distance=False, **options)
        t, _ = ReliefMeeting(device, h, None, quality, TILE)(asked, reach)
        medians[name] = np.median(height_error(asked, t, true)[steep])
    # A step is 1/24 of the depth, six halvings make it 1/1536; errors are evenly spread below that.
    assert 0.2 / 24 < medians["steps"] < 1 / 24
    assert 0.2 / 1536 < medians["halving"] < 1 / 1536
    assert medians["line"] < 0.1 * medians["halving"]
    t, _ = meeting(device, "distance", h)(asked, reach)
    error = height_error(asked, t, true)[steep]
    assert np.median(error) < 1e-4 and np.mean(error > 0.02) < 0.01


def test_an_adapted_search_takes_fewer_steps_where_the_view_is_steep(device: Device) -> None:
    h = surface("spikes")
    asked, reach = rays(7)
    true = first_below(HeightField(h), asked, reach)
    steep = np.abs(asked.dh) > 0.9
    medians = []
    for adapt in (False, True):
        quality = ReliefQuality(
            search="linear", adapt_angle=adapt, adapt_distance=False, binary_steps=0, linear_approximation=False
        )
        t, _ = ReliefMeeting(device, h, None, quality, TILE)(asked, reach)
        medians.append(np.median(height_error(asked, t, true)[steep]))
    # A third of 24 steps would be three times as long; the ends of the first steps weigh as well.
    assert 1.4 < medians[1] / medians[0] < 3.5
