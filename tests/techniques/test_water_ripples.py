"""Ripples that the device steps are those that NumPy steps, in every map and in the parameters that hang on them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields.waves import Ocean, Ripples, Sine, Sum
from pellucid.gpu import Device
from pellucid.renderer import Renderer
from pellucid.scene.water_quality import WaterQuality
from pellucid.techniques.water.layouts import WaterParams
from pellucid.techniques.water.passes import Body, WaterTechnique
from pellucid.techniques.water.ripple_maps import LIMITS, ripples_for_device


def rained(shape: tuple[int, int] = (40, 56), **given: Any) -> Ripples:
    """A pool with waves in it, and a boat."""
    pool = Ripples(shape, 0.05, 0.8, **({"limit_m": 0.05} | given))
    for x, z, strength in ((0.3, -0.2, 0.02), (-0.7, 0.4, -0.03), (0.9, 0.1, 0.015)):
        pool.drop(x, z, 0.15, strength, 0.1 + abs(x))
    pool.push([(-0.8, -0.3), (0.8, 0.2)], 0.15, 0.01, time_s=0.2)
    return pool


def moved(device: Device, waves: Any, times_s: tuple[float, ...], on_device: bool, **water: Any) -> Body:
    technique = WaterTechnique(device)
    technique.ripples_on_device = on_device
    item = pl.Water(waves=waves, extent_m=50.0, level=0.3, **water)
    for time_s in times_s:
        technique.prepare([item], None)  # type: ignore[arg-type]
        technique.simulate(time_s)
    assert (technique.bodies[0].ripples is not None) == on_device
    return technique.bodies[0]


def maps(device: Device, body: Body) -> list[np.ndarray]:
    """All levels and layers of the maps, finest first."""
    found = []
    for name in ("wave_texture", "moments_texture"):
        texture = body.bindings[name]
        for mip in range(texture.mip_level_count):
            found += [device.read_texture(texture, layer, mip) for layer in range(texture.size[2])]
    return found


CASES = {
    "reflect": lambda: rained(),
    "periodic": lambda: rained(boundary="periodic"),
    "absorb, odd, a level": lambda: rained((37, 51), boundary="absorb", level_m=0.01),
    "on the sea": lambda: Sum(Ocean(2.0, tile_m=3.0, shape=(32, 32)), rained()),
    "under sines": lambda: Sum(rained((64, 64)), Sine(1.0, 0.01, tile_m=4.0, shape=(64, 64))),
}


@pytest.mark.parametrize("name", CASES)
def test_maps_and_limits_are_those_of_the_twin(device: Device, name: str) -> None:
    times = (0.0, 0.5, 1.3)
    here, there = (moved(device, CASES[name](), times, on_device) for on_device in (True, False))
    scale = float(np.abs(there.waves.texels).max())
    for own, true in zip(maps(device, here), maps(device, there), strict=True):
        # What 130 steps in single precision leave (simulation/README.md); a slope divides that by a cell of 5 cm.
        np.testing.assert_allclose(own, true, rtol=1e-4, atol=2e-5 * scale)
    told = device.read(here.bindings["water"], WaterParams, 1)[0]
    for field in WaterParams.names or ():
        tolerance = {"rtol": 1e-4, "atol": 1e-6} if field in LIMITS else {"rtol": 0.0}
        np.testing.assert_allclose(told[field], there.params[field], **tolerance, err_msg=field)
    assert there.params["wave_slope"] > 0.05 and there.params["crest"] > 0.005


def test_the_cpu_knows_how_far_they_may_reach(device: Device) -> None:
    body = moved(device, Sum(rained(), Sine(1.0, 0.01, tile_m=4.0)), (0.5,), False)
    assert body.waves.range_m[0] > -0.06
    waves = Sum(rained((256, 256)), Sine(1.0, 0.01, tile_m=4.0))
    low, high = moved(device, waves, (0.5,), True).waves.range_m
    assert low == pytest.approx(-0.06, rel=1e-3) and high == pytest.approx(0.06, rel=1e-3)


def test_time_may_stand_still_or_go_back_and_things_fall_in(device: Device) -> None:
    pools = rained(), rained()
    bodies = []
    for pool, on_device in zip(pools, (True, False), strict=True):
        technique = WaterTechnique(device)
        technique.ripples_on_device = on_device
        item = pl.Water(waves=pool, extent_m=50.0)
        versions = []
        for time_s in (0.8, 0.8, 0.4):
            technique.prepare([item], None)  # type: ignore[arg-type]
            technique.simulate(time_s)
            versions.append(technique.bodies[0].version)
        pool.drop(0.1, 0.1, 0.2, 0.02)
        technique.prepare([item], None)  # type: ignore[arg-type]
        technique.simulate(0.6)
        assert versions[0] == versions[1] < versions[2] < technique.bodies[0].version
        bodies.append(technique.bodies[0])
    here, there = (maps(device, body)[0] for body in bodies)
    np.testing.assert_allclose(here, there, atol=2e-5 * float(np.abs(there).max()))


def test_what_needs_heights_has_them_from_numpy(device: Device) -> None:
    def layer(waves: Any, **quality: Any) -> int | None:
        return ripples_for_device(device, pl.Water(waves=waves), WaterQuality.of("best").replace(**quality))

    assert layer(rained()) == (0 if device.float32_filterable else None)
    assert layer(rained(), caustics="cpu") is None and layer(rained(), refraction="march") is None
    assert layer(Sum(rained(), rained())) is None and layer(None) is None and layer(Ocean()) is None
    assert layer(Sum(rained((40, 56)), Ocean(2.0, tile_m=3.0, shape=(64, 64)))) is None
    assert layer(rained(dtype=np.float64)) is None


def test_pictures_are_the_same(device: Device) -> None:
    pictures = []
    for on_device in (True, False):
        renderer = Renderer(device)
        renderer._techniques[pl.Water] = technique = WaterTechnique(device)
        technique.ripples_on_device = on_device
        floor = pl.Mesh.checkerboard(3.0, squares=12, position=(0.0, -0.6, 0.0))
        water = pl.Water(extent_m=(2.8, 2.0), waves=rained())
        sun = pl.DirectionalLight(direction=(0.5, -0.8, 0.2))
        scene = pl.Scene(pl.Camera((0.2, 1.6, 1.9), (0.0, -0.2, 0.0)), pl.Environment.sky(), [sun], [floor, water])
        for time_s in (0.9, 1.2):
            frame = renderer.render(scene, (64, 48), time=time_s)
        pictures.append(frame.radiance)
    off = np.abs(pictures[0] - pictures[1]) / np.abs(pictures[1]).mean()
    # Where photons land is rounded to shares of texels, and a ray beside an edge may pass it on the other side.
    assert np.median(off) < 1e-4 and (off > 0.02).mean() < 0.005
