"""The last pass is exposure, then the named tone curve, then sRGB, rounded to 8 bits."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.gpu import Device
from pellucid.optics import colour
from pellucid.techniques.finish.passes import TONE_MAPPINGS, Finish

CURVES = {
    "linear": lambda rgb: rgb,
    "reinhard": colour.tone_reinhard,
    "aces": colour.tone_aces,
    "agx": colour.tone_agx,
    "khronos": colour.tone_khronos_neutral,
}


def finished(device: Device, finish: Finish, radiance: np.ndarray, exposure: float, tone: str) -> np.ndarray:
    rgba = np.concatenate([radiance, np.ones_like(radiance[..., :1])], axis=-1).astype(np.float32)
    source = device.texture(rgba)
    target = device.texture(size=(radiance.shape[1], radiance.shape[0]), format="rgba8unorm", usage=("render",))
    encoder = device.wgpu.create_command_encoder()
    finish.prepare(exposure, tone)
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


def test_changing_the_curve_compiles_nothing(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    finish = Finish(device)
    monkeypatch.setattr(device.wgpu, "create_render_pipeline", None)
    grey = np.full((2, 2, 3), 4.0)
    results = {int(finished(device, finish, grey, 1.0, tone)[0, 0, 0]) for tone in TONE_MAPPINGS}
    assert len(results) == len(TONE_MAPPINGS)


def test_an_unknown_curve_is_named(device: Device) -> None:
    with pytest.raises(SceneError, match="filmic"):
        Finish(device).prepare(1.0, "filmic")
