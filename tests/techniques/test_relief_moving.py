"""Heights that move: what the device makes of them is what NumPy does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import Ripples
from pellucid.gpu import Device
from pellucid.techniques.relief import moving, passes

TILE = 0.4
MAPS = ("height_map", "height_bounds", "solid_surface", "translucent_surface")


def pool(shape: tuple[int, int], boundary: str) -> Ripples:
    ripples = Ripples(shape, TILE / shape[1], 0.25, boundary=boundary)
    for k, place in enumerate([(0.02, 0.03), (-0.1, 0.01), (0.15, -0.04)]):
        ripples.drop(*place, radius_m=0.03, strength_m=0.003, time_s=0.04 * k)
    return ripples


def surface(ripples: Ripples, stones: tuple[int, int] | None, tiling: bool, **quality: Any) -> pl.ReliefSurface:
    water = pl.ReliefLayer(ripples, base_m=0.004)
    rough = None if stones is None else pl.ReliefLayer(0.01 * np.random.default_rng(1).random(stones) - 0.005)
    layers = (water,) if rough is None else (rough, water)
    chosen = pl.ReliefQuality(**quality)
    return pl.ReliefSurface.plane(0.7, *layers, tile_m=TILE, tiling=tiling, quality=chosen)


def drawn(device: Device, item: pl.ReliefSurface, times: tuple[float, ...]) -> tuple[np.ndarray, dict[str, Any]]:
    """The last picture, and the levels of all maps that it was drawn with."""
    renderer = pl.Renderer(device)
    camera = pl.Camera(position=(0.0, 0.4, 0.4), target=(0.0, 0.0, 0.0))
    lamp = pl.DirectionalLight(direction=(0.6, -0.8, 0.3), irradiance=3.0)
    scene = pl.Scene(camera, pl.Environment.constant(0.5), lights=[lamp], objects=[item])
    for time_s in times:
        frame = renderer.render(scene, (48, 36), time=time_s)
    bindings = renderer._techniques[pl.ReliefSurface].bodies[0].bindings
    levels = {
        name: [device.read_texture(bindings[name], mip=mip) for mip in range(bindings[name].mip_level_count)]
        for name in MAPS
    }
    return frame.radiance, levels


@pytest.mark.parametrize("simulated", [True, False])
@pytest.mark.parametrize(
    ("shape", "stones", "tiling", "boundary"),
    [
        ((32, 32), (32, 32), True, "periodic"),
        ((21, 37), (64, 48), True, "absorb"),  # odd sizes, and the smaller map is of the layer that moves
        ((21, 37), (8, 9), False, "reflect"),
        ((32, 32), None, True, "periodic"),
    ],
)
def test_the_device_makes_the_maps_and_pictures_of_numpy(
    device: Device,
    monkeypatch: pytest.MonkeyPatch,
    simulated: bool,
    shape: tuple[int, int],
    stones: tuple[int, int] | None,
    tiling: bool,
    boundary: str,
) -> None:
    times = (0.0, 0.05, 0.16)
    item = surface(pool(shape, boundary), stones, tiling)
    monkeypatch.setattr(moving, "simulates", lambda device, layer: simulated and isinstance(layer.heights, Ripples))
    picture, maps = drawn(device, item, times)
    monkeypatch.setattr(passes, "device_moves", lambda *given: False)
    wanted, arrays = drawn(device, item, times)
    for name in ("height_map", "height_bounds"):
        for level, array in zip(maps[name], arrays[name], strict=True):
            np.testing.assert_allclose(level, array, atol=1e-7)  # heights of centimetres in 32 bits
    for name in ("solid_surface", "translucent_surface"):
        for level, array in zip(maps[name], arrays[name], strict=True):
            np.testing.assert_allclose(level, array, atol=3e-4, rtol=2e-3)  # two roundings to half floats
    assert np.abs(picture - wanted).mean() < 2e-4 * wanted.mean()
    assert np.abs(picture - wanted).max() < 0.05 * wanted.max()  # a lone pixel at an edge may see the other layer


def test_bounds_hold_for_the_heights_that_are_drawn(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moving, "simulates", lambda device, layer: isinstance(layer.heights, Ripples))
    _, maps = drawn(device, surface(pool((21, 37), "reflect"), (40, 50), True), (0.0, 0.1))
    heights = maps["height_map"][0]
    corners = [np.roll(heights, (-j, -i), (0, 1)) for j in (0, 1) for i in (0, 1)]
    np.testing.assert_array_equal(maps["height_bounds"][0][..., ::2], np.max(corners, axis=0))
    np.testing.assert_array_equal(maps["height_bounds"][0][..., 1::2], np.min(corners, axis=0))
    np.testing.assert_array_equal(maps["height_bounds"][-1][0, 0, ::2], heights.max(axis=(0, 1)))
    np.testing.assert_array_equal(maps["height_bounds"][-1][0, 0, 1::2], heights.min(axis=(0, 1)))


def test_what_wants_arrays_keeps_to_numpy(device: Device) -> None:
    ripples = pool((16, 16), "periodic")
    horizons = surface(ripples, None, True, shadows="horizon")
    steps = surface(ripples, (16, 16), True, search="linear", complexity=True)
    for item in (horizons, steps):
        assert not moving.device_moves(device, item, item.quality)
    plain = surface(ripples, (16, 16), True)
    assert moving.device_moves(device, plain, plain.quality) == device.float32_filterable


def test_two_surfaces_share_the_simulation_of_one_pool(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moving, "simulates", lambda device, layer: isinstance(layer.heights, Ripples))
    ripples = pool((16, 16), "periodic")
    renderer = pl.Renderer(device)
    scene = pl.Scene(pl.Camera(position=(0.0, 1.0, 0.3)), objects=[surface(ripples, (16, 16), True)])
    renderer.render(scene, (8, 8), time=0.1)
    renderer.render(scene.replace(objects=[*scene.objects, surface(ripples, None, True)]), (8, 8), time=0.2)
    first, second = (body.moving for body in renderer._techniques[pl.ReliefSurface].bodies)
    assert first is not second
    assert first.simulations[0] is second.simulations[0]
