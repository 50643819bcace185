"""Waves on the device are those of the fields, near by and as seen from afar."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields.waves import Gerstner, Heights, Ocean, Ripples, Sine, Sum
from pellucid.gpu import ComputeKernel
from pellucid.gpu.modules import ModuleSource, _used_bindings, source
from pellucid.techniques.water.passes import WaterTechnique
from pellucid.techniques.water.prepare import surfaces_of, wave_maps
from pellucid.techniques.water.wave_moments import moment_levels, short_slopes
from water_scenes import Still

if TYPE_CHECKING:
    from pellucid.gpu import Device

DRIVER = """
@group(0) @binding(20) var<storage, read> asked: array<vec4f>;
@group(0) @binding(21) var<storage, read_write> told: array<vec4f>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asked) { return; }
    let at = wave_point(asked[id.x].xy, asked[id.x].z);
    told[2u * id.x] = vec4f(at.height, at.slope, at.fold);
    told[2u * id.x + 1u] = vec4f(at.variance, wave_height(asked[id.x].xy));
}
"""


class Probe:
    """`wave_point` of shaders/waves.wgsl at places (N, 2) and footprints."""

    def __init__(self, device: Device) -> None:
        base = source("techniques/water/shaders/waves")
        text = base.text + DRIVER
        lines = base.lines + (("(test)", 1),) * DRIVER.count("\n")
        self.device = device
        self.kernel = ComputeKernel(device, ModuleSource("waves test", text, lines, _used_bindings(text)))

    def __call__(self, waves: Any, time_s: float, xz: np.ndarray, footprint_m: Any = 0.0, **water: Any) -> np.ndarray:
        technique = WaterTechnique(self.device)
        technique.prepare([pl.Water(waves=waves, extent_m=1000.0, **water)], None)  # type: ignore[arg-type]
        technique.simulate(time_s)
        asked = np.zeros((len(xz), 4), np.float32)
        asked[:, :2], asked[:, 2] = xz, footprint_m
        told = self.device.buffer(32 * len(xz))
        bound = {**technique.bodies[0].bindings, "asked": self.device.buffer(asked), "told": told}
        self.kernel.run((-(-len(xz) // 64), 1, 1), bound)
        return self.device.read(told, np.float32, (len(xz), 8))


@pytest.fixture(scope="module")
def wave_probe(device: Device) -> Probe:
    return Probe(device)


PLACES = np.random.default_rng(3).uniform(-30.0, 30.0, (200, 2))


def kinds() -> list[Any]:
    ripples = Ripples((48, 64), 0.1, 1.0, boundary="absorb")
    ripples.drop(0.3, -0.4, 0.5, 0.01)
    ocean = Ocean(7.0, 30.0, 40.0, (64, 64))
    gerstner = Gerstner((5.0, 2.0), (0.2, 0.05), (0.0, 70.0), tile_m=(10.0, 20.0), shape=(64, 32))
    return [Sine(3.0, 0.1, 40.0, shape=(32, 32)), gerstner, ocean, ripples, Sum(ocean, ripples)]


@pytest.mark.parametrize("waves", kinds(), ids=lambda w: w.kind)
def test_heights_and_slopes_are_those_of_the_fields(waves: Any, wave_probe: Probe) -> None:
    found = wave_probe(waves, 1.3, PLACES + np.array([5.0, -2.0]), center=(5.0, -2.0))
    layers = getattr(waves, "layers", (waves,))
    parts = [layer.at(*PLACES.T, 1.3) for layer in layers]
    highest = max(abs(limit) for limit in waves.limits_m)
    # Texels are looked up with 8 bits between them; two layers of different grids are resampled to the finer one.
    exact = len({layer.shape for layer in layers}) == 1
    np.testing.assert_allclose(found[:, 0], sum(p[0] for p in parts), atol=(0.006 if exact else 0.06) * highest)
    np.testing.assert_array_equal(found[:, 0], found[:, 7])
    steepest = max(np.abs(layer.surface(1.3).slopes).max() for layer in layers)
    np.testing.assert_allclose(found[:, 1:3], sum(p[1] for p in parts), atol=(0.01 if exact else 0.3) * steepest)


def test_moments_keep_means_and_variances() -> None:
    texels = np.random.default_rng(0).normal(size=(2, 13, 40, 4)).astype(np.float32)
    levels = moment_levels(texels)
    assert [level.shape for level in levels] == [(4, 6, 20, 4), (4, 3, 10, 4), (4, 1, 5, 4), (4, 1, 2, 4), (4, 1, 1, 4)]
    for level in levels:
        mean = level.mean(axis=(1, 2), dtype=np.float64)
        np.testing.assert_allclose(mean[::2, :2], texels[..., 1:3].mean(axis=(1, 2)), atol=2e-6)
        np.testing.assert_allclose(mean[::2, 2:], texels[..., [3, 0]].mean(axis=(1, 2)), atol=2e-6)
        np.testing.assert_allclose(mean[1::2, :2], np.square(texels[..., 1:3]).mean(axis=(1, 2)), atol=4e-6)
        np.testing.assert_allclose(mean[1::2, 2], (texels[..., 1] * texels[..., 2]).mean(axis=(1, 2)), atol=2e-6)
    box = texels[0, :12, :8, 1].reshape(6, 2, 4, 2).mean(axis=(1, 3))
    even = moment_levels(texels[:, :12])
    np.testing.assert_allclose(even[0][0, :, :4, 0], box, atol=1e-6)


@pytest.mark.parametrize("shape", [(6, 8), (1, 8), (6, 1)])
def test_heights_without_slopes_have_those_of_a_plane_up_to_the_border(shape: tuple[int, int]) -> None:
    rows, columns = np.indices(shape)
    source = Still(0.1 * columns - 0.3 * rows, tile_m=(2.0 * shape[1], 0.5 * shape[0]), periodic=False)
    texels = wave_maps(pl.Water(waves=source), surfaces_of(source, 0.0)).texels[0]
    expected = 0.05 if shape[1] > 1 else 0.0, -0.6 if shape[0] > 1 else 0.0
    np.testing.assert_allclose(texels[..., 1:3], np.broadcast_to(expected, (*shape, 2)), rtol=1e-5)


def test_slopes_that_a_footprint_hides_become_roughness(wave_probe: Probe) -> None:
    """Mean square = square of the mean + variance, whatever the footprint; of a whole tile all is variance."""
    ocean = Ocean(9.0, 20.0, 64.0, (64, 64), choppiness=0.0)
    at = np.stack(np.meshgrid(np.arange(64) - 31.5, np.arange(64) - 31.5), -1).reshape(-1, 2)
    slopes = ocean.surface(2.0).slopes.reshape(-1, 2).astype(float)
    wanted = np.array([*np.square(slopes).mean(0), slopes.prod(1).mean()])
    xx, xz, zz = ocean.short_slopes
    for footprint in (1.0, 2.0, 5.0, 16.0, 64.0, 1000.0):
        found = wave_probe(ocean, 2.0, at, footprint).astype(float)
        mean, variance = found[:, 1:3], found[:, 4:7] - (xx, zz, xz)
        seen = np.array([*np.square(mean).mean(0), mean.prod(1).mean()])
        np.testing.assert_allclose(seen + variance.mean(0), wanted, atol=0.01 * wanted[0])
        assert footprint > 1.0 or np.abs(variance).max() < 1e-5
    np.testing.assert_allclose(variance, np.broadcast_to(wanted, variance.shape), rtol=1e-3, atol=1e-6)
    assert np.abs(found[:, 1:3]).max() < 1e-4


def test_flat_water_and_water_that_ends(wave_probe: Probe) -> None:
    flat = wave_probe(None, 1.0, PLACES, 3.0)
    assert (flat[:, :3] == 0.0).all() and (flat[:, 3] == 1.0).all() and not flat[:, 4:].any()
    ramp = Heights(np.tile(np.linspace(0.0, 1.0, 16), (16, 1)), 8.0)
    beyond = wave_probe(ramp, 0.0, np.array([[-100.0, 0.0], [100.0, 0.0], [0.0, 0.0]]), [0.0, 0.0, 0.0])
    np.testing.assert_allclose(beyond[:, 0], [0.0, 1.0, 0.5], atol=2e-3)


def test_waves_are_sent_again_only_when_they_change(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    ripples = Ripples((32, 32), 0.1, 1.0)
    technique = WaterTechnique(device)
    technique.prepare([pl.Water(waves=ripples)], None)  # type: ignore[arg-type]
    sent = []
    monkeypatch.setattr(technique, "_upload", lambda body: sent.append(body.version))
    for time in (1.0, 1.0, 2.0, 2.0):
        technique.simulate(time)
    ripples.drop(0.0, 0.0, 0.3, 0.01)
    technique.simulate(2.0)
    assert len(sent) == 3


def test_short_slopes_of_layers_add_up() -> None:
    ocean = Ocean(9.0, 20.0, 64.0, (64, 64))
    xx, xz, zz = ocean.short_slopes
    np.testing.assert_allclose(short_slopes([ocean, Sine(), ocean]), [2 * xx, 2 * zz, 2 * xz], rtol=1e-6)


@pytest.mark.parametrize("below", [False, True])
def test_the_mirrored_sun_has_its_light(device: Device, below: bool) -> None:
    """Radiance over the picture of a lamp: E F above, E (1 - F) cos_i / cos_t below, where cameras measure L / n^2."""
    from pellucid.optics import fresnel_dielectric, refract

    n, down = 1.33, np.array([0.0, -np.sin(1.0), -np.cos(1.0)])
    up = np.array([0.0, 1.0, 0.0])
    share = float(fresnel_dielectric(np.sin(1.0), 1.0, n))
    if below:
        way = refract(down, up, 1.0, n).direction
        position, wanted = 3.0 * way, (1.0 - share) * np.sin(1.0) / -way[1] / n**2
    else:
        way = down * (1, -1, 1)
        position, wanted = 3.0 * way, share
    sun = pl.DirectionalLight(tuple(down), irradiance=2.0, angular_radius_deg=1.0, cast_shadow=False)
    camera = pl.Camera(tuple(position), (0.0, 0.0, 0.0), fov_deg=14.0)
    for waves in (None, Ocean(1.0, 0.0, 0.5, (64, 64), fetch_m=10.0, amplitude=0.15, seed=2)):
        water = pl.Water(extent_m=60.0, waves=waves, medium=n)
        scene = pl.Scene(camera, pl.Environment.constant(0.0), [sun], [water])
        radiance = pl.Renderer(device).render(scene, (64, 64), samples=2).radiance[..., 1].astype(float)
        half = np.tan(np.radians(7.0))
        side = (np.arange(64) + 0.5) / 32.0 * half - half
        angle = (2.0 * half / 64) ** 2 / (1.0 + side[:, None] ** 2 + side**2) ** 1.5
        assert (radiance * angle).sum() / 2.0 == pytest.approx(wanted, rel=0.02 if waves is None else 0.08)
