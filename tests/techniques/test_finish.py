"""The last pass is exposure, then the named tone curve, then sRGB, rounded to 8 bits."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.gpu import Device, probe
from pellucid.optics import colour
from pellucid.techniques.finish.glow import Glow
from pellucid.techniques.finish.passes import TONE_MAPPINGS, Finish

CURVES = {
    "linear": lambda rgb: rgb,
    "reinhard": colour.tone_reinhard,
    "aces": colour.tone_aces,
    "agx": colour.tone_agx,
    "khronos": colour.tone_khronos_neutral,
}


def finished(
    device: Device, finish: Finish, radiance: np.ndarray, exposure: float, tone: str, glow: float = 0.0
) -> np.ndarray:
    rgba = np.concatenate([radiance, np.ones_like(radiance[..., :1])], axis=-1).astype(np.float32)
    source = device.texture(rgba)
    target = device.texture(size=(radiance.shape[1], radiance.shape[0]), format="rgba8unorm", usage=("render",))
    encoder = device.wgpu.create_command_encoder()
    finish.prepare(exposure, tone, glow)
    finish.draw(encoder, source, target.create_view())
    device.wgpu.queue.submit([encoder.finish()])
    return device.read_texture(target)


@pytest.mark.parametrize("tone", TONE_MAPPINGS)
def test_eight_bits_equal_the_float64_curve(device: Device, tone: str) -> None:
    radiance = 10.0 ** np.random.default_rng(0).uniform(-3, 2, (24, 40, 3))
    radiance[0, 0] = 0.0
    found = finished(device, Finish(device), radiance, 0.8, tone)
    expected = 255 * colour.srgb_encode(np.clip(CURVES[tone](0.8 * radiance), 0, 1))
    assert np.abs(found[..., :3] - expected).max() <= 0.52
    assert (found[..., 3] == 255).all()


def test_polynomials_of_agx_are_the_curve(device: Device) -> None:
    # From below the lowest stop to above the highest, grey and of one colour
    grey = np.geomspace(1e-5, 50.0, 4000)[:, None]
    radiance = np.concatenate([np.zeros((1, 3)), grey * np.ones(3), grey * np.array([1.0, 0.2, 0.02])])
    found = probe("techniques/finish/shaders/agx_encoded", "agx_encoded", radiance, device=device)
    np.testing.assert_allclose(found, colour.srgb_encode(colour.tone_agx(radiance)), atol=1e-4)


def test_changing_the_curve_compiles_nothing(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    finish = Finish(device)
    monkeypatch.setattr(device.wgpu, "create_render_pipeline", None)
    grey = np.full((2, 2, 3), 4.0)
    results = {int(finished(device, finish, grey, 1.0, tone)[0, 0, 0]) for tone in TONE_MAPPINGS}
    assert len(results) == len(TONE_MAPPINGS)


def glowing(device: Device, radiance: np.ndarray) -> np.ndarray:
    rgba = np.concatenate([radiance, np.ones_like(radiance[..., :1])], axis=-1).astype(np.float32)
    encoder = device.wgpu.create_command_encoder()
    blurred = Glow(device).draw(encoder, device.texture(rgba))
    device.wgpu.queue.submit([encoder.finish()])
    return device.read_texture(blurred)[..., :3].astype(np.float64)


def test_glow_spreads_light_and_keeps_it(device: Device) -> None:
    radiance = np.zeros((512, 512, 3))
    radiance[250:254, 256:260] = (4000.0, 1000.0, 2000.0)
    blurred = glowing(device, radiance)
    assert (blurred > 0).mean() > 0.2
    # Thirteen passes each round to half floats, by up to 2^-10 where a driver truncates.
    np.testing.assert_allclose(4 * blurred.sum((0, 1)), radiance.sum((0, 1)), rtol=13 / 1024)
    rows, columns = np.indices(blurred.shape[:2]) + 0.5
    centre = [(w * blurred[..., 0]).sum() / blurred[..., 0].sum() for w in (rows, columns)]
    np.testing.assert_allclose(centre, [126.0, 129.0], atol=0.3)


@pytest.mark.parametrize("size", [(301, 97), (64, 64), (5, 3), (1, 1)])
def test_glow_leaves_an_even_picture_alone(device: Device, size: tuple[int, int]) -> None:
    blurred = glowing(device, np.full((*size, 3), 0.5))
    np.testing.assert_allclose(blurred, 0.5, rtol=2e-3)


def test_glow_is_a_share_of_the_light(device: Device) -> None:
    radiance = np.zeros((64, 64, 3))
    radiance[32, 32] = 100.0
    finish = Finish(device)
    plain = finished(device, finish, radiance, 1.0, "linear")
    shining = finished(device, finish, radiance, 1.0, "linear", glow=0.1)
    assert (plain[..., 0] > 0).sum() == 1 and (shining[..., 0] > 0).sum() > 500


def test_a_glow_out_of_range_is_named(device: Device) -> None:
    with pytest.raises(SceneError, match="glow"):
        Finish(device).prepare(glow=1.5)


def test_an_unknown_curve_is_named(device: Device) -> None:
    with pytest.raises(SceneError, match="filmic"):
        Finish(device).prepare(1.0, "filmic")
